// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/laws.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/pipeline/make/relief.hpp>
#include <thalweg/pipeline/make/terrain.hpp>

namespace thalweg::pipeline {
namespace {

constexpr double cells_of_junction = 10.0;

/// flow_length: of the DEM under the network, or null.
measure::NetworkLaws laws_of(ElevatedNetwork const& network, NetworkOrders const& orders,
                             flow::ContributingAreas const& areas, Grid const& grid, std::int64_t land_cells,
                             Raster<float> const* flow_length) {
    measure::NetworkLawsParams params{.land_m2 = static_cast<double>(land_cells) * grid.cell_m * grid.cell_m,
                                      .junction_reach_m = cells_of_junction * grid.cell_m};
    params.side_branches = network::count_streams(network.planform).side;
    if (flow_length != nullptr) {
        for (NodeId n = 0; n < network.planform.node_count(); ++n) {
            Cell const cell = grid.cell_of(network.planform.node(n).at);
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
    refuse_if<BadInput>(land == 0, "pipeline.laws_of_dem: no cell of the DEM has data");
    DemLaws found;
    found.as_dense = params.network_m > 0.0;
    found.support_cells =
        found.as_dense ? flow::support_for_length(drainage, params.network_m, run) : params.support_cells;
    found.support_m2 = static_cast<double>(found.support_cells) * grid.cell_m * grid.cell_m;
    flow::ExtractedStreams const streams =
        flow::extract_streams(drainage, dem, {.support_cells = found.support_cells}, run);
    found.laws =
        laws_of(streams.network, network::order(streams.network.planform), streams.areas, grid, land, &flow_length);
    return found;
}

DemLaws laws_of_dem(Raster<float> const& dem, DemLawsParams const& params, Run const& run) {
    Raster<float> const ground = on_ground(dem);
    flow::FlowField const drainage = flow::route(ground, run);
    return laws_of_dem(ground, drainage, flow::flow_lengths(drainage, run), params, run);
}

RiverLaws laws_of_terrain(Terrain const& terrain, std::int64_t land_cells, Run const& run) {
    RiverLaws found;
    std::optional<Raster<float>> flow_length;
    if (terrain.drainage) {
        flow_length = flow::flow_lengths(*terrain.drainage, run);
    }
    Grid const& grid = terrain.grid;
    DemLawsParams params;
    if (terrain.rivers.network.planform.arc_count() > 0) {
        found.network = laws_of(terrain.rivers.network, terrain.rivers.orders, terrain.areas, grid, land_cells,
                                flow_length ? &*flow_length : nullptr);
        params.network_m =
            found.network->drainage_density_m * static_cast<double>(land_cells) * grid.cell_m * grid.cell_m;
    }
    if (terrain.drainage) {
        found.dem = laws_of_dem(terrain.surface->dem, *terrain.drainage, *flow_length, params, run);
    }
    return found;
}

namespace {

using Details = std::vector<std::pair<std::string_view, double>>;

LawRow row(std::string_view key, std::string_view name, std::string_view unit, std::optional<double> value,
           Details details) {
    if (value && !std::isfinite(*value)) {
        value.reset();
    }
    return {key, name, unit, value, std::move(details), measure::natural_range(key)};
}

LawRow horton_row(std::string_view key, std::string_view name, std::optional<measure::HortonRatio> const& law) {
    return row(key, name, "", law ? std::optional(law->ratio) : std::nullopt,
               law ? Details{{"r2", law->r2}, {"orders", static_cast<double>(law->orders)}} : Details{});
}

LawRow power_row(std::string_view key, std::string_view name, std::optional<measure::PowerLaw> const& law,
                 double sign) {
    return row(key, name, "", law ? std::optional(sign * law->exponent) : std::nullopt,
               law ? Details{{"r2", law->r2},
                             {"error", law->exponent_error},
                             {"bins", static_cast<double>(law->bins.size())},
                             {"arcs", static_cast<double>(law->places)},
                             {"left_out", static_cast<double>(law->left_out)},
                             {"coefficient", law->coefficient}}
                   : Details{});
}

LawRow length_row(std::string_view key, std::string_view name, measure::LengthSpread const& spread) {
    return row(key, name, "m", spread.mean_m,
               {{"links", static_cast<double>(spread.links)}, {"median_m", spread.median_m}, {"cv", spread.cv}});
}

} // namespace

std::vector<LawRow> law_rows(measure::NetworkLaws const& laws) {
    auto const& tokunaga = laws.tokunaga;
    Details const terms =
        tokunaga ? Details{{"r2", tokunaga->r2}, {"terms", static_cast<double>(tokunaga->terms)}} : Details{};
    measure::JunctionAngles const& angles = laws.junctions;
    return {
        horton_row("bifurcation", "bifurcation ratio R_B", laws.horton.bifurcation),
        horton_row("length", "length ratio R_L", laws.horton.length),
        horton_row("area", "area ratio R_A", laws.horton.area),
        row("tokunaga_a", "Tokunaga’s a", "", tokunaga ? std::optional(tokunaga->a) : std::nullopt, terms),
        row("tokunaga_c", "Tokunaga’s c", "", tokunaga ? std::optional(tokunaga->c) : std::nullopt, terms),
        power_row("hack", "Hack’s exponent h", laws.hack, 1.0),
        power_row("concavity", "concavity θ", laws.concavity, -1.0),
        row("drainage_density", "drainage density", "km/km²", laws.drainage_density_m * 1000.0, {}),
        row("junction_angle", "junction angle, mean", "°", angles.mean_deg,
            {{"std_deg", angles.std_deg},
             {"junctions", static_cast<double>(angles.junctions)},
             {"left_out", static_cast<double>(angles.left_out)},
             {"reach_m", angles.reach_m}}),
        length_row("exterior_link", "exterior links, mean length", laws.links.exterior),
        length_row("interior_link", "interior links, mean length", laws.links.interior),
        row("link_ratio", "exterior over interior links", "", laws.links.ratio, {}),
    };
}

} // namespace thalweg::pipeline
