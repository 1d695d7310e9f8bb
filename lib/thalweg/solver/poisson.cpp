// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/poisson.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/core/parallel.hpp>
#include <thalweg/core/sum_rows.hpp>
#include <thalweg/solver/conjugate_gradients.hpp>
#include <thalweg/solver/unreached.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace thalweg::solver {
namespace {

constexpr auto outside = static_cast<std::uint8_t>(CellKind::outside);
constexpr auto free_cell = static_cast<std::uint8_t>(CellKind::free);
constexpr auto fixed = static_cast<std::uint8_t>(CellKind::fixed);

/// What the cells of some rows hold.
struct Contents {
    std::int64_t free = 0;
    std::int64_t fixed = 0;
    std::int64_t outside = 0;
    std::int64_t bad = std::numeric_limits<std::int64_t>::max(); ///< first cell that cannot be used
    std::int64_t guesses = 0;                                    ///< free cells with a number other than 0
    std::int64_t unknown = 0;                                    ///< free cells with no finite number
    double least = std::numeric_limits<double>::infinity();      ///< of fixed cells
    double greatest = -std::numeric_limits<double>::infinity();
    double sum = 0.0;
    double size = 0.0; ///< greatest |value| of fixed cells, |source| of free ones

    Contents& operator+=(Contents const& o) {
        free += o.free;
        fixed += o.fixed;
        outside += o.outside;
        bad = std::min(bad, o.bad);
        guesses += o.guesses;
        unknown += o.unknown;
        least = std::min(least, o.least);
        greatest = std::max(greatest, o.greatest);
        sum += o.sum;
        size = std::max(size, o.size);
        return *this;
    }
};

Contents contents(GridProblem const& problem, Run const& run) {
    bool const laplace = problem.source.cells() == 0;
    std::int64_t const width = problem.kind.width();
    return sum_rows(run, problem.kind.height(), [&](std::int64_t row) {
        Contents c;
        for (std::int64_t i = row * width; i < (row + 1) * width; ++i) {
            double const value = problem.value[i];
            if (problem.kind[i] == fixed) {
                ++c.fixed;
                c.least = std::min(c.least, value);
                c.greatest = std::max(c.greatest, value);
                c.sum += value;
                c.size = std::max(c.size, std::fabs(value));
                c.bad = std::isfinite(value) ? c.bad : std::min(c.bad, i);
            } else if (problem.kind[i] == free_cell) {
                ++c.free;
                c.guesses += value != 0.0 ? 1 : 0;
                c.unknown += std::isfinite(value) ? 0 : 1;
                if (!laplace) {
                    c.size = std::max(c.size, std::fabs(problem.source[i]));
                    c.bad = std::isfinite(problem.source[i]) ? c.bad : std::min(c.bad, i);
                }
            } else {
                ++c.outside;
                c.bad = problem.kind[i] == outside ? c.bad : std::min(c.bad, i);
            }
        }
        return c;
    });
}

void demand(GridProblem const& problem, PoissonParams const& params) {
    if (!(params.tolerance > 0.0 && params.tolerance < 1.0)) {
        throw BadParameter(fmt::format("solver.solve_poisson: a tolerance of {}; it must be greater than 0 and less "
                                       "than 1",
                                       params.tolerance));
    }
    if (params.most_iterations < 0) {
        throw BadParameter(fmt::format("solver.solve_poisson: {} iterations at most; it cannot be less than 0",
                                       params.most_iterations));
    }
    Grid const& grid = problem.kind.grid();
    auto const fits = [&](Grid const& other) { return other.width == grid.width && other.height == grid.height; };
    if (!fits(problem.value.grid()) || (problem.source.cells() > 0 && !fits(problem.source.grid()))) {
        throw BadInput(fmt::format("solver.solve_poisson: kinds of {} x {} cells, values of {} x {}, a source of {} x "
                                   "{}; the three must have one frame",
                                   grid.width, grid.height, problem.value.width(), problem.value.height(),
                                   problem.source.width(), problem.source.height()));
    }
}

void demand_solvable(GridProblem const& problem, Contents const& all, Run const& run) {
    Grid const& grid = problem.kind.grid();
    if (all.bad < grid.cells()) {
        Cell const c = grid.at(all.bad);
        throw BadInput(fmt::format("solver.solve_poisson: the cell at column {}, row {} has the kind {}, the value {} "
                                   "and the source {}; a fixed cell needs a finite value, a free one a finite source",
                                   c.col, c.row, problem.kind[c], problem.value[c],
                                   problem.source.cells() > 0 ? problem.source[c] : 0.0));
    }
    if (all.free > 0 && (all.fixed == 0 || all.outside > 0)) {
        if (auto const lost = unreached(problem.kind, run); !lost.empty()) {
            throw BadInput(fmt::format("solver.solve_poisson: no path leads from the free cell at column {}, row {} to "
                                       "a fixed one; fix a cell of its part or put the part outside",
                                       lost.front().begin, lost.front().row));
        }
    }
}

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
    demand(problem, params);
    run.check();
    Contents const all = contents(problem, run);
    demand_solvable(problem, all, run);
    GridSolution solution;
    if (all.free > 0) {
        bool const laplace = problem.source.cells() == 0;
        GridRows const& rows = grid_rows(widest_grid_lanes());
        ColouredProblem coloured;
        coloured.levels = grid_levels(problem.kind, run);
        coloured.x = TwoColours<double>(coloured.levels.board);
        coloured.b = laplace ? nullptr : &problem.source;
        if (all.size > 0.0) {
            int exponent = 0;
            std::frexp(all.size, &exponent);
            coloured.scale = std::ldexp(1.0, -exponent);
        }
        spread(problem, FreeCells::zero, coloured.x, run);
        if (double const zero = residual_norm(coloured, rows, run); zero > 0.0) {
            if (all.guesses > 0 && all.unknown == 0) {
                spread(problem, FreeCells::guess, coloured.x, run);
            } else {
                start_from(all.sum / static_cast<double>(all.fixed), coloured.levels.degree, coloured.levels.board,
                           coloured.x, run);
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
