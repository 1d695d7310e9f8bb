// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run.hpp>
#include <thalweg/solver/grid_levels.hpp>
#include <thalweg/solver/grid_rows.hpp>

namespace thalweg::solver {

/// A problem in the two colours' order.
struct ColouredProblem {
    GridLevels levels;
    TwoColours<double> x;              ///< free and fixed cells: their values; 0 outside
    Raster<double> const* b = nullptr; ///< of free cells; none for Laplace's equation
    double scale = 1.0;                ///< power of two that brings what floats hold near 1
};

struct Goal {
    double tolerance = 0.0; ///< of the residual's norm, and of the values' error as a cycle sees it
    int most_iterations = 0;
};

struct Convergence {
    int iterations = 0;
    double residual = 0.0; ///< norm reached, in units of scale
};

/// Norm of the problem's residual, counted in double from x.
double residual_norm(ColouredProblem const& problem, GridRows const& rows, Run const& run);

/// Improves x until the norm of the residual is at most tolerance * zero, and twice the greatest correction another
/// cycle would make at most tolerance times the greatest value: conjugate gradients with v_cycle for preconditioner.
/// x is held in double, the rest in floats; each time the residual has fallen a thousandfold, and before returning, it
/// is counted anew from x, so that floats do not bound the accuracy.
/// Takes: zero: the norm at which nothing is done yet.
/// Throws: NotConverged: after most iterations, or where double has no more digits; Cancelled.
Convergence conjugate_gradients(ColouredProblem& problem, double zero, Goal const& goal, GridRows const& rows,
                                Run const& run);

} // namespace thalweg::solver
