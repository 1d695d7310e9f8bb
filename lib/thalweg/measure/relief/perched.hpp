// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <thalweg/core/raster.hpp>

namespace thalweg::measure {

/// River cells that stand above their surroundings, as an aqueduct or a tip beside a deeper valley does.
/// \pre cells by index
/// \param dem [m] heights by cell; NaN: no data
/// \param cells the cells
/// \param rise_m the land's mean slope as a tangent, times the cell size
/// \return those, in their order, that are higher by more than rise_m than the lowest of their second ring: the sixteen
/// cells two columns or rows away, as far as the DEM has them. A cell without a height is none.
/// \throws BadParameter when rise_m is not a number from 0
/// \throws BadInput when a cell is not in the DEM
std::vector<std::int64_t> perched(Raster<float> const& dem, std::span<std::int64_t const> cells, double rise_m);

} // namespace thalweg::measure
