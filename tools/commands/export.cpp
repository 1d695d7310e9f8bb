// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/export/export.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

int export_terrain(exports::ExportParams const& params, Session const& session) {
    exports::ExportResult const made = exports::run_export(params, session.run);
    session.run.tell("export",
                     fmt::format("{} x {}, {:.6g} to {:.6g} m", made.width, made.height, made.min_m, made.max_m));
    auto json = nlohmann::ordered_json::parse(made.description);
    json["files"] = made.files;
    json["notes"] = texts_of(made.findings);
    print_result(session, json, made.files);
    return Exit::done;
}

std::optional<std::int64_t> side_in(std::string_view word) {
    std::int64_t side = 0;
    auto const [end, fault] = std::from_chars(word.data(), word.data() + word.size(), side);
    return fault == std::errc{} && end == word.data() + word.size() ? std::optional(side) : std::nullopt;
}

/// Explains why a word is not a size; "": it is one.
std::string take_size(std::string const& word, exports::ExportParams& params) {
    std::size_t const cross = word.find('x');
    params.width = side_in(std::string_view(word).substr(0, cross));
    params.height = cross == std::string::npos ? params.width : side_in(std::string_view(word).substr(cross + 1));
    return params.width && params.height ? ""
                                         : fmt::format("'{}' is not N or WIDTHxHEIGHT, such as 1025 or 1025x769", word);
}

/// Explains why a word is no number of tiles; "": it is one.
std::string take_tiles(std::string const& word, exports::ExportParams& params) {
    exports::ExportParams read;
    if (!take_size(word, read).empty()) {
        return fmt::format("'{}' is not N or ACROSSxDOWN, such as 2 or 4x2", word);
    }
    params.tiles_across = read.width;
    params.tiles_down = read.height;
    return "";
}

void add_size_option(CLI::App& app, char const* name, char const* meaning,
                     std::shared_ptr<exports::ExportParams> const& params,
                     std::string (*take)(std::string const&, exports::ExportParams&)) {
    app.add_option_function<std::string>(
           name,
           [params, name, take](std::string const& word) {
               if (std::string const fault = take(word, *params); !fault.empty()) {
                   throw CLI::ValidationError(name, fault);
               }
           },
           meaning)
        ->type_name("N|WxH");
}

void add_preset_options(CLI::App& app, std::shared_ptr<exports::ExportParams> const& params) {
    add_size_option(app, "--tiles", "With --for: cut heights and masks into this many tiles: N a side, or ACROSSxDOWN.",
                    params, take_tiles);
    add_list(
        app, "--masks", "LIST", params->masks,
        "With --for: write these masks: slope, flow, wetness, curvature, water, river_distance, river_width, ridge, "
        "land_cover, all or none. Default: all.");
    app.add_option("--mask-bits", params->mask_bits, "With --for: bits of a mask's samples, 8 or 16. Default: 8.");
    app.add_option("--runoff", params->runoff_mm,
                   "With --for: runoff [mm/a], from which rivers have their discharge and width. Default: 300.");
    app.add_option("--print-size", params->print_mm,
                   "With --for print3d: longer side of the model [mm]. Default: 150.");
    app.add_option("--tree-line", params->tree_line_m,
                   "With --for: height [m] above which land cover has no forest. Default: 1800.");
}

} // namespace

Command add_export(CLI::App& app, Session& session) {
    auto const params = std::make_shared<exports::ExportParams>();
    app.add_option("SOURCE", params->source, "A folder written by make, or any height raster GDAL reads.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", params->output,
                   "Write this file, and beside it FILE.json with sizes, heights, axes and position; with --for this "
                   "folder, with export.json in it.")
        ->required();
    auto* const format = app.add_option(
        "--format", params->format, names_in_words(exports::export_formats()) + ". Default: by the file extension.");
    app.add_option("--for", params->preset,
                   "Write a folder of what this program imports: " + names_in_words(exports::export_presets()) + ".")
        ->excludes(format);
    add_size_option(
        app, "--size",
        "Resample to this many samples or vertices: N a side, or WIDTHxHEIGHT. Default: the DEM's cells, in "
        "a mesh at most 1025 a side; with --for the size nearest to these that the program takes.",
        params, take_size);
    add_preset_options(app, params);
    app.add_option("--exaggeration", params->exaggeration, "Multiply the heights of a mesh by this factor.");
    app.add_option(
        "--base", params->base,
        "Make a solid this thick below its lowest height: of stl [m], default a tenth of the relief, at least a "
        "cell; of print3d [mm], default 3.");
    app.add_option(
        "--rim", params->rim,
        "Treat cells without data that are connected with the border: " + names_in_words(exports::rim_gaps()) +
            ". cut takes the largest rectangle without them, nearest fills them from the nearest cells, "
            "minimum with the lowest height, sea with --sea-level. Default: cut.");
    app.add_option("--holes", params->holes,
                   "Treat cells without data that land encloses: " + names_in_words(exports::enclosed_gaps()) +
                       ". shore makes each gap level at the lowest cell beside it. Default: shore. Without --rim, "
                       "--holes and --sea-level, glb, obj and --for web leave cells without data open.");
    app.add_option("--sea-level", params->sea_level_m,
                   "The sea of a DEM lies at this height [m]: cells at or below it are water, unless land encloses "
                   "them. Default: a DEM has no sea.");
    add_dem_options(app, params->reading);
    add_json_option(app, session);
    add_overwrite_option(app, params->existing, "Replace files of the same names.");
    app.footer(
        "png16, r16, r32 and exr are heightmaps: 16 bits from the lowest height to the highest as PNG or raw, or "
        "metres as 32-bit floats, raw or as OpenEXR. glb and obj are textured meshes, Y up, glb with rivers as lines; "
        "stl is a closed solid, Z up. Meshes are in metres from an origin in the middle, at the lowest height.\n\n"
        "Examples:\n"
        "  thalweg export valley -o valley.glb\n"
        "  thalweg export valley --size 1009 -o heights.png\n"
        "  thalweg export valley --for unreal -o landscape\n"
        "  thalweg export valley --for unity --tiles 2 --size 1025 -o tiles\n"
        "  thalweg export dem.tif --size 513x385 --exaggeration 2 --base 50 -o dem.stl\n");
    return [params, &session] { return export_terrain(*params, session); };
}

} // namespace thalweg::tools
