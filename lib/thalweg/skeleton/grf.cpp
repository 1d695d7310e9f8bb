// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/grf.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/skeleton/field_params.hpp>
#include <thalweg/solver/spectral/circulant.hpp>
#include <thalweg/solver/spectral/fft.hpp>

namespace thalweg::skeleton {

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
    if (width > most_cells / height) {
        throw BadParameter(fmt::format(
            "skeleton.grf: a grid of {} x {} cells with correlation lengths of {} and {} cells "
            "needs a torus of {} x {}; shorten the lengths or lessen the embedding of {}",
            grid.width, grid.height, covariance.lx_cells, covariance.ly_cells, width, height, params.embedding));
    }
    solver::Circulant torus = solver::circulant(covariance, width, height, run);
    if (torus.negative_share > negligible && width <= most_cells / height / 4) {
        torus = solver::circulant(covariance, 2 * width, 2 * height, run);
    }
    return torus;
}

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

} // namespace thalweg::skeleton
