// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/tin.hpp>
#include <thalweg/io/mesh/tin.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

nlohmann::ordered_json json_of(commands::TinResult const& made, std::string const& file) {
    nlohmann::ordered_json json{{"file", file},
                                {"source", made.source},
                                {"crs", made.crs},
                                {"vertices", made.tin.vertices.size()},
                                {"triangles", made.tin.triangles.size()},
                                {"merged", made.merged},
                                {"merged_dz_m", made.merged_dz_m},
                                {"without_height", made.without_height},
                                {"averaged", made.averaged},
                                {"averaged_dz_m", made.averaged_dz_m},
                                {"crossings", made.crossings},
                                {"crossings_dz_m", made.crossings_dz_m},
                                {"left_out", made.left_out}};
    if (made.source == "network") {
        json["medial_points"] = made.medial;
    }
    if (made.flat) {
        json["flat"] = *made.flat;
    }
    if (made.error_m) {
        json["error_m"] = *made.error_m;
    }
    return json;
}

std::string tin_in_words(commands::TinResult const& made) {
    std::string words = fmt::format("{} vertices, {} triangles", made.tin.vertices.size(), made.tin.triangles.size());
    if (made.error_m) {
        words += fmt::format(", within {:.3f} m", *made.error_m);
    }
    if (made.left_out > 0) {
        words += fmt::format("; {} isolated cells are left out", made.left_out);
    }
    if (made.flat.value_or(0.0) >= 0.005) {
        words += fmt::format("; {:.1f} % of the area is flat{}", 100.0 * *made.flat,
                             made.source == "network" && made.medial == 0 ? " (of contours --medial-points fills it in)"
                                                                          : "");
    }
    if (made.medial > 0) {
        words += fmt::format("; {} points are added in level areas", made.medial);
    }
    if (made.without_height > 0) {
        words += fmt::format("; {} point{} of no data left out", made.without_height,
                             made.without_height == 1 ? " is" : "s are");
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

int tin(commands::TinParams const& params, Session const& session) {
    commands::TinResult const made = commands::run_tin(params, session.run);
    session.run.tell("tin", tin_in_words(made));
    print_result(session, json_of(made, params.output), {params.output});
    return Exit::done;
}

} // namespace

Command add_tin(CLI::App& app, Session& session) {
    auto const params = std::make_shared<commands::TinParams>();
    std::string const formats = names_in_words(io::tin_formats());
    app.add_option(
           "SOURCE", params->path,
           "A DEM, points (CSV or XYZ text, LAS, LAZ, any point layer), lines with heights, or a folder written by "
           "make.")
        ->required();
    app.add_option("-o,--output", params->output, "Write this file.")->required();
    app.add_option("--error", params->error_m, "Limit the vertical error of a DEM's TIN [m]. Default: 1.");
    app.add_option("--breaklines", params->breaklines, "Use these lines with heights as edges, in addition to points.");
    app.add_option("--height-column", params->height_column,
                   "Take the heights of points or lines from this field, as of contours.")
        ->type_name("NAME");
    app.add_flag("--medial-points", params->medial_points,
                 "Add points with heights between the contours where the TIN of contours would be flat: on spurs, in "
                 "valleys, on summits. Lakes of --breaklines stay level.");
    app.add_option("--crs", params->crs, "Set the CRS of text points, or reproject points and lines to this CRS.");
    app.add_option("--source-crs", params->source_crs,
                   "Read text points, and files that have no CRS, in this one; --crs is the CRS of the TIN.")
        ->type_name("EPSG:N");
    app.add_option("--columns", params->columns,
                   "Take x, y and z of text points from these columns: names of the first line or numbers from 1, such "
                   "as 3,2,4; or pnezd (number, northing, easting, height, description).")
        ->type_name("X,Y,Z");
    app.add_option("--classes", params->classes,
                   "Take points of these classes from a point cloud: ground (2 and 8), water (9), all (but noise), or "
                   "numbers, separated by commas. Default: ground, or all of a cloud that is not classified.")
        ->type_name("CLASS,...");
    app.add_option(
        "--thin", params->thin_m,
        "Keep of a point cloud the point nearest to the centre of each cell of this side [m]; 0: all points. "
        "Default: the side that leaves about a million points, if there are more.");
    app.add_option_function<std::string>(
           "--duplicates",
           [params](std::string const& word) {
               params->duplicates = word == "error" ? io::DuplicatePoints::refused : io::DuplicatePoints::averaged;
           },
           "Merge points at one place but unequal heights into their mean, or refuse such a file and list the "
           "first of them. Default: mean.")
        ->check(CLI::IsMember({"mean", "error"}));
    app.add_option("--format", params->format, formats + ". Default: by the file extension.");
    add_dem_options(app, params->reading);
    add_json_option(app, session);
    add_overwrite_option(app, params->existing);
    return [params, &session] { return tin(*params, session); };
}

} // namespace thalweg::tools
