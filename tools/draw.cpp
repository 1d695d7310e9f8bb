// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include <thalweg/pipeline/draw_files.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace thalweg::tools {

namespace {

struct Options {
    std::string source;
    std::string output;
    pipeline::DrawParams params;
    bool overwrite = false;
};

int draw(Options const& options, Session const& session) {
    auto const existing = options.overwrite ? io::Existing::replace : io::Existing::refuse;
    pipeline::Drawn const drawn =
        pipeline::draw_files(options.source, options.output, options.params, existing, session.run);
    for (std::string const& note : drawn.notes) {
        session.run.say("note   " + note);
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
    auto const options = std::make_shared<Options>();
    pipeline::DrawParams& params = options->params;
    app.add_option("SOURCE", options->source, "A folder that make left, or any raster of heights.")->required();
    app.add_option("-o,--output", options->output,
                   "The folder for the pictures, or the name of one (.png, .svg, .pdf).")
        ->required();
    app.add_option(
           "--what", params.what,
           "Draw these: map, profile, curve, hypsometry, sections, wireframe; without it all that can be drawn.")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--format", params.formats, "Write these formats: png, svg, pdf; without it png.")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--network", params.network, "Draw the rivers of this file, any file of lines.");
    app.add_option("--title", params.title, "Give the pictures this title.");
    app.add_option("--width", params.look.width_px, "Make the pictures this wide [pixels].")
        ->check(CLI::Range(200, 8000));
    app.add_option("--azimuth", params.look.azimuth_deg,
                   "Look at the wireframe this way [degrees from north, clockwise]; without it up the valley.")
        ->check(CLI::Range(-360.0, 360.0));
    app.add_option("--elevation", params.look.elevation_deg,
                   "Look at the wireframe from this far above the horizon [degrees].")
        ->check(CLI::Range(5.0, 85.0));
    app.add_option("--exaggeration", params.look.exaggeration,
                   "Multiply the wireframe's heights; without it by a round number that reads well.")
        ->check(CLI::Range(0.001, 100000.0));
    app.add_flag("--overwrite", options->overwrite, "Replace pictures of the same names.");
    app.add_flag("--json", session.json, "Print one JSON object to stdout.");
    return [options, &session] { return draw(*options, session); };
}

} // namespace thalweg::tools
