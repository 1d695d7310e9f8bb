// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/pipeline/commands/draw_files.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"

namespace thalweg::tools {

namespace {

struct DrawOptions {
    std::string source;
    std::string output;
    pipeline::DrawParams params;
    bool overwrite = false;
};

int draw(DrawOptions const& options, Session const& session) {
    auto const existing = options.overwrite ? io::Existing::replace : io::Existing::refuse;
    pipeline::Drawn const drawn =
        pipeline::draw_files(options.source, options.output, options.params, existing, session.run);
    for (std::string const& note : drawn.notes) {
        session.run.tell("note", note);
    }
    if (session.json) {
        nlohmann::ordered_json const out{{"files", drawn.files}, {"notes", drawn.notes}};
        fmt::print("{}\n", out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
        return Exit::done;
    }
    for (std::string const& file : drawn.files) {
        fmt::print("{}\n", file);
    }
    return Exit::done;
}

} // namespace

Command add_draw(CLI::App& app, Session& session) {
    auto const options = std::make_shared<DrawOptions>();
    pipeline::DrawParams& params = options->params;
    app.add_option("SOURCE", options->source, "A folder written by make, or any height raster GDAL reads.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->output,
                   "Write to this folder, or to one picture (.png, .svg, .pdf) or page (.html).")
        ->type_name("DIR")
        ->required();
    app.add_option("--what", params.what,
                   "Draw these, separated by commas: map, profile, curve, hypsometry, sections, wireframe; or page, a "
                   "report page for a browser. Default: every picture the input allows.")
        ->type_name("LIST")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--format", params.formats,
                   "Draw in these formats, separated by commas: png, svg, pdf. Default: png.")
        ->type_name("LIST")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--network", params.network, "Draw the rivers of this line file (any format OGR reads).")
        ->type_name("FILE");
    app.add_option("--title", params.title, "Set the title.");
    app.add_option("--width", params.look.width_px, "Set the width in pixels.")->check(CLI::Range(200, 8000));
    app.add_option(
           "--azimuth", params.look.azimuth_deg,
           "Set the viewing direction of the wireframe, in degrees clockwise from north. Default: up the valley.")
        ->check(CLI::Range(-360.0, 360.0));
    app.add_option("--elevation", params.look.elevation_deg,
                   "Set the height of the eye above the wireframe's horizon, in degrees.")
        ->check(CLI::Range(5.0, 85.0));
    app.add_option("--exaggeration", params.look.exaggeration,
                   "Multiply the wireframe's heights by this factor. Default: a suitable round number.")
        ->check(CLI::Range(0.001, 100000.0));
    app.add_flag("--overwrite", options->overwrite, "Replace pictures of the same names. Other files are kept.");
    add_nodata_option(app, params.nodata);
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.footer("A folder is drawn from its dem.tif, network.gpkg and recipe. A raster gives a map, hypsometric curve, "
               "sections and wireframe, and with rivers their long profiles. A raster larger than 4000 cells a side is "
               "averaged, a geographic one is reprojected to its UTM zone; stderr reports such changes.\n\n"
               "Examples:\n"
               "  thalweg draw valley -o pictures\n"
               "  thalweg draw valley --what wireframe --azimuth 300 -o valley.svg\n"
               "  thalweg draw dem.tif --network rivers.gpkg --what map,sections --format png,pdf -o pictures\n");
    return [options, &session] { return draw(*options, session); };
}

} // namespace thalweg::tools
