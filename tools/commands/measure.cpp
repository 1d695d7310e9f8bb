// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <thalweg/commands/measure.hpp>
#include <thalweg/core/run/refuse.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

using nlohmann::ordered_json;

struct MeasureOptions {
    commands::MeasureParams params;
    std::string theta = "0.45";
    std::vector<std::string> fields;
};

ordered_json json_of(commands::MeasureResult const& made) {
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
        commands::MeasuredCatchments const& c = *made.catchments;
        json["catchments"] = {{"count", c.count.catchments},     {"parts", c.count.parts},
                              {"basins", c.count.basins},        {"arcs", c.arcs},
                              {"arcs_cut", c.arcs_cut},          {"arcs_outside", c.arcs_outside},
                              {"cells_without", c.cells_without}};
    }
    if (made.streams) {
        commands::MeasuredStreams const& s = *made.streams;
        json["streams"] = {
            {"arcs", s.arcs}, {"arcs_edge", s.arcs_edge}, {"knickpoints", s.knickpoints}, {"theta", s.theta}};
        if (s.theta_r2) {
            json["streams"]["theta_r2"] = *s.theta_r2;
        }
    }
    if (made.edge_cells) {
        json["edge_cells"] = *made.edge_cells;
    }
    return json;
}

/// A concavity index, or "fit".
std::optional<double> theta_of(std::string const& text) {
    double number = 0.0;
    if (text == "fit") {
        return std::nullopt;
    }
    refuse_if<BadParameter>(!CLI::detail::lexical_cast(text, number), "commands.run_measure",
                            "tools.measure: --theta {} is neither a number from 0 to 2 nor fit", text);
    return number;
}

int measure(MeasureOptions& options, Session const& session) {
    options.params.read.fields = fields_by_quantity(options.fields);
    options.params.theta = theta_of(options.theta);
    commands::MeasureResult const made = commands::run_measure(options.params, session.run);
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
        "Use these rivers for catchments, hand, chi and streams: a network in any schema that convert reads. Default: "
        "those of the folder, if any; else, without catchments, the cells of --support.");
    app.add_option("-o,--output", options->params.output, "Write to this folder.")->type_name("DIR")->required();
    add_list(app, "--what", "LIST", options->params.what,
             "Write these, separated by commas, or all: d8, dinf, directions, edge, lengths, hand, twi, orders, chi, "
             "streams, catchments (see below). Default: d8, dinf and, with rivers, catchments.");
    app.add_option("--support", options->params.support_cells, "Start a stream where this many cells drain.")
        ->type_name("CELLS")
        ->capture_default_str();
    app.add_option("--theta", options->theta,
                   "Set the concavity index of chi and ksn; fit: that for which rivers and their tributaries fall best "
                   "on one line of height against chi.")
        ->type_name("X|fit")
        ->capture_default_str();
    app.add_option("--window", options->params.steepness.window_m,
                   "Fit ksn by cell over this length [m] of river, at least three cells.")
        ->type_name("X")
        ->capture_default_str();
    app.add_option("--knick-drop", options->params.knickpoint.drop_m,
                   "Find knickpoints that stand this many metres above the concave profile.")
        ->type_name("X")
        ->capture_default_str();
    add_overwrite_option(app, options->params.existing, "Replace files of the same names. Other files are kept.");
    add_dem_options(app, options->params.reading);
    add_json_option(app, session);
    app.footer(
        "Measures and their files:\n"
        "  d8, dinf     area_d8.tif, area_dinf.tif: contributing areas in m2\n"
        "  directions   direction_d8.tif (1 to 128 clockwise from east, 0 at outlets) and\n"
        "               direction_dinf.tif (radians counterclockwise from east, -1 at outlets)\n"
        "  edge         edge.tif: 1 where water may come from beyond the data\n"
        "  lengths      length_up.tif, length_down.tif: longest flow path from a divide, and to\n"
        "               where water leaves, in m\n"
        "  hand         hand.tif: height above the first river cell on the flow path, in m\n"
        "  twi          twi.tif: topographic wetness index, of D-infinity areas\n"
        "  orders       strahler.tif, shreve.tif: orders of the streams of --support\n"
        "  chi          chi.tif, ksn.tif: chi and channel steepness of river cells\n"
        "  streams      streams.gpkg: arcs with orders, Pfafstetter codes, sinuosity, chi, ksn and edge, and\n"
        "               knickpoints\n"
        "  catchments   catchments.gpkg: catchments of arcs with Pfafstetter codes, and basins, with heights,\n"
        "               hypsometric integral, Melton index, slope, flow length and form factor\n\n"
        "Flow is routed by D8 through depressions and flats; the DEM is not changed. A catchment holds the cells "
        "whose flow reaches a river first at its arc; the catchments tile all cells that drain to a river. A DEM "
        "in degrees is warped to UTM first, and everything is in its metres.\n\n"
        "Examples:\n"
        "  thalweg measure valley -o measures\n"
        "  thalweg measure dem.tif rivers.gpkg --what catchments -o measures\n"
        "  thalweg measure dem.tif --what d8,dinf,directions -o measures --json\n"
        "  thalweg measure dem.tif --what hand,streams --support 500 --theta fit -o measures\n");
    return [options, &session] { return measure(*options, session); };
}

} // namespace thalweg::tools
