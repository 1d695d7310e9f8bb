// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// Gives rivers the heights of the land that was made around them.
/// \pre a network, the channels of it, and the land on their grid.
/// \param network the network
/// \param channels the channels
/// \param land [m] the DEM on the channels' grid
/// \return the network bit for bit, with heights that never rise downstream. The first vertex of a way in each channel
/// cell stands as high as that cell, a source and an outlet as high as the cell they lie in, what lies between linear
/// by length, and so does what would rise. Where the land falls along every channel, each arc falls, but those of a
/// basin within one cell; where it is level, they are.
/// \throws BadInput for a network that is not a forest, a vertex outside the grid, a land on another grid or without a
/// height where a river runs
ElevatedNetwork elevate_from_dem(StreamNetwork const& network, Channels const& channels, Raster<float> const& land);

} // namespace thalweg::network
