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

/// Shortens rivers whose first cells stand perched. What is given up becomes land, below no river that is left beside
/// it. Gives: numbers in the caller's Channels.
std::vector<std::int64_t> give_up_tips(LandLevel& level, float tangent);

} // namespace thalweg::surface
