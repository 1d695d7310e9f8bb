// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/grid/relax_explicit.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/solver/grid/internal/coloured_problem.hpp>
#include <thalweg/solver/opencl/internal/relax_opencl.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace thalweg::solver {
namespace {

// Even numbers, so that a block's rows have the colours of the grid's.
constexpr std::int64_t block_rows = 32;
constexpr int sweeps_a_pass = 4; // what a block loses by the rows around it, it gains by staying in the cache

void demand(GridProblem const& problem, ExplicitParams const& params) {
    if (!(params.alpha > 0.0 && params.alpha <= 0.25)) {
        throw BadParameter(fmt::format("solver.relax_explicit: alpha is {}; it must be greater than 0 and at most 1/4, "
                                       "for beyond it sweeps make the differences between cells grow",
                                       params.alpha));
    }
    require_in("solver.relax_explicit", "sweeps", params.sweeps, Range::at_least(0));
    if (problem.source.cells() > 0) {
        throw BadInput("solver.relax_explicit: the problem has a source; solve_poisson takes one");
    }
}

/// A block of rows and those around it, before and after a sweep.
struct Block {
    explicit Block(std::int64_t width)
        : board{width, block_rows + 2 * std::int64_t{sweeps_a_pass}}, before(board), after(board) {}
    Board board;
    TwoColours<double> before, after;
};

/// Sweeps the rows [begin, end) of `from` some times, into `to`.
void sweep_block(TopLevel const& top, TwoColours<double> const& from, TwoColours<double>& to, std::int64_t begin,
                 std::int64_t sweeps, double alpha, Block& block, GridRows const& rows) {
    std::int64_t const n = top.board.half();
    std::int64_t const height = top.board.height;
    std::int64_t const base = begin - sweeps_a_pass;
    std::int64_t const end = std::min(height, begin + block_rows);
    for (std::int64_t y = base; y < base + block.board.height; ++y) {
        for (std::size_t const colour : {0U, 1U}) {
            double* const before = block.before.of[colour].row(y - base);
            if (y >= 0 && y < height) {
                std::copy_n(from.of[colour].row(y), n, before);
            } else {
                std::fill_n(before, n, 0.0);
                std::fill_n(block.after.of[colour].row(y - base), n, 0.0);
            }
        }
    }
    for (std::int64_t left = sweeps; left-- > 0;) {
        for (std::int64_t y = std::max<std::int64_t>(0, begin - left); y < std::min(height, end + left); ++y) {
            for (std::size_t const colour : {0U, 1U}) {
                rows.diffuse(block.after.of[colour].row(y - base), block.before.of[colour].row(y - base),
                             {top.degree.of[colour].row(y)},
                             around(block.before.of[1 - colour], y - base, static_cast<std::int64_t>(colour)), alpha,
                             n);
            }
        }
        std::swap(block.before, block.after);
    }
    for (std::int64_t y = begin; y < end; ++y) {
        for (std::size_t const colour : {0U, 1U}) {
            std::copy_n(block.before.of[colour].row(y - base), n, to.of[colour].row(y));
        }
    }
}

void sweep(ColouredProblem& problem, ExplicitParams const& params, GridRows const& rows, Run const& run) {
    Board const& board = problem.top.board;
    TwoColours<double> next(board);
    for (int done = 0; done < params.sweeps;) {
        run.at(static_cast<double>(done) / static_cast<double>(params.sweeps), "diffuse");
        int const now = std::min(sweeps_a_pass, params.sweeps - done);
        parallel_ranges(
            run, (board.height + block_rows - 1) / block_rows, 1, [&](std::int64_t first, std::int64_t last) {
                Block block(board.width);
                for (std::int64_t i = first; i < last; ++i) {
                    sweep_block(problem.top, problem.x, next, i * block_rows, now, params.alpha, block, rows);
                }
            });
        std::swap(problem.x, next);
        done += now;
    }
    run.at(1.0, "diffuse");
}

} // namespace

GridSolution relax_explicit(GridProblem problem, ExplicitParams const& params, Run const& run) {
    demand(problem, params);
    Contents const contents = look_through(problem, "solver.relax_explicit", run);
    if (contents.unknown > 0) {
        throw BadInput(fmt::format("solver.relax_explicit: {} free cells have no finite value; each needs one to start "
                                   "from",
                                   contents.unknown));
    }
    GridSolution solution;
    if (contents.free > 0) {
        GridRows const& rows = grid_rows(widest_lanes());
        ColouredProblem iterate = coloured(problem, contents, run);
        double const zero = residual_norm(iterate, rows, run);
        if (run.device == Device::opencl) {
            relax_opencl(problem, params.alpha, params.sweeps, run);
            spread_guess(problem, iterate, run);
        } else {
            spread_guess(problem, iterate, run);
            sweep(iterate, params, rows, run);
        }
        collect(iterate, contents, problem, run);
        solution.residual = zero > 0.0 ? residual_norm(iterate, rows, run) / zero : 0.0;
    }
    solution.iterations = params.sweeps;
    solution.value = std::move(problem.value);
    return solution;
}

} // namespace thalweg::solver
