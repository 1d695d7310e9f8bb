// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <thalweg/pipeline/commands/measure.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

using nlohmann::ordered_json;

struct MeasureOptions {
    pipeline::MeasureParams params;
    std::vector<std::string> fields;
};

ordered_json json_of(pipeline::MeasureResult const& made) {
    ordered_json json{{"files", made.files},
                      {"notes", texts_of(made.findings)},
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
    options.params.read.fields = fields_by_quantity(options.fields);
    pipeline::MeasureResult const made = pipeline::run_measure(options.params, session.run);
    print_result(session, json_of(made), made.files, -1);
    return Exit::done;
}

} // namespace

Command add_measure(CLI::App& app, Session& session) {
    auto const options = std::make_shared<MeasureOptions>();
    app.add_option("DEM", options->params.dem, "A folder written by make, or any height raster GDAL reads.")
        ->type_name("FILE")
        ->required();
    add_network_options(app, options->params.network, options->params.read, options->fields, "--schema,--from");
    app.get_option("NETWORK")->required(false)->description(
        "Use these rivers for catchments: a network in any schema that convert reads. Default: those of the folder.");
    app.add_option("-o,--output", options->params.output, "Write to this folder.")->type_name("DIR")->required();
    add_list(app, "--what", "LIST", options->params.what,
             "Write these, separated by commas: d8 and dinf (contributing areas), directions (of both), "
             "catchments (one polygon per arc). Default: d8, dinf and, with rivers, catchments.");
    add_overwrite_option(app, options->params.existing, "Replace files of the same names. Other files are kept.");
    add_dem_options(app, options->params.reading);
    add_json_option(app, session);
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
