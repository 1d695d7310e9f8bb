// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <thalweg/core/raster.hpp>

namespace thalweg::measure {

/// Finds river cells perched above their surroundings, such as walls and tips beside deeper valleys.
/// \param dem [m] by cell; NaN: no data
/// \param cells indices of river cells
/// \param rise_m [m] >= 0, mean slope (tangent) times cell size
/// \return in order: the cells more than rise_m above the lowest of the sixteen cells two columns or rows away, as far
/// as these are in the DEM; cells without data are not perched
/// \throws BadParameter when rise_m is not a number >= 0
/// \throws BadInput when a cell is outside the DEM
std::vector<std::int64_t> perched(Raster<float> const& dem, std::span<std::int64_t const> cells, double rise_m);

} // namespace thalweg::measure
