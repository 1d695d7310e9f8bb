// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments.hpp>

namespace thalweg::pipeline {

// The rivers' claims on the DEM around them, common to make and check.

/// Cells in which rivers stand: under level parts of arcs. Without cells: none.
Mask still_cells(NetworkFile const& network, Grid const& grid);

/// The cells of lakes in channels, and of their outlets. Without cells: none.
Mask lake_cells(Channels const& channels);

/// 1 where either mask is 1; either may be without cells.
Mask either(Mask one, Mask const& other);

/// Cells in which rivers end inland: of nodes of the kind "sink", where the DEM has heights.
std::vector<std::int64_t> sinks_of(NetworkFile const& network, Raster<float> const& dem);

/// The nodes of a network at the positions of a file's nodes of the kind "sink", ascending.
std::vector<NodeId> sinks_in(StreamNetwork const& network, NetworkFile const& file);

/// Nodes at which rivers end although the terrain continues: outlets in cells surrounded by heights, ascending.
std::vector<NodeId> inland_ends(StreamNetwork const& network, Raster<float> const& dem);

/// The cells of nodes.
std::vector<std::int64_t> cells_of(std::vector<NodeId> const& nodes, StreamNetwork const& network, Grid const& grid);

/// 1 in the cells of a valley.
Mask river_mask(Valley const& valley);

/// Removes from a valley the cells in which the DEM has other heights, and everything upstream of them.
Valley honoured_valley(Valley valley, StreamNetwork const& network, Raster<float> const& dem);

/// The arcs of a network file on a DEM's grid.
struct FileReaches {
    flow::Reaches reaches;            ///< the arcs' parts in the grid
    std::vector<std::int64_t> basins; ///< by reach: from the file, else 1, 2, ... by outlet
    std::int64_t cut = 0;             ///< reaches that leave the grid
    std::int64_t outside = 0;         ///< reaches completely outside it
    std::int64_t nowhere = 0;         ///< lines with a vertex that is not a number, counted as outside
};

/// Makes reaches of any network. It need not be a forest: only ids and arcs downstream are used. An arc whose receiver
/// is not in the file is an outlet; arcs with one id and one receiver are parts of one reach.
/// \throws BadInput when arcs with one id have several receivers, rivers form a cycle, or no arc is in the grid
FileReaches reaches_of_file(NetworkFile const& file, Grid const& grid);

} // namespace thalweg::pipeline
