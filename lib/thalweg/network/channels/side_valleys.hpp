// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/channels.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/flow/route.hpp>

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
