// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

// Idea: Heights of DEMs and files are noisy, and a river must not rise downstream. The running
// minimum from the sources down (lower_rises, drape) gives the highest profile that nowhere exceeds
// what was given: it cuts through dams and bridges, and never fills. elevate_from_dem reads the DEM
// that was built around the rivers, where a line passes cells of its bank: only cells of its
// channel count, and vertices between are interpolated. keep_heights goes on beyond known heights
// with the river's own slope of the last kilometre.
// Source: ours (docs/equilibrium.md, "Heights of rivers").
// Cost: O(vertices), one walk or two. One thread.
// Not for: pits from noise in a DEM that shall keep its level: a running minimum is biased low by
// the depth of the noise. Where rises exceed noise_of_heights, the river is probably drawn uphill.
// Example:
//     Lowered const lowered = lower_rises(network, arc_z);
//     double const worst_m = *std::max_element(lowered.by_m.begin(), lowered.by_m.end());
//     ElevatedNetwork const on_dem = drape(network, dem);

namespace thalweg::network {

/// Takes a network's heights from a DEM.
/// \param network a forest, in the DEM's coordinates
/// \param dem [m] by cell; NaN: no data
/// \return at each vertex the height of its cell or the minimum upstream, if lower: heights do not rise downstream
/// \throws BadInput naming the position of a vertex without data; for a network that is not a forest
ElevatedNetwork drape(StreamNetwork const& network, Raster<float> const& dem);

/// Takes a network's heights from the terrain built around its channels. A line's first vertex in each channel cell,
/// sources and outlets take the height of their cell; vertices between, and those that would rise, are interpolated by
/// length.
/// \param network a forest inside the grid
/// \param channels channels of this network
/// \param land [m] the DEM on the channels' grid
/// \return the plan bit for bit; heights do not rise downstream, and where the terrain falls along every channel each
/// arc falls, except in basins within one cell
/// \throws BadInput for a network that is not a forest, a vertex outside the grid, a DEM on another grid or without a
/// height at a river
ElevatedNetwork elevate_from_dem(StreamNetwork const& network, Channels const& channels, Raster<float> const& land);

/// Copies heights between networks with the same vertices; new vertices, downstream of the known ones, go on with the
/// slope of their river's last kilometre, or less where it is shorter.
/// \param network has every vertex of `known`, and may continue downstream (carry_outlets)
/// \param known a network with heights
/// \return `network` with heights
/// \throws BadInput when a vertex without a height has none upstream either
ElevatedNetwork keep_heights(StreamNetwork const& network, ElevatedNetwork const& known);

/// [m] By how much heights between two limits may rise downstream by noise: 20 m, or 5 % of their range where that is
/// more. A river that is drawn uphill rises by more.
double noise_of_heights(double low_m, double high_m);

/// What lower_rises() returns.
struct LoweredNetwork {
    ElevatedNetwork network;
    std::vector<double> by_m; ///< [m] by arc: the largest lowering of its vertices; 0: none
};

/// Removes rises downstream by lowering the vertices below.
/// \param network a forest
/// \param arc_z [m] by arc, by vertex; arcs may differ at a node
/// \return Law: the highest heights that nowhere exceed the input, do not rise downstream and agree at nodes
/// \throws BadInput when there is not one height per vertex, or the network is not a forest
LoweredNetwork lower_rises(StreamNetwork const& network, std::vector<std::vector<double>> const& arc_z);

} // namespace thalweg::network
