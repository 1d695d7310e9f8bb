// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/laws.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/paths.hpp>
#include <thalweg/make/relief.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/network/order/order.hpp>

namespace thalweg::make {
namespace {

constexpr double cells_of_junction = 10.0;

/// Whether the cell of an arc next to its end has an area that the edge cuts; the end itself may lie at the edge.
bool is_cut(Arc const& arc, Mask const& cut) {
    Grid const& grid = cut.grid();
    Cell const end = grid.cell_of(arc.line.back());
    Cell const before = grid.cell_of(arc.line[arc.line.size() - 2]);
    auto const towards = [](std::int64_t from, std::int64_t to) { return to > from ? 1 : to < from ? -1 : 0; };
    Cell const next{end.col + towards(end.col, before.col), end.row + towards(end.row, before.row)};
    return cut[next] != 0;
}

/// The streams whose areas lie inside the data: with an arc all those upstream of it.
flow::ExtractedStreams inside_of(flow::ExtractedStreams const& streams, Mask const& cut) {
    StreamNetwork const& plan = streams.network.planform;
    NetworkDraft kept;
    flow::ExtractedStreams inside;
    std::vector<NodeId> number(plan.node_count(), plan.node_count()); // of a node in the kept network
    auto const node = [&](NodeId n) {
        if (number[n] == plan.node_count()) {
            number[n] = kept.nodes.size();
            kept.add_node(plan.node(n).at);
            inside.network.node_z.push_back(streams.network.node_z[n]);
            inside.areas.node_m2.push_back(streams.areas.node_m2[n]);
        }
        return number[n];
    };
    for (ArcId a = 0; a < plan.arc_count(); ++a) {
        if (!is_cut(plan.arc(a), cut)) {
            NodeId const from = node(plan.from(a));
            kept.add_arc(from, node(plan.to(a)), plan.arc(a));
            inside.network.arc_z.push_back(streams.network.arc_z[a]);
            inside.areas.us_area_m2.push_back(streams.areas.us_area_m2[a]);
            inside.areas.ds_area_m2.push_back(streams.areas.ds_area_m2[a]);
        }
    }
    inside.areas.source = streams.areas.source;
    inside.network.planform = std::move(kept);
    return inside;
}

/// [m2] What the rivers of a network drain; NaN: the area of an outlet is unknown.
double area_of_outlets(StreamNetwork const& plan, flow::ContributingAreas const& areas) {
    double sum_m2 = 0.0;
    for (NodeId const outlet : plan.outlets()) {
        for (ArcId const a : plan.in(outlet)) {
            sum_m2 += areas.ds_area_m2[a] > 0.0 ? areas.ds_area_m2[a] : std::numeric_limits<double>::quiet_NaN();
        }
    }
    return sum_m2;
}

/// [m] By node: the longest path from a divide to a source; 0 for the others and off the grid.
std::vector<double> heads_m(StreamNetwork const& plan, flow::FlowField const& drainage, Run const& run) {
    std::vector<NodeId> sources;
    std::vector<std::int64_t> cells;
    for (NodeId n = 0; n < plan.node_count(); ++n) {
        Cell const cell = drainage.grid().cell_of(plan.node(n).at);
        if (plan.in(n).empty() && drainage.grid().contains(cell)) {
            sources.push_back(n);
            cells.push_back(drainage.grid().index(cell));
        }
    }
    std::vector<float> const lengths = flow::flow_lengths_to(cells, drainage, run);
    std::vector<double> found(plan.node_count());
    for (std::size_t i = 0; i < sources.size(); ++i) {
        found[sources[i]] = static_cast<double>(lengths[i]);
    }
    return found;
}

/// head_m: as in measure::NetworkLawsParams.
measure::NetworkLaws laws_of(ElevatedNetwork const& network, NetworkOrders const& orders,
                             flow::ContributingAreas const& areas, Grid const& grid, std::int64_t land_cells,
                             std::vector<double> head_m) {
    measure::NetworkLawsParams params{.land_m2 = static_cast<double>(land_cells) * grid.cell_m * grid.cell_m,
                                      .junction_reach_m = cells_of_junction * grid.cell_m,
                                      .head_m = std::move(head_m)};
    params.side_branches = network::count_streams(network.planform).side;
    return measure::network_laws(network, orders, areas, params);
}

/// [m] A chord that most links are long enough for.
double chord_of(measure::LinkLengths const& links) {
    double const shorter = std::fmin(links.exterior.median_m, links.interior.median_m); // NaN: there are none
    return 0.5 * shorter;
}

using Details = std::vector<std::pair<std::string_view, double>>;

LawRow row(std::string_view key, std::string_view name, std::string_view unit, std::optional<double> value,
           Details details) {
    if (value && !std::isfinite(*value)) {
        value.reset();
    }
    return {key, name, unit, value, std::move(details), measure::natural_range(key)};
}

LawRow horton_row(std::string_view key, std::string_view name, std::optional<measure::HortonRatio> const& law,
                  double streams) {
    return row(key, name, "", law ? std::optional(law->ratio) : std::nullopt,
               law ? Details{{"r2", law->r2}, {"orders", static_cast<double>(law->orders)}, {"streams", streams}}
                   : Details{});
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

DemLaws laws_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, DemLawsParams const& params,
                    Run const& run) {
    Grid const& grid = dem.grid();
    auto const ways = drainage.direction.values();
    auto const land =
        std::count_if(ways.begin(), ways.end(), [](flow::Direction d) { return d != flow::Direction::no_data; });
    refuse_if<BadInput>(land == 0, "make.laws_of_dem", "no cell of the DEM has data");
    DemLaws found;
    found.as_dense = params.network_m > 0.0;
    found.support_cells =
        found.as_dense ? flow::support_for_length(drainage, params.network_m, run) : params.support_cells;
    found.support_m2 = static_cast<double>(found.support_cells) * grid.cell_m * grid.cell_m;
    flow::ExtractedStreams const streams =
        flow::extract_streams(drainage, dem, {.support_cells = found.support_cells}, run);
    found.laws = laws_of(streams.network, network::order(streams.network.planform), streams.areas, grid, land,
                         heads_m(streams.network.planform, drainage, run));
    flow::ExtractedStreams const inside = inside_of(streams, flow::cut_by_edge(drainage));
    StreamNetwork const& plan = inside.network.planform;
    found.arcs = static_cast<std::int64_t>(streams.network.planform.arc_count());
    found.arcs_inside = static_cast<std::int64_t>(plan.arc_count());
    if (found.arcs_inside > 0) {
        found.inside = laws_of(inside.network, network::order(plan), inside.areas, grid,
                               std::llround(area_of_outlets(plan, inside.areas) / (grid.cell_m * grid.cell_m)),
                               heads_m(plan, drainage, run));
    }
    return found;
}

DemLaws laws_of_dem(Raster<float> const& dem, DemLawsParams const& params, Run const& run) {
    Raster<float> const ground = on_ground(dem);
    return laws_of_dem(ground, flow::route(ground, run), params, run);
}

RiverLaws laws_of_terrain(Terrain const& terrain, std::int64_t land_cells, Run const& run) {
    RiverLaws found;
    Grid const& grid = terrain.grid;
    DemLawsParams params;
    StreamNetwork const& plan = terrain.rivers.network.planform;
    if (plan.arc_count() > 0) {
        found.network =
            laws_of(terrain.rivers.network, terrain.rivers.orders, terrain.water.areas, grid, land_cells,
                    terrain.has_surface() ? heads_m(plan, terrain.water.drainage, run) : std::vector<double>{});
        params.network_m =
            found.network->drainage_density_m * static_cast<double>(land_cells) * grid.cell_m * grid.cell_m;
    }
    if (terrain.has_surface()) {
        found.dem = laws_of_dem(terrain.ground.dem, terrain.water.drainage, params, run);
    }
    return found;
}

LineLaws laws_of_lines(MeasuredRivers const& rivers) {
    StreamNetwork const& plan = rivers.network.planform;
    refuse_if<BadInput>(plan.arc_count() == 0, "make.laws_of_lines", "the network has no arcs");
    LineLaws found;
    found.streams = network::count_streams(plan);
    found.arcs = static_cast<std::int64_t>(plan.arc_count());
    found.outlets = static_cast<std::int64_t>(plan.outlets().size());
    double const land_m2 = area_of_outlets(plan, rivers.areas);
    bool const knows_land = land_m2 > 0.0;
    measure::NetworkLawsParams params{.land_m2 = knows_land ? land_m2 : 1.0,
                                      .junction_reach_m = chord_of(measure::link_lengths(plan))};
    params.side_branches = found.streams.side;
    found.laws = measure::network_laws(rivers.network, rivers.orders, rivers.areas, params);
    found.length_m = found.laws.drainage_density_m * double{params.land_m2};
    if (!knows_land) {
        found.laws.drainage_density_m = std::numeric_limits<double>::quiet_NaN();
    }
    if (!rivers.heights) {
        found.laws.concavity.reset();
    }
    return found;
}

std::vector<LawRow> law_rows(measure::NetworkLaws const& laws) {
    auto const& tokunaga = laws.tokunaga;
    Details const terms =
        tokunaga ? Details{{"r2", tokunaga->r2}, {"terms", static_cast<double>(tokunaga->terms)}} : Details{};
    measure::JunctionAngles const& angles = laws.junctions;
    double streams = 0.0;
    for (measure::StreamOrder const& order : laws.horton.orders) {
        streams += static_cast<double>(order.streams);
    }
    return {
        horton_row("bifurcation", "bifurcation ratio R_B", laws.horton.bifurcation, streams),
        horton_row("length", "length ratio R_L", laws.horton.length, streams),
        horton_row("area", "area ratio R_A", laws.horton.area, streams),
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

} // namespace thalweg::make
