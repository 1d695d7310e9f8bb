// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/internal/coloured_problem.hpp>
#include <thalweg/solver/grid/internal/grid_levels.hpp>
#include <thalweg/solver/grid/internal/grid_rows.hpp>

namespace thalweg::solver {

struct Goal {
    double tolerance = 0.0; ///< of the residual's norm, and of the values' error as a cycle sees it
    int most_iterations = 0;
};

struct Convergence {
    int iterations = 0;
    double residual = 0.0; ///< norm reached, in units of scale
};

/// Improves x until the norm of the residual is at most tolerance * zero, and four times the greatest correction
/// another cycle would make at most tolerance times the greatest value: conjugate gradients with v_cycle for
/// preconditioner. x is held in double, the rest in floats; each time the residual has fallen a thousandfold, and
/// before returning, it is counted anew from x, so that floats do not bound the accuracy. Takes: levels: of the
/// problem. zero: the norm at which nothing is done yet. Throws: NotConverged: after most iterations, or where double
/// has no more digits; Cancelled.
Convergence conjugate_gradients(ColouredProblem& problem, std::vector<CoarseLevel>& levels, double zero,
                                Goal const& goal, GridRows const& rows, Run const& run);

} // namespace thalweg::solver
