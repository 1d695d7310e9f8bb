// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg::network {

inline constexpr int most_room = 255;

/// How much room the cells of a region have: the Chebyshev distance to the nearest cell outside it.
/// Takes: 0 outside; what lies beyond the grid is outside. Gives: in a frame of one cell, 0 outside, at most most_room.
Raster<std::uint8_t> room_in(Mask const& region);

} // namespace thalweg::network
