// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/network/planform/internal/meander.hpp>

/// Steps of meander. Private to this module.
namespace thalweg::network {

/// By cell how far it is from what does not move, up to 24 [cells]: the sea, and the cells around outlets.
/// Takes: land (1; sea 0), without cells where all is land.
Raster<std::uint8_t> distance_to_fixed(StreamNetwork const& network, Grid const& grid, Mask const& land);

/// Bends the plain by long shear waves in all directions, which fade to nothing at the grid's edge and at what does not
/// move.
/// Takes: places within the grid; the waves' slope, gain 1 gives rivers a sinuosity of some 1.05. Gives: the places
/// moved; a place on the edge or an outlet stays bit for bit.
std::vector<Vec2> bend_plain(std::vector<Vec2> at, Raster<std::uint8_t> const& to_fixed, double gain,
                             std::uint64_t seed);

/// How far lines are smoothed: as a river's size allows, or within half a cell between nodes that stay.
enum class Rounding : std::uint8_t { river, half_a_cell };

/// How far each point shall move [m] to a smoothed line. Gives: by point; 0 at the ends of rivers.
std::vector<Vec2> smoothing(Stems const& stems, std::vector<Vec2> const& at, double cell_m, Rounding rounding);

/// A river's bends; smaller ones within them, without which long bends run straight along the grid; and those of what
/// is straight for over 20 cells nevertheless.
enum class Wandering : std::uint8_t { bends, reaches, straights };

/// How far each point shall move [m] across its river, by noise whose wave and amplitude grow with drainage area.
/// Gives: by point; 0 at an outlet and where a river joins another.
std::vector<Vec2> wander(Stems const& stems, std::vector<Vec2> const& at, double cell_m, double gain, Wandering which,
                         std::uint64_t seed);

} // namespace thalweg::network
