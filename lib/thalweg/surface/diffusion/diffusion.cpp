// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/diffusion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/surface/diffusion/internal/diffusion.hpp>

namespace thalweg::surface {
namespace {

using solver::CellKind;

CellKind kind_of(float z, bool inside) {
    if (!inside) {
        return CellKind::outside;
    }
    return std::isnan(z) ? CellKind::free : CellKind::fixed;
}

// Converts a problem's values to heights [m]: those of fixed cells, which were floats, keep their bits, free ones are
// rounded once, cells outside are NaN. kind: solver::CellKind by cell.
Raster<float> heights_of(Raster<double> const& value, Raster<std::uint8_t> const& kind) {
    Raster<float> heights(kind.grid(), std::numeric_limits<float>::quiet_NaN());
    for (std::int64_t i = 0; i < heights.cells(); ++i) {
        if (kind[i] != solver::outside_cell) {
            heights[i] = static_cast<float>(value[i]);
        }
    }
    return heights;
}

/// Weights of the cells 0 .. radius away.
std::vector<double> weights_of(double sigma_cells) {
    std::vector<double> weights;
    for (int x = 0; x <= std::max(1.0, std::floor(3.0 * sigma_cells)); ++x) {
        weights.push_back(portable::exp(-0.5 * (x / sigma_cells) * (x / sigma_cells)));
    }
    return weights;
}

/// Sums along one line of cells: of values and of the weights that count.
struct Sums {
    Raster<double> value;
    Raster<double> weight;
};

/// Calls add(distance, index of the other cell) for the cells of a line of `count` around position `at`.
template <class Add> void around_on_line(std::int64_t at, std::int64_t count, std::int64_t radius, Add const& add) {
    for (std::int64_t other = std::max<std::int64_t>(0, at - radius); other <= std::min(count - 1, at + radius);
         ++other) {
        add(static_cast<std::size_t>(std::abs(other - at)), other);
    }
}

constexpr std::int64_t side = 8;

Cell block_of(Cell c) {
    return {c.col / side, c.row / side};
}

// Initialises the free cells of a problem with the steady state on cells eight times as large, whose heights are the
// means of their fixed cells. Each part of the problem needs a fixed cell.
void start_coarse(solver::GridProblem& problem, Run const& run) {
    Grid const& grid = problem.kind.grid();
    Grid const blocks{(grid.width + side - 1) / side, (grid.height + side - 1) / side, 1.0, 0.0, 0.0, ""};
    solver::GridProblem coarse{Raster<std::uint8_t>(blocks, solver::outside_cell), Raster<double>(blocks), {}};
    Raster<std::int32_t> count(blocks);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const block = block_of(grid.at(i));
        if (problem.kind[i] == solver::fixed_cell) {
            coarse.kind[block] = solver::fixed_cell;
            coarse.value[block] += problem.value[i];
            ++count[block];
        } else if (problem.kind[i] == solver::free_cell && coarse.kind[block] == solver::outside_cell) {
            coarse.kind[block] = solver::free_cell;
        }
    }
    for (std::int64_t i = 0; i < blocks.cells(); ++i) {
        coarse.value[i] = count[i] > 0 ? coarse.value[i] / count[i] : 0.0;
    }
    // A path to a fixed cell passes through neighbouring blocks, so that each part of the coarse problem has a fixed
    // cell.
    Raster<double> const value = solver::solve_poisson(std::move(coarse), {1e-4, 1000}, run).value;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        problem.value[i] = problem.kind[i] == solver::free_cell ? value[block_of(grid.at(i))] : problem.value[i];
    }
}

constexpr int sweeps_after_smoothing = 20;
constexpr double noise_reach_cells = 4.0;

