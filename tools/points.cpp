// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

#include <thalweg/io/output_file.hpp>
#include <thalweg/io/write_points.hpp>
#include <thalweg/pipeline/make_points.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace thalweg::tools {

namespace {

struct Options {
    pipeline::MakePointsParams source;
    std::string file;
    std::string format;
    bool skeleton = false;
    bool overwrite = false;
};

int points(Options& options, Session const& session) {
    options.source.write.format = io::point_format(options.format, options.file);
    options.source.of = options.skeleton ? pipeline::PointsOf::skeleton : pipeline::PointsOf::land;
    io::OutputFile file(options.file, options.overwrite ? io::Existing::replace : io::Existing::refuse);
    pipeline::MadePoints const made = pipeline::make_points(options.source, file.staging(), session.run);
    file.commit();
    session.run.say(fmt::format("points {}", made.count));
    nlohmann::ordered_json const json{{"file", options.file}, {"crs", made.crs}, {"points", made.count}};
    fmt::print("{}\n", session.json ? json.dump(2) : options.file);
    return Exit::done;
}

} // namespace

Command add_points(CLI::App& app, Session& session) {
    auto const options = std::make_shared<Options>();
    std::string formats;
    for (auto const& f : io::point_formats()) {
        formats += (formats.empty() ? "" : ", ") + std::string(f.name);
    }
    app.add_option("SOURCE", options->source.path, "a DEM, or a folder that make wrote")->required();
    app.add_option("-o,--output", options->file, "the file to be written")->required();
    app.add_option("--every", options->source.write.every, "of so many rows and columns take one; 1 without it");
    app.add_flag("--skeleton", options->skeleton, "only the cells of the rivers, from a folder that make wrote");
    app.add_option("--format", options->format, formats + "; without it, by the name's ending");
    app.add_flag("--json", session.json, "one JSON object on stdout");
    app.add_flag("--overwrite", options->overwrite, "replace an existing file");
    return [options, &session] { return points(*options, session); };
}

} // namespace thalweg::tools
