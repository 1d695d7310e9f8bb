// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/io/files/files.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/pipeline/commands/make_tin.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"

namespace thalweg::tools {

namespace {

struct TinOptions {
    pipeline::MakeTinParams source;
    std::string file;
    std::string format;
    std::string duplicates;
    bool overwrite = false;
};

std::string as_json(pipeline::MadeTin const& made, std::string const& file) {
    nlohmann::ordered_json json{{"file", file},
                                {"source", made.source},
                                {"crs", made.crs},
                                {"vertices", made.tin.vertices.size()},
                                {"triangles", made.tin.triangles.size()},
                                {"merged", made.merged},
                                {"merged_dz_m", made.merged_dz_m},
                                {"averaged", made.averaged},
                                {"averaged_dz_m", made.averaged_dz_m},
                                {"crossings", made.crossings},
                                {"crossings_dz_m", made.crossings_dz_m},
                                {"left_out", made.left_out}};
    if (made.error_m) {
        json["error_m"] = *made.error_m;
    }
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string tin_in_words(pipeline::MadeTin const& made) {
    std::string words = fmt::format("{} vertices, {} triangles", made.tin.vertices.size(), made.tin.triangles.size());
    if (made.error_m) {
        words += fmt::format(", within {:.3f} m", *made.error_m);
    }
    if (made.left_out > 0) {
        words += fmt::format("; {} isolated cells are left out", made.left_out);
    }
    // arcs of a network always share vertices
    if (made.merged > 0 && (made.source == "points" || made.merged_dz_m > 0.0)) {
        words += fmt::format("; {} duplicate point{} merged", made.merged, made.merged == 1 ? " is" : "s are");
        if (made.averaged > 0) {
            words += fmt::format(", at {} place{} into the mean of heights up to {:.3f} m apart", made.averaged,
                                 made.averaged == 1 ? "" : "s", made.averaged_dz_m);
        }
        if (made.merged_dz_m > 0.0) {
            words += fmt::format(", with lines up to {:.3f} m apart in height: the first is kept", made.merged_dz_m);
        }
    }
    if (made.crossings > 0) {
        words += fmt::format("; {} line crossings, up to {:.3f} m apart in height: the first line is kept",
                             made.crossings, made.crossings_dz_m);
    }
    return words;
}

int tin(TinOptions& options, Session const& session) {
    if (!options.duplicates.empty()) {
        options.source.duplicates =
            options.duplicates == "error" ? io::DuplicatePoints::refused : io::DuplicatePoints::averaged;
    }
    auto const format = io::tin_format(options.format, options.file);
    io::OutputFile file(options.file, options.overwrite ? io::Existing::replace : io::Existing::refuse);
    pipeline::MadeTin const made = pipeline::make_tin(options.source, session.run);
    io::write_tin(made.tin, made.crs, file.staging(), format, HeightUnit::metre, session.run);
    file.commit();
    session.run.tell("tin", tin_in_words(made));
    fmt::print("{}", session.json ? as_json(made, options.file) : options.file + "\n");
    return Exit::done;
}

} // namespace

Command add_tin(CLI::App& app, Session& session) {
    auto const options = std::make_shared<TinOptions>();
    std::string formats;
    for (auto const& f : io::tin_formats()) {
        formats += (formats.empty() ? "" : ", ") + std::string(f.name);
    }
    app.add_option("SOURCE", options->source.path,
                   "A DEM, points (CSV or XYZ text, any point layer), lines with heights, or a folder written by make.")
        ->required();
    app.add_option("-o,--output", options->file, "Write this file.")->required();
    app.add_option("--error", options->source.error_m, "Limit the vertical error of a DEM's TIN [m]. Default: 1.");
    app.add_option("--breaklines", options->source.breaklines,
                   "Use these lines with heights as edges, in addition to points.");
    app.add_option("--crs", options->source.crs,
                   "Set the CRS of text points, or reproject points and lines to this CRS.");
    app.add_option("--source-crs", options->source.source_crs,
                   "Read text points, and files that have no CRS, in this one; --crs is the CRS of the TIN.")
        ->type_name("EPSG:N");
    app.add_option("--columns", options->source.columns,
                   "Take x, y and z of text points from these columns: names of the first line or numbers from 1, such "
                   "as 3,2,4; or pnezd (number, northing, easting, height, description).")
        ->type_name("X,Y,Z");
    app.add_option("--duplicates", options->duplicates,
                   "Merge points at one place but unequal heights into their mean, or refuse such a file and list the "
                   "first of them. Default: mean.")
        ->check(CLI::IsMember({"mean", "error"}));
    app.add_option("--format", options->format, formats + ". Default: by the file extension.");
    add_nodata_option(app, options->source.nodata);
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.add_flag("--overwrite", options->overwrite, "Replace an existing file.");
    return [options, &session] { return tin(*options, session); };
}

} // namespace thalweg::tools
