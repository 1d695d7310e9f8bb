// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::solver {

/// Options of relax_explicit().
struct ExplicitParams {
    double alpha = 0.25; ///< (0, 1/4] time step times diffusivity / area of a cell
    int sweeps = 5500;   ///< [0, ...]
};

/// Diffuses the values of free cells by explicit sweeps: U += alpha (sum over the 4-neighbours n that are not outside
/// of (U_n - U_c)), all cells at once.
/// \param problem without a source; finite initial values
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return fixed cells bit for bit; values between the lowest and highest fixed one; residual as in solve_poisson; the
/// same bytes for any number of threads
/// \throws BadParameter for alpha above 1/4, where the sweeps are unstable
/// \throws BadInput as solve_poisson, for a source, or for an initial value that is not finite
/// \throws Cancelled
///
/// Source: \cite nenu2015, equation 13 with its sign corrected.
GridSolution relax_explicit(GridProblem problem, ExplicitParams const& params = {}, Run const& run = {});

} // namespace thalweg::solver
