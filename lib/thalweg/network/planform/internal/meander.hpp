// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

// Described in docs/equilibrium.md.

/// The rivers' points, and the steps that move them.
namespace thalweg::network {

/// A river from its source to the confluence with a larger one, or to its outlet, as points.
struct Stem {
    std::size_t begin = 0; ///< number of its first point
    std::size_t end = 0;   ///< number after its last point
    NodeId source = 0;
    NodeId mouth = 0; ///< node at which it ends: on the river it joins, or the outlet
    bool joins = false;
};

/// A network as points along its rivers, and its conversion back.
struct Stems {
    std::vector<Stem> stems;     ///< every stem after its receiver
    std::vector<Vec2> at;        ///< [m] by point: vertices, with intermediate points so that steps are at most a cell
    std::vector<double> way_m;   ///< [m] by point: from the stem's beginning
    std::vector<double> area_m2; ///< [m2] by point: area of its arc
    std::vector<std::uint32_t> stem_of;   ///< by point
    std::vector<std::size_t> first_point; ///< by arc
    std::vector<std::size_t> last_point;  ///< by arc
    std::vector<std::size_t> node_point;  ///< by node with arcs: its point on the largest river through it
};

/// Equal steps of at most a cell and a half between two vertices: their number, and one of them.
struct EvenSteps {
    double count;
    Vec2 step;
};

EvenSteps steps_between(Vec2 from, Vec2 to, double step_m);

/// Converts a network to points. At a node the river of the largest area continues (ties: the lower arc number).
/// \param network a forest
/// \param area_m2 [m2] by arc
/// \param step_m [m] step
Stems stems_of(StreamNetwork const& network, std::vector<double> const& area_m2, double step_m);

/// By cell: distance to fixed cells (the sea, and cells around outlets), up to 24 [cells].
/// \param network any
/// \param grid of the result
/// \param land 0: sea; without cells: all land
Raster<std::uint8_t> distance_to_fixed(StreamNetwork const& network, Grid const& grid, Mask const& land);

/// Bends the plain by long shear waves in all directions, which fade to 0 at the grid's border and at fixed cells.
/// \param at positions within the grid
/// \param to_fixed from distance_to_fixed
/// \param gain slope of the waves; 1 gives rivers a sinuosity of about 1.05
/// \param seed random seed
/// \return the moved positions; those on the border or at an outlet bit for bit
std::vector<Vec2> bend_plain(std::vector<Vec2> at, Raster<std::uint8_t> const& to_fixed, double gain,
                             std::uint64_t seed);

/// The wavelength of each point's river, from its area there and nearby.
/// \return [m] by point
std::vector<double> wavelengths(Stems const& stems, double cell_m);

/// How far lines are smoothed: by river size, or within half a cell between fixed nodes.
enum class Rounding : std::uint8_t { river, half_a_cell };

/// Computes the shift of each point [m] to a smoothed line.
/// \param wave_m from wavelengths; read where lines are smoothed by river size
/// \return by point; 0 at the ends of rivers
std::vector<Vec2> smoothing(Stems const& stems, std::vector<Vec2> const& at, std::vector<double> const& wave_m,
                            double cell_m, Rounding rounding);

/// A river's bends; smaller ones within them, without which long bends would run straight along the grid; and bends of
/// parts that are still straight for over 20 cells.
enum class MeanderKind : std::uint8_t { bends, reaches, straights };

/// Computes the shift of each point [m] across its river, by noise whose wavelength and amplitude grow with drainage
/// area.
/// \param wave_m from wavelengths
/// \return by point; 0 at an outlet and where a river joins another
std::vector<Vec2> meander_shifts(Stems const& stems, std::vector<Vec2> const& at, std::vector<double> wave_m,
                                 double cell_m, double gain, MeanderKind which, std::uint64_t seed);

/// Computes the shift of each point [m] that makes tributaries approach the river they join from upstream: those that
/// would meet it at more than 50 to 80 degrees (random) turn about their mouth, less with distance, up to 40 cells from
/// it.
/// \return by point; 0 where rivers end
///
/// Source: mean junction angles of 45 to 72 degrees, \cite seybold2017.
std::vector<Vec2> lean_in(Stems const& stems, std::vector<Vec2> const& at, double cell_m, std::uint64_t seed);

} // namespace thalweg::network
