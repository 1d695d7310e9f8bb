// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/convert.hpp>
#include <thalweg/io/network/schema.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/report/report.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

struct ConvertOptions {
    commands::ConvertParams params;
    std::vector<std::string> fields;
    std::string schema = "native";
};

void tell(commands::ConvertResult const& made, Session const& session) {
    std::size_t const shown = session.verbose ? made.findings.size() : 10;
    for (std::size_t i = 0; i < std::min(shown, made.findings.size()); ++i) {
        session.run.say(line_of(made.findings[i]));
    }
    if (made.findings.size() > shown) {
        session.run.tell("note", fmt::format("... and {} more; --verbose prints all", made.findings.size() - shown));
    }
    session.run.tell("read", fmt::format("{} arcs and {} nodes, schema {}{}", made.arcs, made.nodes, made.schema,
                                         made.split > 0 ? fmt::format(", {} confluences moved", made.split) : ""));
    if (made.divergences > 0) {
        session.run.tell("read", fmt::format("{} minor branches leave at divergences", made.divergences));
    }
    if (std::string(made.heights) == "none") {
        session.run.tell("note", "the heights are unknown: lines are written without; --dem takes them from a DEM");
    }
    if (std::string(made.areas) == "none") {
        session.run.tell("note", "the contributing areas are unknown and written as -1; --dem measures them");
    }
}

nlohmann::ordered_json json_of(commands::ConvertResult const& made) {
    nlohmann::ordered_json json{{"written", made.written},
                                {"schema", made.schema},
                                {"crs", made.crs},
                                {"arcs", made.arcs},
                                {"nodes", made.nodes},
                                {"split", made.split},
                                {"divergences", made.divergences},
                                {"heights", made.heights},
                                {"areas", made.areas}};
    json["findings"] = nlohmann::ordered_json::parse(report::findings_json(made.findings));
    for (auto& one : json["findings"]) {
        one["where"] = {one.value("x", 0.0), one.value("y", 0.0)}; // its name in earlier versions
    }
    return json;
}

int convert(ConvertOptions& options, Session const& session) {
    options.params.schema = io::schema_named(options.schema);
    options.params.read.fields = fields_by_quantity(options.fields);
    commands::ConvertResult const made = commands::run_convert(options.params, session.run);
    tell(made, session);
    print_result(session, json_of(made), made.written);
    return Exit::done;
}

} // namespace

Command add_convert(CLI::App& app, Session& session) {
    auto const options = std::make_shared<ConvertOptions>();
    commands::ConvertParams& params = options->params;
    std::string const formats = names_in_words(io::network_formats());
    add_network_options(app, params.path, params.read, options->fields);
    app.add_option("-o,--output", params.output,
                   "Write this file, or tables in a PostGIS database: PG:dbname=rivers host=db.")
        ->type_name("FILE(gpkg,shp,fgb,geojson,graphml,csv,edges,tif)")
        ->required();
    app.add_option("--schema", options->schema, "Use the field names, units and line directions of this schema.")
        ->check(CLI::IsMember(schema_names()))
        ->capture_default_str();
    app.add_option("--format", params.format, "Write this format: " + formats + ". Default: by the file extension.");
    app.add_option("--max-upstream", params.max_upstream,
                   "Split nodes where more arcs than this end: the others join a little downstream.")
        ->type_name("N")
        ->check(CLI::Range(2, std::numeric_limits<int>::max()));
    app.add_option("--split-distance", params.split_distance_m,
                   "Move split confluences by this distance [m]. Default: the median segment length.")
        ->type_name("M")
        ->check(CLI::PositiveNumber);
    app.add_option("--dem", params.dem,
                   "Take missing heights and contributing areas from this DEM. A raster output gets its grid.")
        ->type_name("FILE(tif)");
    app.add_option("--cell", params.cell_m, "Set the cell size of a raster output without a DEM [m].")
        ->type_name("M")
        ->check(CLI::PositiveNumber);
    add_main_option(app, params.main);
    app.add_option("--table", params.table, "Name the database tables NAME or SCHEMA.NAME.")
        ->type_name("NAME")
        ->capture_default_str();
    add_dem_options(app, params.reading);
    add_json_option(app, session);
    add_overwrite_option(app, params.existing, "Replace existing files, or the tables and view in a database.");
    app.footer(
        "Networks that are not trees are rejected; thalweg check tells why. The schema nhdplus holds divergences too. "
        "Arcs get new numbers; the native field "
        "feature keeps their ids of another schema. TauDEM allows two arcs upstream of one: use --max-upstream 2. In "
        "the native schema, a shapefile, FlatGeobuf or GeoJSON output is two files, NAME_arcs and NAME_nodes. A raster "
        "has 1 in river cells and 0 elsewhere, as RivGraph expects. A database gets tables NAME_arcs and NAME_nodes "
        "and a view NAME_edges for pgRouting, in one transaction.\n\n"
        "Examples:\n"
        "  thalweg convert valley -o streams.shp --schema taudem --max-upstream 2\n"
        "  thalweg convert walker_nhdplus.gpkg -o walker.gpkg\n"
        "  thalweg convert valley -o 'PG:dbname=rivers' --table basin.network\n"
        "  thalweg convert valley -o valley.graphml\n");
    return [options, &session] { return convert(*options, session); };
}

} // namespace thalweg::tools
