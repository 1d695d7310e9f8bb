// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/pipeline/commands/make_measures.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"

namespace thalweg::tools {

namespace {

using nlohmann::ordered_json;

struct MeasureOptions {
    pipeline::MakeMeasuresParams params;
    NetworkOptions network;
    std::string folder;
    bool overwrite = false;
};

ordered_json json_of(pipeline::MadeMeasures const& made) {
    ordered_json json{{"files", made.files},
                      {"notes", made.notes},
                      {"cells", made.cells},
                      {"area_m2", made.area_m2},
                      {"pit_cells", made.pits}};
    if (made.d8_m2) {
        json["d8"] = {{"greatest_m2", *made.d8_m2}};
    }
    if (made.dinf_m2) {
        json["dinf"] = {{"greatest_m2", *made.dinf_m2}};
    }
    if (made.catchments) {
        pipeline::MeasuredCatchments const& c = *made.catchments;
        json["catchments"] = {{"count", c.count.catchments},     {"parts", c.count.parts},
                              {"basins", c.count.basins},        {"arcs", c.arcs},
                              {"arcs_cut", c.arcs_cut},          {"arcs_outside", c.arcs_outside},
                              {"cells_without", c.cells_without}};
    }
    return json;
}

int measure(MeasureOptions& options, Session const& session) {
    options.params.network = options.network.path;
    options.params.read = options.network.params();
    auto const existing = options.overwrite ? io::Existing::replace : io::Existing::refuse;
    pipeline::MadeMeasures const made = pipeline::make_measures(options.params, options.folder, existing, session.run);
    for (std::string const& note : made.notes) {
        session.run.tell("note", note);
    }
    if (session.json) {
        fmt::print("{}\n", json_of(made).dump(-1, ' ', false, ordered_json::error_handler_t::replace));
        return Exit::done;
    }
    for (std::string const& file : made.files) {
        fmt::print("{}\n", file);
    }
    return Exit::done;
}

} // namespace

Command add_measure(CLI::App& app, Session& session) {
    auto const options = std::make_shared<MeasureOptions>();
    app.add_option("DEM", options->params.dem, "A folder written by make, or any height raster GDAL reads.")
        ->type_name("FILE")
        ->required();
    add_network_options(app, options->network, "--schema,--from");
    app.get_option("NETWORK")->required(false)->description(
        "Use these rivers for catchments: a network in any schema that convert reads. Default: those of the folder.");
    app.add_option("-o,--output", options->folder, "Write to this folder.")->type_name("DIR")->required();
    app.add_option("--what", options->params.what,
                   "Write these, separated by commas: d8 and dinf (contributing areas), directions (of both), "
                   "catchments (one polygon per arc). Default: d8, dinf and, with rivers, catchments.")
        ->type_name("LIST")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_flag("--overwrite", options->overwrite, "Replace files of the same names. Other files are kept.");
    add_nodata_option(app, options->params.nodata);
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.footer("Writes area_d8.tif and area_dinf.tif (contributing areas in m2, by D8 and D-infinity), "
               "direction_d8.tif (1 to 128 clockwise from east, 0 at outlets), direction_dinf.tif (radians "
               "counterclockwise from east, -1 at outlets) and catchments.gpkg (layers catchments and basins). Flow is "
               "routed through depressions and flats; the DEM is not changed. A catchment holds the cells whose flow "
               "reaches a river first at its arc; the catchments tile all cells that drain to a river.\n\n"
               "Examples:\n"
               "  thalweg measure valley -o measures\n"
               "  thalweg measure dem.tif rivers.gpkg --what catchments -o measures\n"
               "  thalweg measure dem.tif --what d8,dinf,directions -o measures --json\n");
    return [options, &session] { return measure(*options, session); };
}

} // namespace thalweg::tools
