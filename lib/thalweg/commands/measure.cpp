// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/measure.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/commands/internal/measure_rivers.hpp>
#include <thalweg/core/append.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/paths.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/io/qgis/styles.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>
#include <thalweg/make/file_values.hpp>
#include <thalweg/measure/relief/wetness.hpp>

namespace thalweg::commands {
namespace {

namespace fs = std::filesystem;

/// A measure, and the files that it writes.
struct Measure {
    std::string name;
    std::vector<std::string> files;
};

std::vector<Measure> const& measures() {
    static std::vector<Measure> const all = {
        {"d8", {"area_d8.tif", "area_d8.qml"}},
        {"dinf", {"area_dinf.tif", "area_dinf.qml"}},
        {"directions", {"direction_d8.tif", "direction_dinf.tif"}},
        {"edge", {"edge.tif"}},
        {"lengths", {"length_up.tif", "length_down.tif"}},
        {"hand", {"hand.tif"}},
        {"twi", {"twi.tif"}},
        {"orders", {"strahler.tif", "shreve.tif"}},
        {"chi", {"chi.tif", "ksn.tif"}},
        {"streams", {"streams.gpkg"}},
        {"catchments", {"catchments.gpkg"}},
    };
    return all;
}

struct MeasuredInput {
    std::string dem;
    std::string network; ///< "": none
};

MeasuredInput source_of(MeasureParams const& params) {
    std::error_code ignored;
    MeasuredInput source{params.dem, params.network};
    if (fs::is_directory(params.dem, ignored)) {
        source.dem = (fs::path(params.dem) / "dem.tif").string();
        if (fs::path const beside = fs::path(params.dem) / "network.gpkg";
            source.network.empty() && fs::exists(beside, ignored)) {
            source.network = beside.string();
        }
    }
    return source;
}

std::set<std::string> wanted_of(MeasureParams const& params, MeasuredInput const& source) {
    std::vector<std::string> known;
    for (Measure const& measure : measures()) {
        known.push_back(measure.name);
    }
    std::set<std::string> wanted;
    for (std::string const& word : params.what) {
        if (word == "all") {
            wanted.insert(known.begin(), known.end());
        } else if (std::ranges::find(known, word) == known.end()) {
            throw BadParameter("commands.run_measure",
                               fmt::format("unknown measure '{}'; the measures are {} and all.{}", word,
                                           fmt::join(known, ", "), did_you_mean(word, known)));
        } else {
            wanted.insert(word);
        }
    }
    bool const names_all = std::ranges::find(params.what, "all") != params.what.end();
    if (wanted.empty()) {
        wanted = {"d8", "dinf", "catchments"};
    }
    if (source.network.empty() && (params.what.empty() || names_all)) {
        wanted.erase("catchments");
    }
    refuse_if<BadInput>(wanted.contains("catchments") && source.network.empty(), "commands.run_measure",
                        "catchments need rivers: name a network after the DEM");
    return wanted;
}

/// Powers of two clockwise from the east: the D8 codes of most hydrology programs.
Raster<std::uint8_t> d8_codes(Raster<flow::Direction> const& direction) {
    Raster<std::uint8_t> codes(direction.grid());
    for (std::int64_t i = 0; i < codes.cells(); ++i) {
        flow::Direction const way = direction[i];
        codes[i] = way == flow::Direction::no_data ? io::no_code
                                                   : static_cast<std::uint8_t>(goes_on(way) ? 1 << index_of(way) : 0);
    }
    return codes;
}

/// Radians counterclockwise from the east: Tarboton's D-infinity angles.
Raster<double> dinf_angles(Raster<float> const& bearing) {
    Raster<double> angles(bearing.grid(), std::numeric_limits<double>::quiet_NaN());
    for (std::int64_t i = 0; i < angles.cells(); ++i) {
        auto const eighths = static_cast<double>(bearing[i]);
        if (bearing[i] == flow::dinf_leaves) {
            angles[i] = -1.0;
        } else if (!std::isnan(eighths)) {
            angles[i] = (eighths == 0.0 ? 0.0 : 8.0 - eighths) * (portable::pi / 4.0);
        }
    }
    return angles;
}

double greatest(Raster<double> const& areas) {
    double most = 0.0;
    for (double const area : areas.values()) {
        most = area > most ? area : most; // never NaN
    }
    return most;
}

/// Writes the folder's new files if they are requested.
class Writer {
public:
    Writer(std::string const& folder, std::set<std::string> const& wanted, io::Existing existing)
        : folder_(folder), out_(folder, io::Existing::add, there(folder, wanted, existing)) {}

