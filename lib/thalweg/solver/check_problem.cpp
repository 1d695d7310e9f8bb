// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/check_problem.hpp>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>

namespace thalweg::solver {

namespace {

constexpr auto outside = static_cast<std::uint8_t>(CellKind::outside);
constexpr auto free_cell = static_cast<std::uint8_t>(CellKind::free);
constexpr auto fixed = static_cast<std::uint8_t>(CellKind::fixed);

void check_numbers(GridProblem const& problem, char const* stage) {
    Grid const& grid = problem.kind.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        std::uint8_t const kind = problem.kind[i];
        if (kind > fixed) {
            throw BadInput(
                fmt::format("{}: cell column {}, row {} is of kind {}, which is none", stage, c.col, c.row, kind));
        }
        if (kind == outside) {
            continue;
        }
        if (kind == fixed && !std::isfinite(problem.value[i])) {
            throw BadInput(fmt::format("{}: the value at column {}, row {} is {}: give every fixed cell a number",
                                       stage, c.col, c.row, problem.value[i]));
        }
        if (kind == free_cell && problem.source.cells() > 0 && !std::isfinite(problem.source[i])) {
            throw BadInput(fmt::format("{}: the source at column {}, row {} is {}: give every free cell a number",
                                       stage, c.col, c.row, problem.source[i]));
        }
    }
}

/// Floods from the fixed cells; a free cell that stays dry has none.
void check_parts(Raster<std::uint8_t> const& kind, char const* stage, Run const& run) {
    Grid const& grid = kind.grid();
    std::vector<std::uint8_t> wet(static_cast<std::size_t>(grid.cells()), 0);
    std::vector<std::int64_t> wave;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (kind[i] == fixed) {
            wet[static_cast<std::size_t>(i)] = 1;
            wave.push_back(i);
        }
    }
    while (!wave.empty()) {
        run.check();
        std::vector<std::int64_t> next;
        for (std::int64_t const i : wave) {
            Cell const c = grid.at(i);
            for (Cell const n :
                 {Cell{c.col - 1, c.row}, Cell{c.col + 1, c.row}, Cell{c.col, c.row - 1}, Cell{c.col, c.row + 1}}) {
                if (grid.contains(n) && kind[n] != outside) {
                    auto& seen = wet[static_cast<std::size_t>(grid.index(n))];
                    if (seen == 0) {
                        seen = 1;
                        next.push_back(grid.index(n));
                    }
                }
            }
        }
        wave = std::move(next);
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (kind[i] == free_cell && wet[static_cast<std::size_t>(i)] == 0) {
            Cell const c = grid.at(i);
            throw BadInput(fmt::format("{}: the part of the grid with the free cell at column {}, row {} has no fixed "
                                       "cell: fix one there or put the part outside",
                                       stage, c.col, c.row));
        }
    }
}

} // namespace

void check_problem(GridProblem const& problem, PoissonParams const& params, char const* stage, Run const& run) {
    if (!(params.tolerance > 0.0 && params.tolerance < 1.0)) {
        throw BadParameter(
            fmt::format("{}: tolerance is {}: a number between 0 and 1 is wanted", stage, params.tolerance));
    }
    if (params.most_iterations < 0) {
        throw BadParameter(
            fmt::format("{}: most_iterations is {}: 0 or more are wanted", stage, params.most_iterations));
    }
    Grid const& grid = problem.kind.grid();
    auto const other_size = [&](Raster<double> const& raster) {
        return raster.width() != grid.width || raster.height() != grid.height;
    };
    if (other_size(problem.value) || (problem.source.cells() > 0 && other_size(problem.source))) {
        throw BadInput(fmt::format("{}: {} x {} kinds of cells, {} x {} values, {} x {} sources: one of each a cell is "
                                   "wanted, or no sources",
                                   stage, grid.width, grid.height, problem.value.width(), problem.value.height(),
                                   problem.source.width(), problem.source.height()));
    }
    check_numbers(problem, stage);
    check_parts(problem.kind, stage, run);
}

} // namespace thalweg::solver
