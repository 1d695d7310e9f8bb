// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/points.hpp>
#include <thalweg/io/mesh/points.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

int points(commands::PointsParams const& params, Session const& session) {
    commands::PointsResult const made = commands::run_points(params, session.run);
    session.run.tell("points", fmt::format("{}", made.count));
    print_result(session, {{"file", params.output}, {"crs", made.crs}, {"points", made.count}}, {params.output});
    return Exit::done;
}

} // namespace

Command add_points(CLI::App& app, Session& session) {
    auto const params = std::make_shared<commands::PointsParams>();
    std::string const formats = names_in_words(io::point_formats());
    app.add_option("SOURCE", params->path, "A folder written by make, or any height raster GDAL reads.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", params->output, "Write this file.")->type_name("FILE(las,ply,xyz)")->required();
    app.add_option("--every", params->every, "Take every Nth row and column. Default: every cell.")
        ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()));
    app.add_flag_callback(
        "--skeleton", [params] { params->of = commands::PointsOf::skeleton; },
        "Take only river and ridge cells of a folder written by make.");
    app.add_option("--format", params->format, "Write this format: " + formats + ". Default: by the file extension.");
    add_dem_options(app, params->reading);
    add_json_option(app, session);
    add_overwrite_option(app, params->existing);
    app.footer("Writes one point per cell, at its centre; cells without data are left out. LAS is version 1.2, point "
               "format 0, with ground in class 2 and rivers in class 9 (water).\n\n"
               "Examples:\n"
               "  thalweg points out -o land.las\n"
               "  thalweg points out -o rivers.ply --skeleton\n"
               "  thalweg points dem.tif -o coarse.xyz --every 10\n");
    return [params, &session] { return points(*params, session); };
}

} // namespace thalweg::tools
