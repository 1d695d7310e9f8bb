// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: Rivers that were grown or drawn coarsely run in straight pieces. They are bent in layers.
// First the plain with all rivers on it is sheared by long waves, which bends everything alike, so
// that hardly anything can cross. Then every river gets bends of its own: alternating half waves of
// random size along it, whose length follows from its drainage area (twelve widths of its valley
// floor), smaller waves within them, and bends where it still runs straight. Tributaries turn to
// come down beside the river they join. After each layer exact predicates look for rivers that meet
// or come too close; shifts there are halved, less so at their neighbours, until none do.
// Source: wavelengths of 10 to 14 widths: Leopold and Wolman 1960; junction angles: Seybold et al.
// 2017; the layers and the halving are ours (docs/equilibrium.md, "Rivers that look like rivers").
// Cost: docs/performance.md: 162 ns and 19 bytes a cell for 2048 x 2048, 2.1 times the time in
// which these rivers grow; time as cells ^ 1.13. The search for crowded points runs on all cores.
// Not for: rivers of a file, whose places are known; physics: bends do not migrate, cut off or
// leave oxbows. gain = 0 only rounds corners within half a cell.
// Example:
//     MeanderedNetwork const bent = meander(network, grid, area_m2, {.gain = 1.0, .seed = 3});
//     StreamNetwork const& rivers = bent.network; // the same arcs between the same nodes

namespace thalweg::network {

/// Options of meander().
struct MeanderParams {
    /// [0, 2] strength of meandering; 0: only rounds corners and lattice steps, within half a cell; nodes stay
    double gain = 1.0;
    double gap_cells = 3.0; ///< [0.5, 4] rivers farther apart than this stay so
    std::uint64_t seed = 7;
};

/// What meander() returns.
struct MeanderedNetwork {
    StreamNetwork network;
    std::int64_t rounds = 0;   ///< of reducing bends where rivers came too close
    std::int64_t eased = 0;    ///< vertices with reduced shift
    std::int64_t vertices = 0; ///< of the network
    double max_shift_m = 0.0;  ///< at most so far
};

/// Makes rivers meander: rounds corners and lattice steps, bends the plain by long waves and each river by noise along
/// it, whose wavelength and amplitude grow with drainage area. Wavelength: 12 valley-floor widths, 0.08 * area [cells]
/// ^ 0.4, at least 10 cells. Tributaries that would meet at a wide angle turn to come down beside the larger river.
/// \param network a forest inside the grid; arcs meet only at nodes
/// \param grid keeps the rivers inside
/// \param area_m2 [m2] by arc: drainage area at its lower end
/// \return the same arcs between the same nodes, one vertex per cell; nodes move with the larger river, outlets on the
/// grid's edge stay. Arcs meet only at nodes (exact). On the bent plain, what is gap_cells or more from a segment (on
/// the same river: and eight cells along it) stays so, what is closer keeps a third of its distance: shifts are halved
/// until it does. Coordinates are rounded to 1e-6 m. Random numbers are a hash of (seed, node).
/// \throws BadParameter when a parameter is outside its range
/// \throws BadInput when there is not one area per arc, a vertex is outside the grid, arcs meet away from nodes, or the
/// network is not a forest
///
/// Source: wavelengths of 10 to 14 widths, \cite leopold1960.
MeanderedNetwork meander(StreamNetwork const& network, Grid const& grid, std::vector<double> const& area_m2,
                         MeanderParams const& params = {}, Run const& run = {});

/// Makes rivers meander on land: they stay there, and move less the nearer the sea is.
/// \param network a forest inside the mask's grid; arcs meet only at nodes
/// \param land 0: sea
/// \param area_m2 [m2] by arc: drainage area at its lower end
/// \return as meander on a grid
MeanderedNetwork meander(StreamNetwork const& network, Mask const& land, std::vector<double> const& area_m2,
                         MeanderParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