void require(DiffuseParams const& params) {
    constexpr char const* self = "surface.diffuse";
    require_in(self, "tolerance", params.tolerance, Range::inside(0.0, 1.0));
    refuse_if<BadParameter>(!(params.alpha > 0.0 && params.alpha <= 0.25), "surface.diffuse",
                            "alpha is {}; give one above 0 and at most 1/4: beyond it a cell takes more from its four "
                            "neighbours than the difference, and differences grow from sweep to sweep",
                            params.alpha);
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

void add_noise(Raster<std::uint8_t> const& kind, DiffuseParams const& params, Raster<double>& value, Run const& run) {
    Grid const& grid = kind.grid();
    Mask skeleton(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        skeleton[i] = kind[i] == solver::fixed_cell ? 1 : 0;
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

solver::GridProblem problem_through(Raster<float> const& z, Mask const& inside, char const* stage, Run const& run) {
    Grid const& grid = z.grid();
    if (inside.cells() > 0) {
        require_same_grid(inside.grid(), grid, stage, "the mask and the heights", "make both on one grid");
    }
    run.check();
    solver::GridProblem problem{Raster<std::uint8_t>(grid), Raster<double>(grid), {}};
    bool any = false;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        CellKind const kind = kind_of(z[i], inside.cells() == 0 || inside[i] != 0);
        problem.kind[i] = static_cast<std::uint8_t>(kind);
        if (kind == CellKind::fixed) {
            if (std::isinf(z[i])) {
                Cell const c = grid.at(i);
                throw BadInput(stage,
                               fmt::format("an infinite height at column {}, row {}; give finite ones", c.col, c.row));
            }
            problem.value[i] = static_cast<double>(z[i]);
            any = true;
        }
    }
    refuse_if<BadInput>(!any, stage,
                        "no cell of the {} x {} (inside the mask, where there is one) has a height; a surface needs "
                        "one to pass through",
                        grid.width, grid.height);
    for (solver::CellSpan const& span : solver::unreached(problem.kind, run)) {
        for (std::int64_t col = span.begin; col < span.end; ++col) {
            problem.kind[{col, span.row}] = solver::outside_cell;
        }
    }
    return problem;
}

void smooth_free(Raster<std::uint8_t> const& kind, double sigma_cells, Raster<double>& value, Run const& run) {
    auto const weights = weights_of(sigma_cells);
    auto const radius = static_cast<std::int64_t>(weights.size()) - 1;
    std::int64_t const width = kind.width();
    std::int64_t const height = kind.height();
    Sums along{Raster<double>(kind.grid()), Raster<double>(kind.grid())};
    parallel_ranges(run, height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < width; ++col) {
                double sum = 0.0;
                double weight = 0.0;
                around_on_line(col, width, radius, [&](std::size_t distance, std::int64_t other) {
                    if (kind[{other, row}] != solver::outside_cell) {
                        sum += weights[distance] * value[{other, row}];
                        weight += weights[distance];
                    }
                });
                along.value[{col, row}] = sum;
                along.weight[{col, row}] = weight;
            }
        }
    });
    parallel_ranges(run, height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < width; ++col) {
                if (kind[{col, row}] == solver::free_cell) {
                    double sum = 0.0;
                    double weight = 0.0;
                    around_on_line(row, height, radius, [&](std::size_t distance, std::int64_t other) {
                        sum += weights[distance] * along.value[{col, other}];
                        weight += weights[distance] * along.weight[{col, other}];
                    });
                    value[{col, row}] = sum / weight;
                }
            }
        }
    });
}

DiffusedDem diffuse(Skeleton skeleton, DiffuseParams const& params, Run const& run) {
    return diffuse(std::move(skeleton), Mask(), params, run);
}

DiffusedDem diffuse(Skeleton skeleton, Mask const& inside, DiffuseParams const& params, Run const& run) {
    require(params);
    auto problem = problem_through(skeleton.z, inside, "surface.diffuse", run);
    skeleton.z = {}; // the problem has its heights
    Raster<std::uint8_t> const kind = problem.kind;
    solver::GridSolution solution = spread(std::move(problem), params, run);
    smooth(kind, params, solution.value, run);
    if (params.noise_m > 0.0) {
        add_noise(kind, params, solution.value, run);
    }
    return {heights_of(solution.value, kind), solution.iterations, solution.residual};
}

Raster<float> harmonic(Valley valley, Run const& run) {
    return harmonic(std::move(valley), {}, run);
}

Raster<float> harmonic(Valley valley, Mask const& inside, Run const& run) {
    return harmonic(std::move(valley), inside, HarmonicParams{}, run);
}

Raster<float> harmonic(Valley valley, Mask const& inside, HarmonicParams const& params, Run const& run) {
    auto problem = problem_through(valley.z, inside, "surface.harmonic", run);
    valley.z = {}; // the problem has its heights
    Raster<std::uint8_t> const kind = problem.kind;
    return heights_of(solver::solve_poisson(std::move(problem), {params.tolerance, 1000}, run).value, kind);
}

} // namespace thalweg::surface
