// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/internal/grid_levels.hpp>
#include <thalweg/solver/grid/internal/grid_rows.hpp>
#include <thalweg/solver/grid/poisson.hpp>

/// Inside of solve_poisson and relax_explicit: a GridProblem looked through, and in the two colours' order.
namespace thalweg::solver {

/// What the cells of a problem hold.
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

/// Takes: stage: "module.verb" for messages.
/// Throws: BadInput naming a cell: a part with free cells and no fixed one, a value or source that is not finite;
/// rasters of different frames; Cancelled.
Contents look_through(GridProblem const& problem, char const* stage, Run const& run);

/// A problem in the two colours' order.
struct ColouredProblem {
    TopLevel top;
    TwoColours<double> x;              ///< free and fixed cells: their values; 0 outside
    Raster<double> const* b = nullptr; ///< of free cells; none for Laplace's equation
    double scale = 1.0;                ///< power of two that brings what floats hold near 1
};

/// Gives: free cells at 0. Refers to the problem's source.
ColouredProblem coloured(GridProblem const& problem, Contents const& contents, Run const& run);

/// Sets the free cells of x to their first guess.
void spread_guess(GridProblem const& problem, ColouredProblem& coloured, Run const& run);

/// Sets the free cells of x, which are 0, to their first guess, or without one to the mean of the fixed cells.
void set_guess(GridProblem const& problem, Contents const& contents, ColouredProblem& coloured, Run const& run);

/// Free cells of the problem take what x has; for Laplace's equation brought between the least and the greatest value
/// of `contents`.
void collect(ColouredProblem const& coloured, Contents const& contents, GridProblem& problem, Run const& run);

/// What term(row) gives for each row of a board.
template <class Part = double, class Term>
Indexed<RowIndex, Part> each_row(Board const& board, Run const& run, Term const& term) {
    Indexed<RowIndex, Part> parts(board.height);
    parallel_ranges(run, board.height, rows_a_range(board), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            parts[y] = term(y);
        }
    });
    return parts;
}

/// Added in the order of the rows.
double sum_of(std::vector<double> const& parts);

/// Residual of a row of one colour, times scale; r: as long as the stride.
void residual_row(ColouredProblem const& problem, std::int64_t y, int colour, float* r, GridRows const& rows);

/// Norm of the problem's residual times scale, counted in double from x.
double residual_norm(ColouredProblem const& problem, GridRows const& rows, Run const& run);

} // namespace thalweg::solver
