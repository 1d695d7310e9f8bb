// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/extract_streams.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/laws/network_laws.hpp>

namespace thalweg::pipeline {

/// The laws of the rivers that a DEM draws by itself.
struct DemLaws {
    measure::NetworkLaws laws;
    std::int64_t support_cells = 0; ///< cells that drain through the first cell of a river
    double support_m2 = 0.0;        ///< [m2] the same
    bool as_dense = false;          ///< the support was chosen for the drainage density of a network beside it
};

/// The laws of a terrain: of its rivers as drawn, where there are any, and of those its surface draws by itself.
struct RiverLaws {
    std::optional<measure::NetworkLaws> network;
    std::optional<DemLaws> dem;
};

/// Options of laws_of_dem().
struct DemLawsParams {
    std::int64_t support_cells = flow::ExtractStreamsParams{}.support_cells; ///< as extract_streams
    double network_m = 0.0; ///< [m] length of a network beside the DEM: the support is then the greatest at which its
                            ///< rivers are as long, so that both have one drainage density; 0 for none
};

/// Laws of the network that a DEM's water draws by D8, from the cells through which enough of it drains.
/// \pre a DEM with its drainage and flow lengths.
/// \param dem [m] heights by cell; NaN: no data
/// \param drainage the flow field of the DEM
/// \param flow_length [m] by cell, longest flow path down to it
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return Hack's lengths from the divide; directions at junctions over ten cells.
/// \throws BadInput when the DEM has no data; as extract_streams does
/// \throws Cancelled
DemLaws laws_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, Raster<float> const& flow_length,
                    DemLawsParams const& params = {}, Run const& run = {});

/// \param dem [m] heights by cell; NaN: no data
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the same of any DEM, drained for it, with the side that its cells have on the ground (io::ground_cell): a
/// geographic one's too.
/// \throws Error also as ground_cell
DemLaws laws_of_dem(Raster<float> const& dem, DemLawsParams const& params = {}, Run const& run = {});

struct Terrain;

/// Both laws of land and rivers.
/// \param terrain land and rivers; where it has no drainage, Hack's lengths are from the sources
/// \param areas of the rivers
/// \param land_cells that have heights, or the grid's
/// \param run progress, log, stop token and number of threads
/// \return the DEM's rivers as long together as those drawn, where there are any.
/// \throws Error as laws_of_dem
RiverLaws laws_of_terrain(Terrain const& terrain, flow::ContributingAreas const& areas, std::int64_t land_cells,
                          Run const& run = {});

} // namespace thalweg::pipeline
