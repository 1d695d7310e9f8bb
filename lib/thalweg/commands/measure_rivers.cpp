// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/internal/measure_rivers.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

#include <thalweg/commands/internal/repair_network.hpp>
#include <thalweg/core/append.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/flow/extract_streams.hpp>
#include <thalweg/flow/paths.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/tables/table.hpp>
#include <thalweg/make/file_values.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/measure/relief/zones.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/network/order/pfafstetter.hpp>

namespace thalweg::commands {
namespace {

using io::Column;

std::vector<std::int64_t> down_of(flow::Reaches const& reaches) {
    std::vector<std::int64_t> down;
    for (flow::Reach const& reach : reaches) {
        down.push_back(reach.ds);
    }
    return down;
}

/// Pfafstetter codes of links. Rivers that end at one point form one basin.
std::vector<std::string> codes_of(flow::Reaches const& reaches, std::vector<double> area) {
    std::vector<std::int64_t> down = down_of(reaches);
    std::map<std::pair<double, double>, std::vector<std::size_t>> mouths;
    for (std::size_t a = 0; a < reaches.size(); ++a) {
        if (reaches[a].ds < 0 && !reaches[a].lines.empty()) {
            Vec2 const end = reaches[a].lines.back().back();
            mouths[{end.x, end.y}].push_back(a);
        }
    }
    for (auto const& [place, links] : mouths) {
        if (links.size() > 1) { // they flow into a link without length
            double sum = 0.0;
            for (std::size_t const a : links) {
                down[a] = std::ssize(down);
                sum += area[a];
            }
            down.push_back(-1);
            area.push_back(sum);
        }
    }
    std::vector<std::string> codes = network::pfafstetter(down, area);
    codes.resize(reaches.size());
    return codes;
}

/// Numbers of the ends of lines, from 1: the same at the same place.
class Ends {
public:
    std::int64_t number(Vec2 at) {
        return numbers_.try_emplace({at.x, at.y}, static_cast<std::int64_t>(numbers_.size()) + 1).first->second;
    }

private:
    std::map<std::pair<double, double>, std::int64_t> numbers_;
};

/// A column of numbers, NULL where one is not finite.
Column real(char const* name, std::function<double(std::size_t)> value) {
    Column column{name, Column::Kind::real, 0, [value = std::move(value)](std::size_t i) -> Column::Value {
                      double const v = value(i);
                      return std::isfinite(v) ? Column::Value(v) : Column::Value();
                  }};
    column.may_be_null = true;
    return column;
}

Column whole(char const* name, std::function<std::int64_t(std::size_t)> value) {
    return {name, Column::Kind::wide_integer, 0,
            [value = std::move(value)](std::size_t i) -> Column::Value { return value(i); }};
}

Column text(char const* name, std::vector<std::string> const& values) {
    return {name, Column::Kind::text, 0, [&values](std::size_t i) -> Column::Value { return values[i]; }};
}

std::vector<Column> relief_columns(std::vector<measure::ZoneRelief> const& relief) {
    using Relief = measure::ZoneRelief;
    std::vector<Column> columns;
    auto const add = [&](char const* name, double Relief::*member) {
        columns.push_back(real(name, [&relief, member](std::size_t i) { return relief[i].*member; }));
    };
    add("z_min", &Relief::z_min_m);
    add("z_mean", &Relief::z_mean_m);
    add("z_max", &Relief::z_max_m);
    add("hypsometric", &Relief::hypsometric);
    add("melton", &Relief::melton);
    add("slope_deg", &Relief::slope_deg);
    add("flow_length", &Relief::flow_length_m);
    add("form_factor", &Relief::form_factor);
    return columns;
}

/// The line of a reach; a straight line joins parts between which it leaves the grid.
std::vector<Vec2> line_of(flow::Reach const& reach) {
    std::vector<Vec2> line;
    for (std::vector<Vec2> const& part : reach.lines) {
        for (Vec2 const p : part) {
            if (line.empty() || !(line.back() == p)) {
                line.push_back(p);
            }
        }
    }
    return line;
}

/// Length over the distance between the ends; NaN for a closed line.
double sinuosity_of(std::vector<Vec2> const& line) {
    double const chord_m = line.empty() ? 0.0 : distance(line.front(), line.back());
    return chord_m > 0.0 ? length_of(line) / chord_m : std::numeric_limits<double>::quiet_NaN();
}

/// A line with the heights of the cells of its vertices; where these have none, on straight lines between the others.
/// \return nothing where no vertex has a height
std::vector<Vec3> with_heights(std::vector<Vec2> const& line, Raster<double> const& heights) {
    std::vector<double> way{0.0};
    std::vector<std::size_t> known;
    std::vector<Vec3> raised;
    for (std::size_t i = 0; i < line.size(); ++i) {
        way.push_back(way.back() + (i + 1 < line.size() ? distance(line[i], line[i + 1]) : 0.0));
        raised.push_back({line[i].x, line[i].y, heights[heights.grid().cell_of(line[i])]});
        if (!std::isnan(raised[i].z)) {
            known.push_back(i);
        }
    }
    if (known.empty()) {
        return {};
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
        auto const after = std::ranges::lower_bound(known, i);
        if (after != known.end() && *after == i) {
            continue;
        }
        std::size_t const right = after == known.end() ? known.back() : *after;
        std::size_t const left = after == known.begin() ? known.front() : *(after - 1);
        double const share = way[right] > way[left] ? (way[i] - way[left]) / (way[right] - way[left]) : 0.0;
        raised[i].z = raised[left].z + std::clamp(share, 0.0, 1.0) * (raised[right].z - raised[left].z);
    }
    return raised;
}

} // namespace

NetworkFile joined_lines(NetworkFile const& file, Raster<float> const& dem, std::vector<Finding>& findings,
                         Run const& run) {
    refuse_if<BadInput>(file.arcs.empty(), "commands.run_measure", "the network holds no lines");
    RepairedNetwork const mended = repair_network(file, measure::check_topology(file, {}, run), {.dem = &dem}, run);
    refuse_if<BadInput>(!mended.done, "commands.run_measure", "the lines make no tree of rivers: {}",
                        mended.mended.empty() ? std::string("thalweg check tells why") : mended.mended.back().text);
    append(findings, mended.doubts);
    for (Finding const& change : mended.mended) {
        if (change.kind == FindingKind("secondary") || change.kind == FindingKind("left_out")) {
            findings.push_back(change);
        }
    }
    std::unordered_map<std::int64_t, std::string> names;
    for (NetworkFile::FileArc const& arc : file.arcs) {
        names.try_emplace(arc.feature, arc.name);
    }
    StreamNetwork const& plan = mended.network.planform;
    NetworkFile joined;
    joined.crs = file.crs;
    joined.says.basin = false;
    for (ArcId a = 0; a < plan.arc_count(); ++a) {
        ArcId const below = plan.out(plan.to(a));
        NetworkFile::FileArc arc;
        arc.id = static_cast<std::int64_t>(a) + 1;
        arc.from_node = static_cast<std::int64_t>(plan.from(a)) + 1;
        arc.to_node = static_cast<std::int64_t>(plan.to(a)) + 1;
        arc.ds_arc = below == no_arc ? 0 : static_cast<std::int64_t>(below) + 1;
        arc.name = names[plan.arc(a).feature];
        for (Vec2 const p : plan.arc(a).line) {
            arc.line.push_back({p.x, p.y, 0.0});
        }
        joined.arcs.push_back(std::move(arc));
    }
    return joined;
}

MeasuredRiver rivers_of_file(NetworkFile const& file, Grid const& grid) {
    make::FileReaches found = make::reaches_of_file(file, grid);
    std::unordered_map<std::int64_t, std::string> names;
    for (NetworkFile::FileArc const& arc : file.arcs) {
        names.try_emplace(arc.id, arc.name);
    }
    std::int64_t unknown = 0;
    for (NetworkFile::FileArc const& arc : file.arcs) {
        unknown += arc.ds_arc != 0 && !names.contains(arc.ds_arc) ? 1 : 0;
    }
    MeasuredRiver rivers{
        std::move(found.reaches), std::move(found.basins), {}, found.cut, found.outside, found.nowhere, unknown};
    for (flow::Reach const& reach : rivers.reaches) {
        rivers.names.push_back(names[reach.id]);
    }
    return rivers;
}

MeasuredRiver rivers_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, std::int64_t support_cells,
                            Run const& run) {
    flow::ExtractedStreams const streams = flow::extract_streams(drainage, dem, {support_cells}, run);
    StreamNetwork const& plan = streams.network.planform;
    MeasuredRiver rivers{flow::reaches_of(plan), {}, std::vector<std::string>(plan.arc_count())};
    for (ArcId a = 0; a < plan.arc_count(); ++a) {
        rivers.basins.push_back(plan.basin(plan.to(a)));
    }
    return rivers;
}

