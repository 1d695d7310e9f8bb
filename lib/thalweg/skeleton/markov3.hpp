// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/skeleton/field_params.hpp>

namespace thalweg::skeleton {

/// Draws terrain by the recursion of Zhang, Liu and Li, for comparison: each height from its neighbours to the west and
/// north. The correlation length is not L = (lx + ly)/2 but that of ((1 - sqrt(1 - 4 A^2))/(2 A))^k, 5.7 cells for L =
/// 20, and it differs between the diagonals: use grf or separable_ar where it matters.
/// \param grid of the result
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return h(i,j) = A (h(i,j-1) + h(i-1,j)) + sqrt(1 - 2 rho^2/(1 + rho1)) R, A = rho/(1 + rho1), rho = exp(-1/L), rho1
/// = exp(-sqrt(2)/L), after a lead of 5 L rows and columns, scaled to the deviation std; the mean is added at the end,
/// where the published equation would multiply it
/// \throws BadParameter when a parameter is outside its range
/// \throws Cancelled
///
/// Source: \cite zhang, equations 1 to 3.
Raster<float> markov3(Grid const& grid, FieldParams const& params = {}, Run const& run = {});

} // namespace thalweg::skeleton
