// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/route.hpp>

// Idea: Terrain around given rivers has valleys of its own. Cells outside the channels through
// which enough water flows are traced down their receivers, as streams of any DEM, but they end
// where a given line is near: there the nearest point of the line becomes a confluence, and the
// given arc is split without moving a vertex. A valley that would meet another line elsewhere is
// found by exact predicates and left out with all above it, until none does.
// Source: O'Callaghan and Mark 1984 (streams by contributing area); joining them to lines is ours.
// Cost: O(cells) for the mask and O(n log n) for n segments a pass; passes repeat while valleys are
// left out. One thread.
// Not for: DEMs without given rivers (flow/extract_streams.hpp). A low support fills hillsides with
// rills that are no streams.
// Example:
//     SideValleys const all = side_valleys(elevated, channels_of_rivers, dem, flow_field,
//                                          {.support_cells = 400});
//     StreamNetwork const& rivers = all.network.planform; // Arc::is_input is false for valleys
// More: docs/equilibrium.md, "Valleys of the terrain as arcs".

namespace thalweg::network {

/// Options of side_valleys().
struct SideValleysParams {
    std::int64_t support_cells = 200; ///< [1, ...] contributing area at which side valleys begin
};

/// What side_valleys() returns.
struct SideValleys {
    ElevatedNetwork network;
    std::int64_t grown = 0; ///< number of side valley arcs
    std::int64_t cut = 0;   ///< of these: end where an input line runs beside their flow path
    /// arcs left out with their tributaries, because they would meet a line away from a node
    std::int64_t left_out = 0;
};

/// Extracts the side valleys of terrain grown around input rivers, and joins them to those rivers.
/// \pre The flow field follows the channels.
/// \param given input rivers with heights
/// \param channels channels of the input rivers
/// \param dem [m] by cell; NaN: no data
/// \param flow flow field of the DEM
/// \return input arcs first, split where valleys join, their vertices kept bit for bit; then side valleys
/// (Arc::is_input is false) along the D8 flow paths of cells outside the channels with the support, to the nearest
/// point of the input line they join, or to the border. Their heights are those of the cells, but not below the next
/// one downstream. Arcs meet only at nodes.
/// \throws BadParameter when support_cells is below 1
/// \throws BadInput for rasters on different grids
///
/// Source: \cite ocallaghan1984.
SideValleys side_valleys(ElevatedNetwork const& given, Channels const& channels, Raster<float> const& dem,
                         flow::FlowField const& flow, SideValleysParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
