// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/surface/land_level.hpp>

/// Private to this room.
namespace thalweg::surface {

/// Numbers in the caller's Channels of river cells that stand perched: above the lowest cell of their second ring by
/// more than a tangent times a cell. In order.
std::vector<std::int64_t> perched_cells(LandLevel const& level, float tangent);

/// Lowers such cells as far as they stay a step above their receivers, which are lowered with them for a short way.
void lower_perched(LandLevel& level, float tangent, float step);

/// Raises the land two to four cells from a perched river cell until that stands perched no more, on a slope.
void raise_below_perched(LandLevel& level, float tangent);

/// Shortens rivers by the cells that stand perched near their heads, and what lies upstream of these. What is given up
/// becomes land; where banks stay, none that would lie below a river beside it. Gives: numbers in the caller's
/// Channels.
enum class TipBanks : std::uint8_t { stay, rise };
std::vector<std::int64_t> give_up_tips(LandLevel& level, float tangent, TipBanks banks);

} // namespace thalweg::surface
