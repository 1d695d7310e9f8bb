// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

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

} // namespace thalweg::network