    std::string path(std::string const& name) {
        names_.push_back(name);
        return out_.path(name);
    }
    /// A file that goes with one of these, and is not listed.
    std::string beside(std::string const& name) const { return out_.path(name); }
    std::vector<std::string> commit() {
        out_.commit();
        std::vector<std::string> files;
        for (std::string const& name : names_) {
            files.push_back((fs::path(folder_) / name).string());
        }
        return files;
    }

private:
    static std::vector<std::string> there(std::string const& folder, std::set<std::string> const& wanted,
                                          io::Existing existing) {
        std::vector<std::string> names;
        for (Measure const& measure : measures()) {
            if (wanted.contains(measure.name)) {
                append(names, measure.files);
            }
        }
        return io::files_there(folder, names, existing);
    }

    std::string folder_;
    io::OutputFolder out_;
    std::vector<std::string> names_;
};

/// QML beside a raster of areas.
std::string style_of_areas(Grid const& grid, double greatest_m2) {
    double const cell_m2 = grid.cell_m * grid.cell_m;
    return io::qml(io::area_style(cell_m2, std::max(cell_m2, greatest_m2)));
}

/// Adds a finding of an amount, unless it is 0.
void add_amount(std::vector<Finding>& findings, FindingKind kind, std::int64_t amount, std::string text) {
    if (amount != 0) {
        findings.push_back({.kind = kind, .amount = static_cast<double>(amount), .text = std::move(text)});
    }
}

std::vector<Finding> findings_on(MeasuredRiver const& rivers) {
    std::vector<Finding> findings;
    add_amount(findings, "arcs_off_dem", rivers.cut + rivers.outside,
               fmt::format("{} of {} arcs leave the DEM and {} lie outside it", rivers.cut, rivers.reaches.size(),
                           rivers.outside));
    add_amount(findings, "left_out", rivers.nowhere,
               fmt::format("{} arcs have a vertex that is not a number and were left out", rivers.nowhere));
    add_amount(findings, "cut_below", rivers.unknown,
               fmt::format("{} arcs name one downstream that the file does not hold, and end there", rivers.unknown));
    return findings;
}

std::vector<Finding> findings_on(MeasuredCatchments const& c) {
    std::vector<Finding> findings;
    std::int64_t const idle = std::max<std::int64_t>(0, c.arcs - c.arcs_outside - c.count.catchments);
    add_amount(findings, "no_catchment", idle,
               fmt::format("{} arcs have no catchment: other arcs own their cells, or these have no data", idle));
    add_amount(findings, "water_without_river", c.cells_without,
               fmt::format("water of {} cells leaves the DEM before it meets a river", c.cells_without));
    return findings;
}

/// What the measures of a DEM share.
struct Ground {
    Raster<float> const& dem;
    flow::FlowField const& drainage;
    NetworkFile const* network; ///< null: none
    std::set<std::string> const& wanted;

