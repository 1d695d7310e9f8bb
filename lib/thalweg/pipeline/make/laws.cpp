// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/laws.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/network/order/count_streams.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/pipeline/make/terrain.hpp>

#include <algorithm>

namespace thalweg::pipeline {

namespace {

constexpr double cells_of_junction = 10.0;

/// flow_length: of the DEM under the network, or null.
measure::NetworkLaws laws_of(ElevatedNetwork const& network, NetworkOrders const& orders,
                             flow::ContributingAreas const& areas, Grid const& grid, std::int64_t land_cells,
                             Raster<float> const* flow_length) {
    measure::NetworkLawsParams params{.land_m2 = static_cast<double>(land_cells) * grid.cell_m * grid.cell_m,
                                      .junction_reach_m = cells_of_junction * grid.cell_m};
    params.side_branches = network::count_streams(network.plan).side;
    if (flow_length != nullptr) {
        for (NodeId n = 0; n < network.plan.node_count(); ++n) {
            Cell const cell = grid.cell_of(network.plan.node(n).at);
            params.head_m.push_back(grid.contains(cell) ? static_cast<double>((*flow_length)[cell]) : 0.0);
        }
    }
    return measure::network_laws(network, orders, areas, params);
}

} // namespace

DemLaws laws_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, Raster<float> const& flow_length,
                    DemLawsParams const& params, Run const& run) {
    Grid const& grid = dem.grid();
    auto const ways = drainage.direction.values();
    auto const land =
        std::count_if(ways.begin(), ways.end(), [](flow::Direction d) { return d != flow::Direction::no_data; });
    if (land == 0) {
        throw BadInput("pipeline.laws_of_dem: no cell of the DEM has data");
    }
    DemLaws found;
    found.as_dense = params.network_m > 0.0;
    found.support_cells =
        found.as_dense ? flow::support_for_length(drainage, params.network_m, run) : params.support_cells;
    found.support_m2 = static_cast<double>(found.support_cells) * grid.cell_m * grid.cell_m;
    flow::ExtractedStreams const streams =
        flow::extract_streams(drainage, dem, {.support_cells = found.support_cells}, run);
    found.laws =
        laws_of(streams.network, network::order(streams.network.plan), streams.areas, grid, land, &flow_length);
    return found;
}

DemLaws laws_of_dem(Raster<float> const& dem, DemLawsParams const& params, Run const& run) {
    Grid grid = dem.grid();
    grid.cell_m = io::ground_cell(grid).side_m;
    Raster<float> on_ground(grid);
    std::copy(dem.values().begin(), dem.values().end(), on_ground.values().begin());
    flow::FlowField const drainage = flow::route(on_ground, run);
    return laws_of_dem(on_ground, drainage, flow::flow_lengths(drainage, run), params, run);
}

RiverLaws laws_of_terrain(Terrain const& terrain, flow::ContributingAreas const& areas, std::int64_t land_cells,
                          Run const& run) {
    RiverLaws found;
    std::optional<Raster<float>> flow_length;
    if (terrain.drainage) {
        flow_length = flow::flow_lengths(*terrain.drainage, run);
    }
    Grid const& grid = terrain.grid;
    DemLawsParams params;
    if (terrain.network.plan.arc_count() > 0) {
        found.network =
            laws_of(terrain.network, terrain.orders, areas, grid, land_cells, flow_length ? &*flow_length : nullptr);
        params.network_m =
            found.network->drainage_density_m * static_cast<double>(land_cells) * grid.cell_m * grid.cell_m;
    }
    if (terrain.drainage) {
        found.dem = laws_of_dem(terrain.surface->dem, *terrain.drainage, *flow_length, params, run);
    }
    return found;
}

} // namespace thalweg::pipeline
