// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/io/files/files.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/pipeline/commands/make_points.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"

namespace thalweg::tools {

namespace {

struct PointsOptions {
    pipeline::MakePointsParams source;
    std::string file;
    std::string format;
    bool skeleton = false;
    bool overwrite = false;
};

int points(PointsOptions& options, Session const& session) {
    options.source.write.format = io::point_format(options.format, options.file);
    options.source.of = options.skeleton ? pipeline::PointsOf::skeleton : pipeline::PointsOf::land;
    io::OutputFile file(options.file, options.overwrite ? io::Existing::replace : io::Existing::refuse);
    pipeline::MadePoints const made = pipeline::make_points(options.source, file.staging(), session.run);
    file.commit();
    session.run.tell("points", fmt::format("{}", made.count));
    nlohmann::ordered_json const json{{"file", options.file}, {"crs", made.crs}, {"points", made.count}};
    fmt::print("{}\n", session.json ? json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                                    : options.file);
    return Exit::done;
}

} // namespace

Command add_points(CLI::App& app, Session& session) {
    auto const options = std::make_shared<PointsOptions>();
    std::string formats;
    for (auto const& f : io::point_formats()) {
        formats += (formats.empty() ? "" : ", ") + std::string(f.name);
    }
    app.add_option("SOURCE", options->source.path, "A folder written by make, or any height raster GDAL reads.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->file, "Write this file.")->type_name("FILE(las,ply,xyz)")->required();
    app.add_option("--every", options->source.write.every, "Take every Nth row and column. Default: every cell.")
        ->check(CLI::Range(std::int64_t{1}, std::numeric_limits<std::int64_t>::max()));
    app.add_flag("--skeleton", options->skeleton, "Take only river and ridge cells of a folder written by make.");
    app.add_option("--format", options->format, "Write this format: " + formats + ". Default: by the file extension.");
    add_nodata_option(app, options->source.nodata);
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.add_flag("--overwrite", options->overwrite, "Replace an existing file.");
    app.footer("Writes one point per cell, at its centre; cells without data are left out. LAS is version 1.2, point "
               "format 0, with ground in class 2 and rivers in class 9 (water).\n\n"
               "Examples:\n"
               "  thalweg points out -o land.las\n"
               "  thalweg points out -o rivers.ply --skeleton\n"
               "  thalweg points dem.tif -o coarse.xyz --every 10\n");
    return [options, &session] { return points(*options, session); };
}

} // namespace thalweg::tools
