// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::surface {

/// Makes Laplace's equation through the cells with heights, which are fixed; other cells inside are free.
/// \param z [m] heights; NaN: none
/// \param inside in z's frame, or without cells: everywhere; cells of 0 are left out, also those with heights
/// \param stage "module.verb" for messages
/// \return free cells are 0; parts inside that contain no cell with a height are left out
/// \throws BadInput when no cell (inside) has a height, a height is infinite, or the frames differ
solver::GridProblem problem_through(Raster<float> const& z, Mask const& inside, char const* stage, Run const& run);

/// Smooths free cells by a Gaussian mean of the cells around them that are not outside: weights exp(-x^2 / 2 sigma^2)
/// along rows, then along columns, as far as 3 sigma and at least one cell. Fixed cells are unchanged; weights beyond
/// borders and in holes are left out of the mean.
/// \param kind solver::CellKind by cell
/// \param sigma_cells > 0
/// \param value smoothed in place
void smooth_free(Raster<std::uint8_t> const& kind, double sigma_cells, Raster<double>& value, Run const& run);

} // namespace thalweg::surface
