// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::surface {

/// Laplace's equation through the cells that have a height: those are fixed, other cells inside are free.
/// Takes: z: heights [m], NaN for none. inside: of z's frame, or of no cells for all of it; cells with 0 are left out,
/// and so is a height there. stage: "module.verb" for messages.
/// Gives: values of 0 in free cells; parts inside that no cell with a height reaches are left out too.
/// Throws: BadInput: no height (inside), an infinite one, another frame.
solver::GridProblem problem_through(Raster<float> const& z, Mask const& inside, char const* stage, Run const& run);

/// Replaces the values of free cells by a Gaussian mean of the cells around them that are not outside.
/// Takes: kind: a solver::CellKind a cell. sigma_cells > 0; weights exp(-x^2 / 2 sigma^2) along rows, then along
/// columns, as far as 3 sigma and at least one cell. Gives: fixed cells as they were; at borders and holes the weights
/// there are left out of the mean.
void smooth_free(Raster<std::uint8_t> const& kind, double sigma_cells, Raster<double>& value, Run const& run);

} // namespace thalweg::surface
