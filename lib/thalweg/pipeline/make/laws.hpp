// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/extract_streams.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/laws/network_laws.hpp>
#include <thalweg/measure/relief/relief.hpp>

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
/// \return Hack's lengths from the divide; directions at junctions over ten cells.
/// \throws BadInput when the DEM has no data; as extract_streams does
DemLaws laws_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, Raster<float> const& flow_length,
                    DemLawsParams const& params = {}, Run const& run = {});

/// \param dem [m] heights by cell; NaN: no data
/// \return the same of any DEM, drained for it, with the side that its cells have on the ground (io::ground_cell): a
/// geographic one's too.
/// \throws Error also as ground_cell
DemLaws laws_of_dem(Raster<float> const& dem, DemLawsParams const& params = {}, Run const& run = {});

struct Terrain;

/// Both laws of land and rivers.
/// \param terrain land and rivers; where it has no drainage, Hack's lengths are from the sources
/// \param land_cells that have heights, or the grid's
/// \return the DEM's rivers as long together as those drawn, where there are any.
/// \throws Error as laws_of_dem
RiverLaws laws_of_terrain(Terrain const& terrain, std::int64_t land_cells, Run const& run = {});

/// A law's figure as report.json and the page tell it.
struct LawRow {
    std::string_view key;
    std::string_view name;
    std::string_view unit;
    std::optional<double> value;                              ///< none where the network is too small to tell
    std::vector<std::pair<std::string_view, double>> details; ///< how it was found: r2, error, counts; NaN for unknown
    measure::NaturalRange const* nature = nullptr;            ///< null where no range was published
};

/// \return the laws one by one, always the same rows in the same order.
std::vector<LawRow> law_rows(measure::NetworkLaws const& laws);

} // namespace thalweg::pipeline
