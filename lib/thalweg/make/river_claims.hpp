// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \internal For the modules above this one.

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/make/valley_cells.hpp>

namespace thalweg::make {

// What rivers say of the DEM around them, alike in make and check.

/// Cells in which rivers stand: those under parts of arcs that are drawn level. Without cells where there are none.
Mask still_cells(NetworkFile const& network, Grid const& grid);

/// The cells of lakes that lie in channels, and of their outlets. Without cells where there are none.
Mask lake_cells(Channels const& channels);

/// 1 where either mask has 1, of which any may be without cells.
Mask either(Mask one, Mask const& other);

/// Cells in which rivers end inland: those of nodes of the kind "sink", where the DEM has heights.
std::vector<std::int64_t> sinks_of(NetworkFile const& network, Raster<float> const& dem);

/// The nodes of a network at the places of a file's nodes of the kind "sink", ascending.
std::vector<NodeId> sinks_in(StreamNetwork const& network, NetworkFile const& file);

/// Nodes at which rivers end although land goes on: outlets in cells with heights all around, ascending.
std::vector<NodeId> inland_ends(StreamNetwork const& network, Raster<float> const& dem);

/// The cells of nodes.
std::vector<std::int64_t> cells_of(std::vector<NodeId> const& nodes, StreamNetwork const& network, Grid const& grid);

/// 1 in the cells of a valley.
Mask river_mask(ValleyCells const& valley);

/// A valley without the cells in which the DEM has other heights, and without what lies upstream of these.
ValleyCells honoured_valley(ValleyCells const& valley, StreamNetwork const& network, Raster<float> const& dem);

/// What the arcs of a network file are to the land of a DEM.
struct FileReaches {
    flow::Reaches reaches;            ///< an arc's parts in the grid
    std::vector<std::int64_t> basins; ///< by reach: that of the file, else 1, 2, ... by outlet
    std::int64_t cut = 0;             ///< reaches that leave the grid
    std::int64_t outside = 0;         ///< reaches that have no part in it
    std::int64_t nowhere = 0;         ///< lines with a vertex that is no number, which count as outside
};

/// The reaches of anyone's network. It need not be a set of trees: only ids and arcs downstream are asked for. One
/// downstream that the file does not hold makes an outlet; arcs of one id with the same one are parts of one reach.
/// \throws BadInput: arcs of one id with several downstream, rivers that run in a circle, no arc in the grid
FileReaches reaches_of_file(NetworkFile const& file, Grid const& grid);

} // namespace thalweg::make
