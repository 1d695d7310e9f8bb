// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::solver {

/// Options of relax_explicit().
struct ExplicitParams {
    double alpha = 0.25; ///< (0,1/4] step of time times diffusivity, over the cell's area
    int sweeps = 5500;   ///< [0, ...]
};

/// Diffuses the values of free cells from their first guess: U += alpha (sum over the 4-neighbours n that are not
/// outside of (U_n - U_c)), all cells at once, sweep after sweep.
/// \param problem a problem without a source
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return fixed cells bit for bit; values between the least and the greatest fixed one; the residual as solve_poisson
/// counts it; the same bytes for any number of threads.
/// \throws BadParameter an alpha beyond 1/4, where sweeps make differences grow
/// \throws BadInput as solve_poisson, or with a source, or for a first guess that is not finite
/// \throws Cancelled
///
/// Source: \cite nenu2015, equation 13 with its sign mended.
GridSolution relax_explicit(GridProblem problem, ExplicitParams const& params = {}, Run const& run = {});

} // namespace thalweg::solver
