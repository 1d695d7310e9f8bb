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
#include <thalweg/network/order/order.hpp>

namespace thalweg::make {

/// The laws of the rivers extracted from a DEM.
struct DemLaws {
    measure::NetworkLaws laws;
    std::int64_t support_cells = 0; ///< cells that drain through the first cell of a river
    double support_m2 = 0.0;        ///< [m2] the same as an area
    bool as_dense = false;          ///< the support was chosen to match the drainage density of a network
    /// Of the rivers whose area lies whole inside the data (flow::cut_by_edge), in the trees that they form; nothing
    /// where there are none.
    std::optional<measure::NetworkLaws> inside = {};
    std::int64_t arcs = 0;
    std::int64_t arcs_inside = 0;
};

/// A network with heights and areas, as far as they are known.
struct MeasuredRivers {
    ElevatedNetwork const& network;
    NetworkOrders const& orders;
    flow::ContributingAreas const& areas; ///< below 0: unknown
    bool heights = true;                  ///< else those of the network mean nothing
};

/// The laws of the river lines of a file.
struct LineLaws {
    measure::NetworkLaws laws;
    network::StreamCounts streams;
    std::int64_t arcs = 0;
    std::int64_t outlets = 0;
    double length_m = 0.0;
    std::int64_t left_out = 0; ///< lines that are not in the tree: minor branches, canals, coasts
    double left_out_m = 0.0;
};

/// Computes the laws of a network. Hack's lengths begin at sources; angles at junctions are over half of the median
/// link. What needs areas or heights that are unknown is not computed; the drainage density needs those of all outlets.
/// \param rivers a network
/// \return laws and counts; nothing is left out
/// \throws BadInput when the values do not belong to the network, or it has no arcs
LineLaws laws_of_lines(MeasuredRivers const& rivers);

/// The laws of a terrain: of its rivers as drawn, if any, and of those extracted from its surface.
struct RiverLaws {
    std::optional<measure::NetworkLaws> network;
    std::optional<DemLaws> dem;
};

/// Options of laws_of_dem().
struct DemLawsParams {
    std::int64_t support_cells = flow::ExtractStreamsParams{}.support_cells; ///< as extract_streams
    /// [m] length of a network for comparison: the support is then the largest at which the extracted rivers are as
    /// long, so that both have the same drainage density; 0: none
    double network_m = 0.0;
};

/// Computes the laws of the network extracted from a DEM by D8. Hack's lengths begin at the divide; angles at junctions
/// are over ten cells.
/// \param dem [m] by cell; NaN: no data
/// \param drainage flow field of the DEM
/// \return laws and support
/// \throws BadInput when the DEM has no data; as extract_streams
DemLaws laws_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, DemLawsParams const& params = {},
                    Run const& run = {});

/// Routes flow over a DEM and computes its laws; cells have their size on the ground (io::ground_cell), so that
/// geographic DEMs are accepted.
/// \param dem [m] by cell; NaN: no data
/// \return as for a routed DEM
/// \throws Error as for a routed DEM, and as ground_cell
DemLaws laws_of_dem(Raster<float> const& dem, DemLawsParams const& params = {}, Run const& run = {});

struct Terrain;

/// Both laws of land and rivers.
/// \param terrain land and rivers; where it has no drainage, Hack's lengths are from the sources
/// \param land_cells that have heights, or the grid's
/// \return the DEM's rivers as long together as those drawn, where there are any.
/// \throws Error as laws_of_dem
RiverLaws laws_of_terrain(Terrain const& terrain, std::int64_t land_cells, Run const& run = {});

/// One metric of the laws, for report.json and the page.
struct LawRow {
    std::string_view key;
    std::string_view name;
    std::string_view unit;
    std::optional<double> value;                              ///< [unit] nothing: the network is too small
    std::vector<std::pair<std::string_view, double>> details; ///< of the fit: r2, error, counts; NaN: unknown
    measure::NaturalRange const* nature = nullptr;            ///< null: no range is published
};

/// Lists the metrics of the laws.
/// \return always the same rows in the same order
std::vector<LawRow> law_rows(measure::NetworkLaws const& laws);

} // namespace thalweg::make