RiverMeasures measure_rivers(MeasuredRiver const& rivers, Raster<float> const& dem, flow::FlowField const& drainage,
                             MeasureParams const& params, Run const& run) {
    RiverMeasures found;
    found.profiles = measure::river_profiles(rivers.reaches, dem, drainage, run);
    if (params.theta) {
        found.counts.theta = *params.theta;
    } else {
        auto const fitted = measure::fit_theta(found.profiles, run);
        refuse_if<BadInput>(!fitted, "commands.run_measure",
                            "no river falls, so that no concavity index can be fitted; set theta or a smaller support");
        found.counts.theta = fitted->theta;
        found.counts.theta_r2 = fitted->r2;
    }
    found.chi = measure::chi_along(found.profiles, found.counts.theta);
    constexpr double least_cells = 3.0; // so that the next cell is within half of it, also a diagonal one
    measure::SteepnessParams const steepness{std::max(params.steepness.window_m, least_cells * dem.grid().cell_m)};
    found.k_sn = measure::steepness_along(found.profiles, found.chi, steepness, run);
    found.knickpoints = measure::knickpoints(found.profiles, found.chi, params.knickpoint, run);
    found.counts.knickpoints = std::ssize(found.knickpoints);
    found.counts.arcs = std::ranges::count_if(rivers.reaches, [](flow::Reach const& r) { return !r.lines.empty(); });
    found.reaches = measure::reach_profiles(found.profiles, found.chi);
    found.counts.arcs_edge = std::ranges::count_if(found.reaches, &measure::ReachProfile::is_cut);
    return found;
}

