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
    ElevatedNetwork network; ///< from cell centre to cell centre, at the DEM's heights: they may rise through a pit
    ContributingAreas areas;
};

/// Options of extract_streams().
struct ExtractStreamsParams {
    std::int64_t support_cells = 200; ///< [1, ...] cells that must drain through a cell for a river to run there
};

/// The network of all cells through which at least `support` cells drain by D8.
/// \pre a DEM and its drainage.
/// \param drainage the flow field of the DEM
/// \param dem [m] heights by cell; NaN: no data
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return nodes at the cells where a river begins, rivers meet or leave the DEM, numbered by cell; arcs numbered by
/// the node they leave. A river of one cell is none. Areas are those that areas_d8 gives. Arcs meet only in nodes where
/// the steepest descent leads; across flats two may cross at a corner of cells.
/// \throws BadParameter when the support is below 1
/// \throws BadInput when DEM and drainage have not one grid
/// \throws Cancelled
///
/// Source: \cite ocallaghan1984.
ExtractedStreams extract_streams(FlowField const& drainage, Raster<float> const& dem,
                                 ExtractStreamsParams const& params = {}, Run const& run = {});

/// \param drainage the flow field of the DEM
/// \param length_m [m] > 0, length of all streams
/// \param run progress, log, stop token and number of threads
/// \return the greatest support at which the extracted streams are together at least so long; 1 where they never are.
/// \throws BadParameter when the length is not a number above 0
/// \throws Cancelled
std::int64_t support_for_length(FlowField const& drainage, double length_m, Run const& run = {});

} // namespace thalweg::flow
