// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/poisson.hpp>

#include <thalweg/core/parallel.hpp>
#include <thalweg/solver/check_problem.hpp>
#include <thalweg/solver/conjugate_gradients.hpp>
#include <thalweg/solver/poisson_opencl.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace thalweg::solver {
namespace {

constexpr auto free_cell = static_cast<std::uint8_t>(CellKind::free);
constexpr auto fixed = static_cast<std::uint8_t>(CellKind::fixed);

enum class FreeCells : std::uint8_t { zero, guess };

/// Values in the two colours' order.
void spread(GridProblem const& problem, FreeCells free, TwoColours<double>& x, Run const& run) {
    parallel_ranges(run, problem.kind.height(), 32, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            auto const kind = problem.kind.row(y);
            auto const value = problem.value.row(y);
            double* const of[2] = {x.of[Board::first(y, 0)].row(y), x.of[1 - Board::first(y, 0)].row(y)};
            for (std::size_t i = 0; i < kind.size(); ++i) {
                bool const taken = kind[i] == fixed || (kind[i] == free_cell && free == FreeCells::guess);
                of[i & 1][i / 2] = taken ? value[i] : 0.0;
            }
        }
    });
}

/// Sets the free cells of x, which are 0.
void start_from(double value, TwoColours<std::uint8_t> const& degree, Board const& board, TwoColours<double>& x,
                Run const& run) {
    parallel_ranges(run, board.height, 32, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            for (int colour : {0, 1}) {
                std::uint8_t const* const free = degree.of[colour].row(y);
                double* const to = x.of[colour].row(y);
                for (std::int64_t k = 0; k < board.half(); ++k) {
                    to[k] += free[k] != 0 ? value : 0.0;
                }
            }
        }
    });
}

/// Free cells of problem.value take what x has, brought between least and greatest.
void collect(TwoColours<double> const& x, double least, double greatest, GridProblem& problem, Run const& run) {
    parallel_ranges(run, problem.kind.height(), 32, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            auto const kind = problem.kind.row(y);
            auto const value = problem.value.row(y);
            double const* const of[2] = {x.of[Board::first(y, 0)].row(y), x.of[1 - Board::first(y, 0)].row(y)};
            for (std::size_t i = 0; i < kind.size(); ++i) {
                value[i] = kind[i] == free_cell ? std::clamp(of[i & 1][i / 2], least, greatest) : value[i];
            }
        }
    });
}

} // namespace

GridSolution solve_poisson(GridProblem problem, PoissonParams const& params, Run const& run) {
    ProblemContents const all = check_problem(problem, params, run);
    if (run.device == Device::opencl) {
        return solve_poisson_opencl(std::move(problem), all, params, run);
    }
    GridSolution solution;
    if (all.free > 0) {
        bool const laplace = problem.source.cells() == 0;
        GridRows const& rows = grid_rows(widest_grid_lanes());
        ColouredProblem coloured;
        coloured.levels = grid_levels(problem.kind, run);
        coloured.x = TwoColours<double>(coloured.levels.board);
        coloured.b = laplace ? nullptr : &problem.source;
        coloured.scale = all.scale();
        spread(problem, FreeCells::zero, coloured.x, run);
        if (double const zero = residual_norm(coloured, rows, run); zero > 0.0) {
            if (all.guessed()) {
                spread(problem, FreeCells::guess, coloured.x, run);
            } else {
                start_from(all.mean(), coloured.levels.degree, coloured.levels.board, coloured.x, run);
            }
            Convergence const reached =
                conjugate_gradients(coloured, zero, {params.tolerance, params.most_iterations}, rows, run);
            solution.iterations = reached.iterations;
            solution.residual = reached.residual / zero;
        }
        double const none = std::numeric_limits<double>::infinity();
        collect(coloured.x, laplace ? all.least : -none, laplace ? all.greatest : none, problem, run);
    }
    solution.value = std::move(problem.value);
    return solution;
}

} // namespace thalweg::solver
