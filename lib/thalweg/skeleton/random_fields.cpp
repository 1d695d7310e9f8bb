// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/random_fields.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/skeleton/internal/normal_row.hpp>
#include <thalweg/solver/spectral/fft.hpp>

namespace thalweg::skeleton {

void check(FieldParams const& params, char const* stage) {
    require_in(stage, "mean height", params.mean, Range::finite(), "m");
    require_in(stage, "deviation", params.std, Range::at_least(0.0), "m");
    for (double const length : {params.lx_cells, params.ly_cells}) {
        require_in(stage, "correlation length", length, Range::above(0.0), "cells");
    }
}

void normal_row(std::uint64_t seed, std::uint64_t stage, std::uint64_t row, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); i += 4) {
        auto const words = random_block(seed, stage, row, i / 4);
        auto const [a, b] = normal_pair(words[0], words[1]);
        auto const [c, d] = normal_pair(words[2], words[3]);
        std::array<double, 4> const four = {a, b, c, d};
        std::copy_n(four.begin(), std::min<std::size_t>(4, values.size() - i),
                    values.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

namespace {

constexpr std::uint64_t grf_stage = 31;
constexpr double negligible = 1e-6;
constexpr std::int64_t most_cells = std::int64_t{1} << 32;

std::int64_t side(std::int64_t cells, double length_cells, int embedding) {
    double const wanted = embedding * std::max(static_cast<double>(cells), 5.0 * length_cells);
    return wanted < 1e9 ? solver::good_size(static_cast<std::int64_t>(std::ceil(wanted))) : std::int64_t{1} << 30;
}

solver::Circulant embed(Grid const& grid, GrfParams const& params, Run const& run) {
    solver::StableCovariance const& covariance = params.covariance;
    std::int64_t const width = side(grid.width, covariance.lx_cells, params.embedding);
    std::int64_t const height = side(grid.height, covariance.ly_cells, params.embedding);
    refuse_if<BadParameter>(width > most_cells / height, "skeleton.grf",
                            "a grid of {} x {} cells with correlation lengths of {} and {} cells needs a torus of {} x "
                            "{}; shorten the lengths or lessen the embedding of {}",
                            grid.width, grid.height, covariance.lx_cells, covariance.ly_cells, width, height,
                            params.embedding);
    solver::Circulant torus = solver::circulant(covariance, width, height, run);
    if (torus.negative_share > negligible && width <= most_cells / height / 4) {
        torus = solver::circulant(covariance, 2 * width, 2 * height, run);
    }
    return torus;
}

constexpr std::uint64_t markov_stage = 33;
constexpr std::int64_t rows_at_once = 64;
constexpr double longest_cells = 1e6;

constexpr std::uint64_t ar_stage = 32;

} // namespace

RandomField grf(Grid const& grid, GrfParams const& params, Run const& run) {
    check(FieldParams{.mean = params.mean, .std = params.std}, "skeleton.grf");
    check(params.covariance, "skeleton.grf");
    require_in("skeleton.grf", "embedding", params.embedding, Range::between(1, 64));
    RandomField result{Raster<float>(grid)};
    if (grid.cells() == 0) {
        return result;
    }
    solver::Circulant const torus = embed(grid, params, run);
    result.torus_width = torus.width;
    result.torus_height = torus.height;
    result.negative_share = torus.negative_share;
    Raster<double> const normal = solver::sample(torus, grid, params.seed, grf_stage, run);
    for (std::int64_t i = 0; i < normal.cells(); ++i) {
        result.dem[i] = static_cast<float>(params.mean + params.std * normal[i]);
    }
    return result;
}

Raster<float> markov3(Grid const& grid, FieldParams const& params, Run const& run) {
    check(params, "skeleton.markov3");
    double const length = (params.lx_cells + params.ly_cells) / 2.0;
    refuse_if<BadParameter>(
        length > longest_cells, "skeleton.markov3",
        "a correlation length of {} cells; the lead of five times that many rows and columns is made for at most {}",
        length, longest_cells);
    double const rho = portable::exp(-1.0 / length);
    double const diagonal = portable::exp(-std::sqrt(2.0) / length);
    double const weight = rho / (1.0 + diagonal);
    // With q = 1 - 2 rho^2/(1 + rho1) the recursion's variance is q / sqrt(1 - 4 A^2) times that of R: sqrt(q) cancels.
    double const gain = std::sqrt(std::sqrt(1.0 - 4.0 * weight * weight));
    auto const lead = static_cast<std::int64_t>(std::ceil(5.0 * length));
    auto const width = static_cast<std::size_t>(grid.width + lead);
    std::vector<double> noise(width * rows_at_once);
    std::vector<double> north(width, 0.0);
    Raster<float> dem(grid);
    for (std::int64_t first = 0; first < grid.height + lead; first += rows_at_once) {
        std::int64_t const count = std::min(rows_at_once, grid.height + lead - first);
        parallel_ranges(run, count, 4, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t r = begin; r < end; ++r) {
                normal_row(params.seed, markov_stage, static_cast<std::uint64_t>(first + r),
                           std::span(noise).subspan(static_cast<std::size_t>(r) * width, width));
            }
        });
        for (std::int64_t r = first; r < first + count; ++r) {
            double const* const drawn = &noise[static_cast<std::size_t>(r - first) * width];
            double west = 0.0;
            for (std::size_t c = 0; c < width; ++c) {
                west = weight * (west + north[c]) + gain * drawn[c];
                north[c] = west;
                auto const column = static_cast<std::int64_t>(c) - lead;
                if (column >= 0 && r >= lead) {
                    dem[Cell{column, r - lead}] = static_cast<float>(params.mean + params.std * west);
                }
            }
        }
    }
    return dem;
}

Raster<float> separable_ar(Grid const& grid, FieldParams const& params, Run const& run) {
    check(params, "skeleton.separable_ar");
    Raster<double> field(grid);
    double const a = portable::exp(-1.0 / params.lx_cells);
    double const along = std::sqrt(1.0 - a * a);
    parallel_ranges(run, grid.height, 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            auto const row = field.row(r);
            normal_row(params.seed, ar_stage, static_cast<std::uint64_t>(r), row);
            for (std::size_t c = 1; c < row.size(); ++c) {
                row[c] = a * row[c - 1] + along * row[c];
            }
        }
    });
    Raster<float> dem(grid);
    double const b = portable::exp(-1.0 / params.ly_cells);
    double const across = std::sqrt(1.0 - b * b);
    parallel_ranges(run, grid.width, 64, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = 0; r < grid.height; ++r) {
            for (std::int64_t c = begin; c < end; ++c) {
                double& here = field[Cell{c, r}];
                here = r == 0 ? here : b * field[Cell{c, r - 1}] + across * here;
                dem[Cell{c, r}] = static_cast<float>(params.mean + params.std * here);
            }
        }
    });
    return dem;
}

Raster<float> shift_mean(Raster<float> dem, double mean) {
    require_in("skeleton.shift_mean", "mean height", mean, Range::finite(), "m");
    double above = 0.0;
    std::int64_t cells = 0;
    for (float const z : dem.values()) {
        if (!std::isnan(z)) {
            above += z - mean;
            ++cells;
        }
    }
    double const shift = cells > 0 ? -above / static_cast<double>(cells) : 0.0;
    for (float& z : dem.values()) {
        z = static_cast<float>(z + shift);
    }
    return dem;
}

} // namespace thalweg::skeleton
