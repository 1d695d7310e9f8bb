// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/internal/coarse_start.hpp>

#include <utility>

namespace thalweg::surface {
namespace {

constexpr std::int64_t side = 8;

Cell block_of(Cell c) {
    return {c.col / side, c.row / side};
}

} // namespace

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
    // A path to a fixed cell passes through blocks that are neighbours: each part of them has a fixed one.
    Raster<double> const value = solver::solve_poisson(std::move(coarse), {1e-4, 1000}, run).value;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        problem.value[i] = problem.kind[i] == solver::free_cell ? value[block_of(grid.at(i))] : problem.value[i];
    }
}

} // namespace thalweg::surface
