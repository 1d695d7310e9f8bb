// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/commands/make_blend.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"

namespace thalweg::tools {

namespace {

struct BlendOptions {
    pipeline::MakeBlendParams params;
    std::vector<double> at;
    std::vector<std::int64_t> window;
    std::string file;
    std::string source_crs;
    bool mixed = false;
    bool fills = false;
    bool overwrite = false;
};

char const* name_of(pipeline::PatchPlace place) {
    switch (place) {
    case pipeline::PatchPlace::own: return "own";
    case pipeline::PatchPlace::middle: return "middle";
    default: return "given";
    }
}

std::string as_json(pipeline::MadeBlend const& made, std::string const& file) {
    blend::Pasted const& pasted = made.pasted;
    nlohmann::ordered_json const json{{"file", file},
                                      {"place", name_of(made.place)},
                                      {"at", {made.at.x, made.at.y}},
                                      {"warped", made.is_warped},
                                      {"cells", pasted.cells},
                                      {"kept", pasted.kept},
                                      {"holes", pasted.holes},
                                      {"outside", made.outside},
                                      {"seam_max_m", pasted.seam_max_m},
                                      {"seam_rms_m", pasted.seam_rms_m},
                                      {"iterations", pasted.iterations},
                                      {"residual", pasted.residual}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string blend_in_words(pipeline::MadeBlend const& made, bool fills) {
    blend::Pasted const& pasted = made.pasted;
    std::string words = fmt::format(
        "{} cells around ({:.3f}, {:.3f}){}; seam {:.3f} m rms, {:.3f} m at most", pasted.cells, made.at.x, made.at.y,
        made.place == pipeline::PatchPlace::middle ? ", the centre of the target, because the source lies outside it"
                                                   : "",
        pasted.seam_rms_m, pasted.seam_max_m);
    if (pasted.kept > 0) {
        words += fmt::format("; {} cells keep their height", pasted.kept);
    }
    if (pasted.holes > 0) {
        words += fmt::format("; {} cells in holes of the source are {}", pasted.holes,
                             fills ? "filled" : "left as they were");
    }
    if (made.outside > 0) {
        words += fmt::format("; {} cells of the mask lie off the source", made.outside);
    }
    return words;
}

void take_numbers(BlendOptions& options) {
    if (!options.at.empty()) {
        refuse_if<BadParameter>(options.at.size() != 2, "--at has {} numbers; it takes two, X,Y", options.at.size());
        options.params.at = Vec2{options.at[0], options.at[1]};
    }
    if (!options.window.empty()) {
        refuse_if<BadParameter>(options.window.size() != 4,
                                "--window has {} numbers; it takes four, COLUMN,ROW,WIDTH,HEIGHT",
                                options.window.size());
        options.params.window = {options.window[0], options.window[1], options.window[2], options.window[3]};
    }
    options.params.relief = options.mixed ? blend::Relief::mixed : blend::Relief::source;
    options.params.holes = options.fills ? blend::Holes::fill : blend::Holes::leave;
}

/// Options for cells or handles do not apply to a mesh.
void refuse_options_of_dems(BlendOptions const& options) {
    for (auto const& [name, given] :
         {std::pair{"--window", !options.window.empty()}, std::pair{"--mask", !options.params.mask.path.empty()},
          std::pair{"--keep", !options.params.keep.empty()},
          std::pair{"--feather", options.params.feather_cells != 0.0}, std::pair{"--mixed", options.mixed},
          std::pair{"--fill-holes", options.fills}, std::pair{"--nodata", options.params.nodata.has_value()}}) {
        refuse_if<BadParameter>(given, "{} is for DEMs: a mesh is pasted whole, inside its outline", name);
    }
}

std::string as_json(pipeline::MadeBlendTin const& made, std::string const& file) {
    nlohmann::ordered_json const json{{"file", file},
                                      {"place", name_of(made.place)},
                                      {"at", {made.at.x, made.at.y}},
                                      {"vertices", made.fused.tin.vertices.size()},
                                      {"triangles", made.fused.tin.triangles.size()},
                                      {"removed", made.fused.removed},
                                      {"inner", made.fused.inner},
                                      {"added", made.fused.added},
                                      {"lift_max_m", made.fused.lift_max_m},
                                      {"residual", made.fused.residual}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

int blend_meshes(BlendOptions const& options, Session const& session) {
    for (std::string const& path : {options.params.target, options.params.source.path}) {
        refuse_if<BadParameter>(
            !io::holds_tin(path),
            "{} is not a mesh (.2dm, .obj, .off), the other file is; `thalweg tin` makes a mesh of a DEM", path);
    }
    refuse_options_of_dems(options);
    auto const format = io::tin_format("", options.file);
    io::OutputFile file(options.file, options.overwrite ? io::Existing::replace : io::Existing::refuse);
    pipeline::MadeBlendTin const made = pipeline::make_blend_tin(
        {options.params.target, options.params.source.path, options.params.at, options.params.rotate_deg,
         options.params.scale, options.params.gain, options.source_crs},
        session.run);
    io::write_tin(made.fused.tin, made.crs, file.staging(), format, HeightUnit::metre, session.run);
    file.commit();
    session.run.tell("blend",
                     fmt::format("{} vertices inside the outline replaced by {}, {} added on it, around ({:.3f}, "
                                 "{:.3f}){}; the patch's edge moved by {:.3f} m at most",
                                 made.fused.removed, made.fused.inner, made.fused.added, made.at.x, made.at.y,
                                 made.place == pipeline::PatchPlace::middle
                                     ? ", the centre of the target, because the source lies outside it"
                                     : "",
                                 made.fused.lift_max_m));
    fmt::print("{}", session.json ? as_json(made, options.file) : options.file + "\n");
    return Exit::done;
}

int blend_files(BlendOptions& options, Session const& session) {
    take_numbers(options);
    if (io::holds_tin(options.params.target) || io::holds_tin(options.params.source.path)) {
        return blend_meshes(options, session);
    }
    refuse_if<BadParameter>(
        !options.source_crs.empty(),
        "--source-crs is for meshes (.2dm, .obj, .off); assign a DEM its CRS by gdal_edit.py -a_srs");
    io::OutputFile file(options.file, options.overwrite ? io::Existing::replace : io::Existing::refuse);
    pipeline::MadeBlend const made = pipeline::make_blend(options.params, session.run);
    io::write_dem(made.pasted.dem, file.staging(), session.run);
    file.commit();
    session.run.tell("blend", blend_in_words(made, options.fills));
    fmt::print("{}", session.json ? as_json(made, options.file) : options.file + "\n");
    return Exit::done;
}

} // namespace

Command add_blend(CLI::App& app, Session& session) {
    auto const options = std::make_shared<BlendOptions>();
    pipeline::MakeBlendParams& params = options->params;
    app.add_option("TARGET", params.target, "The DEM to paste into, or a mesh: .2dm, .obj or .off.")
        ->type_name("FILE")
        ->required();
    app.add_option("SOURCE", params.source.path,
                   "The DEM to take the patch from. It is warped (bilinear) if its CRS or cells differ. Into a mesh, "
                   "a mesh with one boundary.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->file, "Write this GeoTIFF; of meshes any format of `thalweg tin`.")
        ->type_name("FILE")
        ->required();
    app.add_option("--at", options->at,
                   "Place the centre of the patch here, in the target's coordinates. Default: at the patch's own "
                   "coordinates, or in the centre of the target if they lie outside it.")
        ->type_name("X,Y")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--rotate", params.rotate_deg, "Rotate the patch by this many degrees counterclockwise.")
        ->check(CLI::Range(-360.0, 360.0));
    app.add_option("--scale", params.scale, "Scale the patch in plan by this factor.");
    app.add_option("--gain", params.gain, "Multiply heights by this factor.");
    app.add_option("--mask", params.mask.path,
                   "Replace only these cells: a raster on the target's grid (neither 0 nor no-data), or polygons in "
                   "any format OGR reads.")
        ->type_name("FILE");
    app.add_option(
           "--window", options->window,
           "Take only this part of the source: column and row of its north-western cell, number of columns and rows.")
        ->type_name("C,R,W,H")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--feather", params.feather_cells,
                   "Blend the target's relief into the patch's over this many cells inside the edge.")
        ->check(CLI::Range(0.0, 1e6));
    app.add_option("--keep", params.keep,
                   "Keep the heights of these cells: those under lines (a network, or any lines OGR reads), or a "
                   "raster on the target's grid.")
        ->type_name("FILE");
    app.add_flag("--mixed", options->mixed, "Between neighbouring cells, use the steeper slope of patch and target.");
    app.add_flag("--fill-holes", options->fills,
                 "Also fill holes of the source. Default: holes keep the target's heights.");
    app.add_option("--source-crs", options->source_crs, "Read meshes that name no CRS in this projected CRS in metres.")
        ->type_name("EPSG:N");
    add_nodata_option(app, params.nodata);
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.add_flag("--overwrite", options->overwrite, "Replace an existing file.");
    app.footer("Keeps the relief of the patch and matches the target's heights along its edge (Poisson blending), so "
               "that there is no step. Outside the patch the target's heights do not change by a single bit. Of meshes "
               "the target is cut along the patch's outline and takes the patch's triangles inside.\n\n"
               "Examples:\n"
               "  thalweg blend valley/dem.tif peaks.tif -o blended.tif --feather 8\n"
               "  thalweg blend valley/dem.tif peaks.tif -o blended.tif --mask where.gpkg --rotate 30 --gain 0.5\n"
               "  thalweg blend valley/dem.tif peaks.tif -o blended.tif --window 100,80,256,256 --keep valley\n"
               "  thalweg blend land.obj hill.obj -o both.obj --at 512000,4990000 --rotate 30 --gain 1.5\n");
    return [options, &session] { return blend_files(*options, session); };
}

} // namespace thalweg::tools
