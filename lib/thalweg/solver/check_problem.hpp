// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>

#include <thalweg/core/run.hpp>
#include <thalweg/solver/poisson.hpp>

namespace thalweg::solver {

/// What the cells of a problem hold.
struct ProblemContents {
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

    ProblemContents& operator+=(ProblemContents const& o);
    bool guessed() const { return guesses > 0 && unknown == 0; }     ///< the free cells' values are a first guess
    double mean() const { return sum / static_cast<double>(fixed); } ///< of the fixed cells
    /// A power of 2 that brings size to between 1/2 and 1: squares of what it multiplies stay in range.
    double scale() const;
};

/// What solve_poisson asks of its input, whatever solves it.
/// Gives: what the cells hold; bad is beyond the last. Throws: as solve_poisson; Cancelled.
ProblemContents check_problem(GridProblem const& problem, PoissonParams const& params, Run const& run = {});

} // namespace thalweg::solver
