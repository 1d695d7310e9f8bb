// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Whether water leaves the caller's grid from river cell number n of a level.
bool leaves_grid(RiverCells const& rivers, std::size_t n);

/// Whether a river cell stands above the lowest cell of its second ring by more than a tangent times a cell.
bool is_perched(LandLevel const& level, std::uint32_t cell, float tangent);

/// Numbers in the caller's Channels of river cells that stand perched above what they do not run through themselves, in
/// order.
std::vector<std::int64_t> walled_cells(LandLevel const& level, float tangent);

/// Lowers such cells as far as they stay a step above their receivers, which are lowered with them for a short way.
void lower_perched(LandLevel& level, float tangent, float step);

/// Raises the land two to four cells from a perched river cell until that stands perched no more, on a slope.
void raise_below_perched(LandLevel& level, float tangent);

} // namespace thalweg::surface
