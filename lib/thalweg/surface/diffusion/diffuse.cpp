// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/diffuse.hpp>

#include <thalweg/core/cells/nearest_cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/value_noise.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/core/valley.hpp>
#include <thalweg/solver/grid/relax_explicit.hpp>
#include <thalweg/surface/diffusion/internal/coarse_start.hpp>
#include <thalweg/surface/diffusion/internal/heights_of.hpp>
#include <thalweg/surface/diffusion/internal/problem_through.hpp>
#include <thalweg/surface/diffusion/internal/smooth_free.hpp>

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace thalweg::surface {
namespace {

constexpr int sweeps_after_smoothing = 20;
constexpr double noise_reach_cells = 4.0;

void demand(DiffuseParams const& params) {
    constexpr char const* self = "surface.diffuse";
    require_in(self, "tolerance", params.tolerance, Range::inside(0.0, 1.0));
    if (!(params.alpha > 0.0 && params.alpha <= 0.25)) {
        throw BadParameter(fmt::format(
            "surface.diffuse: alpha is {}; give one above 0 and at most 1/4: beyond it a cell takes more from "
            "its four neighbours than the difference, and differences grow from sweep to sweep",
            params.alpha));
    }
    require_in(self, "iterations", params.iterations, Range::at_least(0));
    require_in(self, "passes", params.passes, Range::at_least(0));
    require_in(self, "sigma", params.sigma_cells, Range::between(0.0, 100.0), "cells");
    require_in(self, "noise_m", params.noise_m, Range::at_least(0.0), "m");
    require_in(self, "noise_cells", params.noise_cells, Range::at_least(1.0));
}

solver::GridSolution spread(solver::GridProblem problem, DiffuseParams const& params, Run const& run) {
    if (params.mode == Diffusion::steady) {
        return solver::solve_poisson(std::move(problem), {params.tolerance, 1000}, run);
    }
    if (params.start == DiffusionStart::coarse) {
        start_coarse(problem, run);
    }
    return solver::relax_explicit(std::move(problem), {params.alpha, params.iterations}, run);
}

void smooth(Raster<std::uint8_t> const& kind, DiffuseParams const& params, Raster<double>& value, Run const& run) {
    if (params.sigma_cells == 0.0 || params.passes == 0) {
        return;
    }
    for (int pass = 0; pass < params.passes; ++pass) {
        run.check();
        smooth_free(kind, params.sigma_cells, value, run);
    }
    solver::GridProblem problem{kind, std::move(value), {}};
    value = solver::relax_explicit(std::move(problem), {0.25, sweeps_after_smoothing}, run).value;
}

void add_noise(Raster<std::uint8_t> const& kind, Raster<float> const& z, DiffuseParams const& params,
               Raster<double>& value, Run const& run) {
    Grid const& grid = kind.grid();
    Mask skeleton(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        skeleton[i] = kind[i] == solver::fixed_cell && !std::isnan(z[i]) ? 1 : 0;
    }
    Raster<std::int64_t> const nearest = nearest_cells(skeleton, run);
    parallel_ranges(run, grid.height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin * grid.width; i < end * grid.width; ++i) {
            if (kind[i] == solver::free_cell) {
                Cell const here = grid.at(i);
                Cell const there = grid.at(nearest[i]);
                auto const across = static_cast<double>(here.col - there.col);
                auto const along = static_cast<double>(here.row - there.row);
                double const distance = std::sqrt(across * across + along * along);
                value[i] += params.noise_m * (1.0 - portable::exp(-distance / noise_reach_cells)) *
                            value_noise(params.seed, here, params.noise_cells);
            }
        }
    });
}

} // namespace

Diffused diffuse(Skeleton const& skeleton, DiffuseParams const& params, Run const& run) {
    return diffuse(skeleton, Mask(), params, run);
}

Diffused diffuse(Skeleton const& skeleton, Mask const& inside, DiffuseParams const& params, Run const& run) {
    demand(params);
    auto problem = problem_through(skeleton.z, inside, "surface.diffuse", run);
    Raster<std::uint8_t> const kind = problem.kind;
    solver::GridSolution solution = spread(std::move(problem), params, run);
    smooth(kind, params, solution.value, run);
    if (params.noise_m > 0.0) {
        add_noise(kind, skeleton.z, params, solution.value, run);
    }
    return {heights_of(solution.value, kind, skeleton.z), solution.iterations, solution.residual};
}

} // namespace thalweg::surface
