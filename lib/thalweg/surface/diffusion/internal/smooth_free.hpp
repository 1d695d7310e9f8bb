// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::surface {

/// Replaces the values of free cells by a Gaussian mean of the cells around them that are not outside.
/// Takes: kind: a solver::CellKind a cell. sigma_cells > 0; weights exp(-x^2 / 2 sigma^2) along rows, then along
/// columns, as far as 3 sigma and at least one cell. Gives: fixed cells as they were; at borders and holes the weights
/// there are left out of the mean.
void smooth_free(Raster<std::uint8_t> const& kind, double sigma_cells, Raster<double>& value, Run const& run);

} // namespace thalweg::surface
