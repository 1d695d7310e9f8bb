// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

/// The rivers' points, and the steps that move them.
namespace thalweg::network {

/// A river from its source to where a larger one takes its name, or its outlet, as points along it.
struct Stem {
    std::size_t begin = 0; ///< number of its first point
    std::size_t end = 0;   ///< after that of its last
    NodeId source = 0;
    NodeId mouth = 0; ///< node in which it ends: a point of the river it joins, or the outlet
    bool joins = false;
};

/// A network as points along its rivers, and back.
struct Stems {
    std::vector<Stem> stems;              ///< every one after that which it joins
    std::vector<Vec2> at;                 ///< [m] by point: vertices, and between them so that steps are a cell or less
    std::vector<double> way_m;            ///< [m] by point: from the stem's beginning
    std::vector<double> area_m2;          ///< [m2] by point: of its arc
    std::vector<std::size_t> stem_of;     ///< by point
    std::vector<std::size_t> first_point; ///< by arc
    std::vector<std::size_t> last_point;  ///< by arc
    std::vector<std::size_t> node_point;  ///< by node with arcs: its point on the largest river through it
};

/// Equal steps between two vertices, of one cell and a half at most: how many, and one of them.
struct EvenSteps {
    double count;
    Vec2 step;
};

EvenSteps steps_between(Vec2 from, Vec2 to, double step_m);

/// Takes: a forest, its index, by arc its area [m2], and the step [m]. At a node the river of the largest area goes on
/// (ties: the lower arc number).
Stems stems_of(StreamNetwork const& network, std::vector<double> const& area_m2, double step_m);

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

/// How far each point shall move [m] so that tributaries come down beside the river they join: those that would meet
/// the river above at more than 50 to 80 degrees (by chance) turn about their mouth, less and less up to 40 cells from
/// it. Gives: by point; 0 where rivers end.
/// Source: mean junction angles of 45 to 72 degrees, \cite seybold2017.
std::vector<Vec2> lean_in(Stems const& stems, std::vector<Vec2> const& at, double cell_m, std::uint64_t seed);

} // namespace thalweg::network
