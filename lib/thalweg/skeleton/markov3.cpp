// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/markov3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/skeleton/internal/normal_row.hpp>

namespace thalweg::skeleton {

namespace {

constexpr std::uint64_t markov_stage = 33;
constexpr std::int64_t rows_at_once = 64;
constexpr double longest_cells = 1e6;

} // namespace

Raster<float> markov3(Grid const& grid, FieldParams const& params, Run const& run) {
    check(params, "skeleton.markov3");
    double const length = (params.lx_cells + params.ly_cells) / 2.0;
    if (length > longest_cells) {
        throw BadParameter(
            fmt::format("skeleton.markov3: a correlation length of {} cells; the lead of five times that "
                        "many rows and columns is made for at most {}",
                        length, longest_cells));
    }
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

} // namespace thalweg::skeleton