    bool wants(char const* measure) const { return wanted.contains(measure); }
};

void write_areas(Ground const& g, Raster<double> const& areas, char const* of, std::optional<double>& greatest_m2,
                 Writer& out, Run const& run) {
    greatest_m2 = greatest(areas);
    io::write_field(areas, out.path(fmt::format("area_{}.tif", of)), run);
    io::write_text(out.beside(fmt::format("area_{}.qml", of)), style_of_areas(g.dem.grid(), *greatest_m2));
}

void write_flow(Ground const& g, MeasureResult& made, Writer& out, Run const& run) {
    if (g.wants("d8")) {
        write_areas(g, make::areas_m2(g.drainage), "d8", made.d8_m2, out, run);
    }
    if (g.wants("directions")) {
        io::write_codes(d8_codes(g.drainage.direction), out.path("direction_d8.tif"), run);
    }
    if (g.wants("dinf") || g.wants("directions") || g.wants("twi")) {
        flow::DinfFlow const parted = flow::route_dinf(g.dem, g.drainage, run);
        if (g.wants("dinf")) {
            write_areas(g, make::areas_m2(parted.area_cells), "dinf", made.dinf_m2, out, run);
        }
        if (g.wants("directions")) {
            io::write_field(dinf_angles(parted.bearing), out.path("direction_dinf.tif"), run);
        }
        if (g.wants("twi")) {
            io::write_field(measure::wetness(g.dem, parted.area_cells, {}, run), out.path("twi.tif"), run);
        }
    }
}

void write_edge(Ground const& g, MeasureResult& made, Writer& out, Run const& run) {
    Raster<std::uint8_t> cut = flow::cut_by_edge(g.drainage);
    made.edge_cells = std::ranges::count(cut.values(), 1);
    for (std::int64_t i = 0; i < cut.cells(); ++i) {
        cut[i] = g.drainage.direction[i] == flow::Direction::no_data ? io::no_code : cut[i];
    }
    io::write_codes(cut, out.path("edge.tif"), run);
}

template <class T, class Known> Raster<double> field_of(Raster<T> const& raster, Known const& is_known) {
    Raster<double> field(raster.grid(), std::numeric_limits<double>::quiet_NaN());
    for (std::int64_t i = 0; i < raster.cells(); ++i) {
        if (is_known(i)) {
            field[i] = static_cast<double>(raster[i]);
        }
    }
    return field;
}

void write_lengths(Ground const& g, Writer& out, Run const& run) {
    auto const has_data = [&](std::int64_t i) { return g.drainage.direction[i] != flow::Direction::no_data; };
    io::write_field(field_of(flow::flow_lengths(g.drainage, run), has_data), out.path("length_up.tif"), run);
    io::write_field(flow::lengths_to_outlet(g.drainage, run), out.path("length_down.tif"), run);
}

void write_orders(Ground const& g, std::int64_t support_cells, Writer& out, Run const& run) {
    flow::StreamOrders orders = flow::stream_orders(g.drainage, support_cells, run);
    auto const is_stream = [&](std::int64_t i) { return orders.shreve[i] > 0; };
    Raster<double> const shreve = field_of(orders.shreve, is_stream);
    for (std::uint8_t& order : orders.strahler.values()) {
        order = order == 0 ? io::no_code : order;
    }
    io::write_codes(orders.strahler, out.path("strahler.tif"), run);
    io::write_field(shreve, out.path("shreve.tif"), run);
}

void write_rivers(Ground const& g, MeasureParams const& params, MeasureResult& made, Writer& out, Run const& run) {
    MeasuredRiver const rivers = g.network != nullptr ? rivers_of_file(*g.network, g.dem.grid())
                                                      : rivers_of_dem(g.dem, g.drainage, params.support_cells, run);
    append(made.findings, findings_on(rivers));
    if (rivers.reaches.empty()) {
        add_amount(made.findings, "no_rivers", 1,
                   fmt::format("there are no streams: no two cells drain {} cells or more; choose a smaller support",
                               params.support_cells));
    }
    if (g.wants("hand")) {
        auto const cells = g.network != nullptr ? flow::river_cells(rivers.reaches, g.dem.grid(), run)
                                                : flow::cells_with_area(g.drainage, params.support_cells, run);
        Raster<float> const hand = flow::heights_above_rivers(g.dem, cells, g.drainage, run);
        io::write_field(field_of(hand, [](std::int64_t) { return true; }), out.path("hand.tif"), run);
    }
    if (g.wants("chi") || g.wants("streams")) {
        RiverMeasures const found = measure_rivers(rivers, g.dem, g.drainage, params, run);
        if (g.wants("chi")) {
            io::write_field(raster_of(found.profiles, found.chi, g.dem.grid()), out.path("chi.tif"), run);
            io::write_field(raster_of(found.profiles, found.k_sn, g.dem.grid()), out.path("ksn.tif"), run);
        }
        if (g.wants("streams")) {
            write_streams(rivers, found, g.dem.grid(), out.path("streams.gpkg"), run);
        }
        made.streams = found.counts;
    }
    if (g.wants("catchments")) {
        made.catchments = write_catchments(rivers, g.dem, g.drainage, out.path("catchments.gpkg"), run);
        append(made.findings, findings_on(*made.catchments));
    }
}

/// The arcs of a network in the DEM's CRS. Lines of which nothing tells how they join are joined as by `check --fix`.
NetworkFile read_arcs(MeasuredInput const& source, io::ReadNetworkParams how, Raster<float> const& dem,
                      std::vector<Finding>& findings, Run const& run) {
    how.crs = dem.grid().crs;
    how.any_lines = true;
    NetworkFile file = io::read_network(source.network, how, run);
    refuse_if<BadInput>(!file.crs.empty() && dem.grid().crs.empty(), "commands.run_measure",
                        "{} has no CRS, {} is in {:.60}: give the DEM its CRS first (gdal_translate -a_srs)",
                        source.dem, source.network, file.crs);
    append(findings, file.findings);
    if (file.id_shift != 0) {
        findings.push_back({.kind = "renumbered",
                            .amount = static_cast<double>(file.id_shift),
                            .text = fmt::format("arc_id is the file's and {}", file.id_shift)});
    }
    return file.says.downstream || file.says.ends ? file : joined_lines(file, dem, findings, run);
}

} // namespace

MeasureResult run_measure(MeasureParams const& params, Run const& run) {
    MeasuredInput const source = source_of(params);
    auto const wanted = wanted_of(params, source);
    Writer out(params.output, wanted, params.existing);
    constexpr std::int64_t any_side = 1000000;
    io::Drawable const read = io::read_drawable(source.dem, {.most_side = any_side, .reading = params.reading}, run);
    Raster<float> const& dem = read.dem;
    bool const needs_rivers = std::ranges::any_of(std::array{"hand", "chi", "streams", "catchments"},
                                                  [&](char const* m) { return wanted.contains(m); });
    MeasureResult made;
    made.findings = read.findings;
    std::optional<NetworkFile> network;
    if (needs_rivers && !source.network.empty()) {
        network = read_arcs(source, params.read, dem, made.findings, run);
    }
    flow::FlowField const drainage = flow::route(dem, run);
    made.pits = drainage.pits;
    made.cells = std::count_if(drainage.direction.values().begin(), drainage.direction.values().end(),
                               [](flow::Direction way) { return way != flow::Direction::no_data; });
    made.area_m2 = static_cast<double>(made.cells) * dem.grid().cell_m * dem.grid().cell_m;
    Ground const ground{dem, drainage, network ? &*network : nullptr, wanted};
    write_flow(ground, made, out, run);
    if (ground.wants("edge")) {
        write_edge(ground, made, out, run);
    }
    if (ground.wants("lengths")) {
        write_lengths(ground, out, run);
    }
    if (ground.wants("orders")) {
        write_orders(ground, params.support_cells, out, run);
    }
    if (needs_rivers) {
        write_rivers(ground, params, made, out, run);
    }
    made.files = out.commit();
    run.report(made.findings);
    return made;
}

} // namespace thalweg::commands
