// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include <thalweg/commands/draw.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

int draw(commands::DrawParams const& params, Session const& session) {
    commands::DrawResult const drawn = commands::run_draw(params, session.run);
    print_result(session, {{"files", drawn.files}, {"notes", texts_of(drawn.findings)}}, drawn.files, -1);
    return Exit::done;
}

} // namespace

Command add_draw(CLI::App& app, Session& session) {
    auto const params = std::make_shared<commands::DrawParams>();
    app.add_option("SOURCE", params->source,
                   "A folder written by make, any height raster GDAL reads, or the table.csv of an ensemble.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", params->output,
                   "Write to this folder, or to one picture (.png, .svg, .pdf) or page (.html).")
        ->type_name("DIR")
        ->required();
    add_list(app, "--what", "LIST", params->what,
             "Draw these, separated by commas: map, profile, curve, hypsometry, sections, wireframe; page, a report "
             "page for a browser; or ensemble, alone. Default: every picture the input allows.");
    add_list(app, "--format", "LIST", params->formats,
             "Draw in these formats, separated by commas: png, svg, pdf. Default: png; of an ensemble svg.");
    app.add_option("--network", params->network, "Draw the rivers of this line file (any format OGR reads).")
        ->type_name("FILE");
    app.add_option("--title", params->title, "Set the title.");
    app.add_option("--width", params->look.width_px, "Set the width in pixels.")->check(CLI::Range(200, 8000));
    app.add_option(
           "--azimuth", params->look.azimuth_deg,
           "Set the viewing direction of the wireframe, in degrees clockwise from north. Default: up the valley.")
        ->check(CLI::Range(-360.0, 360.0));
    app.add_option("--elevation", params->look.elevation_deg,
                   "Set the height of the eye above the wireframe's horizon, in degrees.")
        ->check(CLI::Range(5.0, 85.0));
    app.add_option("--exaggeration", params->look.exaggeration,
                   "Multiply the wireframe's heights by this factor. Default: a suitable round number.")
        ->check(CLI::Range(0.001, 100000.0));
    add_overwrite_option(app, params->existing, "Replace pictures of the same names. Other files are kept.");
    add_dem_options(app, params->reading);
    add_json_option(app, session);
    app.footer("A folder is drawn from its dem.tif, network.gpkg and recipe. A raster gives a map, hypsometric curve, "
               "sections and wireframe, and with rivers their long profiles. A raster larger than 4000 cells a side is "
               "averaged, a geographic one is reprojected to its UTM zone; stderr reports such changes.\n\n"
               "Of an ensemble, --what ensemble draws distributions of laws and indices with their natural ranges, "
               "their response to each key that varies, and a contact sheet of hillshades, with a page of all "
               "(ensemble.html). SOURCE is its table.csv, or the folder that holds it.\n\n"
               "Examples:\n"
               "  thalweg draw valley -o pictures\n"
               "  thalweg draw valley --what wireframe --azimuth 300 -o valley.svg\n"
               "  thalweg draw dem.tif --network rivers.gpkg --what map,sections --format png,pdf -o pictures\n");
    return [params, &session] { return draw(*params, session); };
}

} // namespace thalweg::tools