Raster<double> raster_of(measure::RiverProfiles const& profiles, std::vector<double> const& values, Grid const& grid) {
    Raster<double> raster(grid, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < profiles.size(); ++i) {
        raster[profiles.cell[i]] = values[i];
    }
    return raster;
}

void write_streams(MeasuredRiver const& rivers, RiverMeasures const& measures, Grid const& grid,
                   std::string const& path, Run const& run) {
    std::vector<measure::ReachProfile> const& reaches = measures.reaches;
    std::vector<double> areas_m2;
    std::vector<std::vector<Vec2>> lines;
    for (std::size_t a = 0; a < reaches.size(); ++a) {
        areas_m2.push_back(reaches[a].area_m2);
        lines.push_back(line_of(rivers.reaches[a]));
    }
    network::LinkOrders const orders = network::order_links(down_of(rivers.reaches));
    std::vector<std::string> const codes = codes_of(rivers.reaches, areas_m2);
    Raster<double> const heights = raster_of(measures.profiles, measures.profiles.z_m, grid);
    std::vector<std::size_t> rows; // reaches
    std::vector<std::vector<Vec3>> shapes;
    Ends ends;
    std::vector<std::int64_t> from(lines.size(), 0); // nodes; 0: left out
    std::vector<std::int64_t> to(lines.size(), 0);
    for (std::size_t a = 0; a < lines.size(); ++a) {
        if (std::vector<Vec3> shape = with_heights(lines[a], heights); !shape.empty()) {
            rows.push_back(a);
            shapes.push_back(std::move(shape));
            from[a] = ends.number(lines[a].front());
            to[a] = ends.number(lines[a].back());
        }
    }
    std::vector<std::int64_t> breaks(reaches.size(), 0);
    for (measure::Knickpoint const& k : measures.knickpoints) {
        ++breaks[measures.profiles.reach[k.place]];
    }
    std::vector<Column> columns = {
        whole("arc_id", [&](std::size_t a) { return rivers.reaches[a].id; }),
        whole("from_node", [&](std::size_t a) { return from[a]; }),
        whole("to_node", [&](std::size_t a) { return to[a]; }),
        whole("ds_arc",
              [&](std::size_t a) {
                  flow::ReachId const ds = rivers.reaches[a].ds;
                  auto const below = static_cast<std::size_t>(ds);
                  return ds < 0 || from[below] != to[a] ? 0 : rivers.reaches[below].id; // it may lie outside the DEM
              }),
        whole("basin_id", [&](std::size_t a) { return rivers.basins[a]; }),
        whole("strahler", [&](std::size_t a) { return orders.strahler[a]; }),
        whole("shreve", [&](std::size_t a) { return orders.shreve[a]; }),
        text("pfafstetter", codes),
        real("ds_area", [&](std::size_t a) { return reaches[a].area_m2 > 0.0 ? reaches[a].area_m2 : std::nan(""); }),
        whole("edge", [&](std::size_t a) { return reaches[a].is_cut ? 1 : 0; }),
        real("length", [&](std::size_t a) { return length_of(lines[a]); }),
        real("sinuosity", [&](std::size_t a) { return sinuosity_of(lines[a]); }),
        real("z_up", [&](std::size_t a) { return reaches[a].z_up_m; }),
        real("z_down", [&](std::size_t a) { return reaches[a].z_down_m; }),
        real("chi_up", [&](std::size_t a) { return reaches[a].chi_up; }),
        real("chi_down", [&](std::size_t a) { return reaches[a].chi_down; }),
        real("ksn", [&](std::size_t a) { return reaches[a].k_sn ? reaches[a].k_sn->slope : std::nan(""); }),
        real("ksn_r2", [&](std::size_t a) { return reaches[a].k_sn ? reaches[a].k_sn->r2 : std::nan(""); }),
        whole("knickpoints", [&](std::size_t a) { return breaks[a]; }),
    };
    if (std::ranges::any_of(rivers.names, [](std::string const& name) { return !name.empty(); })) {
        columns.push_back(text("name", rivers.names));
    }
    io::Table arcs{"arcs", io::Table::Shape::line, rows.size(), {}, [&](std::size_t row) { return shapes[row]; }};
    for (Column& column : columns) {
        column.at = [at = column.at, &rows](std::size_t row) { return at(rows[row]); };
        arcs.columns.push_back(std::move(column));
    }
    double const widest = areas_m2.empty() ? 0.0 : *std::ranges::max_element(areas_m2);
    int const highest = orders.strahler.empty() ? 1 : *std::ranges::max_element(orders.strahler);
    arcs.style = io::river_style("strahler", highest, {"ds_area", widest});

    auto const point = [&](std::size_t k) -> measure::Knickpoint const& { return measures.knickpoints[k]; };
    auto const& profiles = measures.profiles;
    io::Table knickpoints{"knickpoints", io::Table::Shape::plan_point, measures.knickpoints.size(), {}, {}};
    knickpoints.shape_at = [&](std::size_t k) {
        Vec2 const at = grid.centre(grid.at(profiles.cell[point(k).place]));
        return std::vector<Vec3>{{at.x, at.y, 0.0}};
    };
    knickpoints.columns = {
        whole("arc_id", [&](std::size_t k) { return rivers.reaches[profiles.reach[point(k).place]].id; }),
        real("z", [&](std::size_t k) { return profiles.z_m[point(k).place]; }),
        real("drop", [&](std::size_t k) { return point(k).drop_m; }),
        real("outlet_m", [&](std::size_t k) { return point(k).outlet_m; }),
        real("area", [&](std::size_t k) { return profiles.area_m2[point(k).place]; }),
        real("chi", [&](std::size_t k) { return measures.chi[point(k).place]; }),
        real("ksn_above", [&](std::size_t k) { return point(k).k_above; }),
        real("ksn_below", [&](std::size_t k) { return point(k).k_below; }),
    };
    io::write_tables({std::move(arcs), std::move(knickpoints)}, grid.crs, path, run);
}

