// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/catchments/areas.hpp>

namespace thalweg::flow {

/// The rivers of a DEM, and what they drain.
struct ExtractedStreams {
    RaisedNetwork network; ///< from cell centre to cell centre, at the DEM's heights: they may rise through a pit
    ContributingAreas areas;
};

struct ExtractStreamsParams {
    std::int64_t support_cells = 200; ///< [1, ...] cells that must drain through a cell for a river to run there
};

/// The network of all cells through which at least so many cells drain by D8.
/// Takes: a DEM and its drainage. Gives: nodes at the cells where a river begins, rivers meet or leave the DEM,
/// numbered by cell; arcs numbered by the node they leave. A river of one cell is none. Areas are those that areas_d8
/// gives. Arcs meet only in nodes where the steepest descent leads; across flats two may cross at a corner of cells.
/// Throws: BadParameter when the support is below 1; BadInput when DEM and drainage have not one grid; Cancelled.
/// Source: O'Callaghan and Mark 1984.
ExtractedStreams extract_streams(FlowField const& drainage, Raster<float> const& dem,
                                 ExtractStreamsParams const& params = {}, Run const& run = {});

/// The greatest support at which the extracted streams are together at least so long; 1 where they never are.
/// Throws: BadParameter when the length is not a number above 0; Cancelled.
std::int64_t support_for_length(FlowField const& drainage, double length_m, Run const& run = {});

} // namespace thalweg::flow
