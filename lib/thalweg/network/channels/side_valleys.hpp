// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/flow_field.hpp>

namespace thalweg::network {

/// Options of side_valleys().
struct SideValleysParams {
    std::int64_t support_cells = 200; ///< [1, ...] cells that must drain through a cell for a valley to run there
};

/// What side_valleys() returns.
struct SideValleys {
    ElevatedNetwork network;
    std::int64_t grown = 0;    ///< arcs that the land has grown
    std::int64_t cut = 0;      ///< of these, that end where a drawn line runs beside the cells its water takes
    std::int64_t left_out = 0; ///< that would have met a line elsewhere than in a node, with what flows into them
};

/// Adds to given rivers the valleys that the land around them has grown.
/// \pre given rivers with heights, their channels, and the water of a land that honours these.
/// \param given the rivers of the input, with heights
/// \param channels the channels
/// \param dem [m] heights by cell; NaN: no data
/// \param flow its flow field
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return given arcs first, cut where valleys join them, their vertices kept bit for bit; then the grown ones
/// (Arc::given is false), from cell centre to cell centre along the steepest descent through every cell outside the
/// channels with the support, to the nearest point of a given line beside the channel its water enters, or to the first
/// cell of the border. Heights are those of the cells, not below what lies downstream. No two arcs meet but in nodes.
/// \throws BadParameter when the support is below 1
/// \throws BadInput for rasters on another grid
/// \throws Cancelled
///
/// Source: \cite ocallaghan1984.
SideValleys side_valleys(ElevatedNetwork const& given, Channels const& channels, Raster<float> const& dem,
                         flow::FlowField const& flow, SideValleysParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