MeasuredCatchments write_catchments(MeasuredRiver const& rivers, Raster<float> const& dem,
                                    flow::FlowField const& drainage, std::string const& path, Run const& run) {
    flow::Catchments const catchments = flow::catchments(rivers.reaches, drainage, run);
    auto const rows = make::catchment_rows(rivers.reaches, rivers.basins, catchments);
    Raster<double> const outlet_m = flow::lengths_to_outlet(drainage, run);
    io::CatchmentTables tables{catchments.reach, rows};
    std::set<std::int64_t> basins;
    std::vector<double> areas;
    for (io::CatchmentRow const& row : rows) {
        areas.push_back(static_cast<double>(row.upstream_cells));
        if (row.cells > 0) {
            basins.insert(row.basin_id);
        }
    }
    std::vector<std::string> const codes = codes_of(rivers.reaches, areas);
    auto const relief = measure::zone_relief(dem, catchments.reach, std::ssize(rows), outlet_m, run);
    auto const basin_relief = measure::zone_relief(dem, io::basins_by_cell(tables), std::ssize(basins), outlet_m, run);
    tables.columns = relief_columns(relief);
    tables.columns.insert(tables.columns.begin(), text("pfafstetter", codes));
    tables.basin_columns = relief_columns(basin_relief);
    return {io::write_catchments(tables, path, run),
            static_cast<std::int64_t>(rows.size()),
            rivers.cut,
            rivers.outside,
            rivers.nowhere,
            catchments.without};
}

} // namespace thalweg::commands
