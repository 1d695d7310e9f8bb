// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/blend.hpp>
#include <thalweg/core/run/refuse.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

struct BlendOptions {
    commands::BlendParams params;
    std::vector<double> at;
    std::vector<std::int64_t> window;
};

char const* name_of(make::PatchPlace place) {
    return place == make::PatchPlace::own ? "own" : place == make::PatchPlace::middle ? "middle" : "given";
}

nlohmann::ordered_json json_of(make::BlendedDem const& made, std::string const& file) {
    blend::PastedDem const& pasted = made.pasted;
    return {{"file", file},
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
}

char const* why_there(make::PatchPlace place) {
    return place == make::PatchPlace::middle
               ? ", the centre of the target, because the source lies elsewhere (by its own position and CRS)"
               : "";
}

std::string blend_in_words(make::BlendedDem const& made, blend::Holes holes) {
    blend::PastedDem const& pasted = made.pasted;
    std::string words =
        fmt::format("{} cells around ({:.3f}, {:.3f}){}; seam {:.3f} m rms, {:.3f} m at most", pasted.cells, made.at.x,
                    made.at.y, why_there(made.place), pasted.seam_rms_m, pasted.seam_max_m);
    if (pasted.kept > 0) {
        words += fmt::format("; {} cells keep their height", pasted.kept);
    }
    if (pasted.holes > 0) {
        words += fmt::format("; {} cells in holes of the source are {}", pasted.holes,
                             holes == blend::Holes::fill ? "filled" : "left as they were");
    }
    if (made.outside > 0) {
        words += fmt::format("; {} cells of the mask lie off the source", made.outside);
    }
    return words;
}

void take_numbers(BlendOptions& options) {
    if (!options.at.empty()) {
        refuse_if<BadParameter>(options.at.size() != 2, "commands.run_blend", "--at has {} numbers; it takes two, X,Y",
                                options.at.size());
        options.params.patch.at = Vec2{options.at[0], options.at[1]};
    }
    if (!options.window.empty()) {
        refuse_if<BadParameter>(options.window.size() != 4, "commands.run_blend",
                                "--window has {} numbers; it takes four, COLUMN,ROW,WIDTH,HEIGHT",
                                options.window.size());
        options.params.patch.window = {options.window[0], options.window[1], options.window[2], options.window[3]};
    }
}

nlohmann::ordered_json json_of(commands::BlendedTin const& made, std::string const& file) {
    return {{"file", file},
            {"place", name_of(made.place)},
            {"at", {made.at.x, made.at.y}},
            {"vertices", made.fused.tin.vertices.size()},
            {"triangles", made.fused.tin.triangles.size()},
            {"removed", made.fused.removed},
            {"inner", made.fused.inner},
            {"added", made.fused.added},
            {"lift_max_m", made.fused.lift_max_m},
            {"residual", made.fused.residual}};
}

std::string blend_in_words(commands::BlendedTin const& made, blend::Holes /*holes*/) {
    return fmt::format("{} vertices inside the outline replaced by {}, {} added on it, around ({:.3f}, {:.3f}){}; the "
                       "patch's edge moved by {:.3f} m at most",
                       made.fused.removed, made.fused.inner, made.fused.added, made.at.x, made.at.y,
                       why_there(made.place), made.fused.lift_max_m);
}

int blend(BlendOptions& options, Session const& session) {
    take_numbers(options);
    std::string const& file = options.params.output;
    std::visit(
        [&](auto const& made) {
            session.run.tell("blend", blend_in_words(made, options.params.patch.holes));
            print_result(session, json_of(made, file), {file});
        },
        commands::run_blend(options.params, session.run));
    return Exit::done;
}

} // namespace

Command add_blend(CLI::App& app, Session& session) {
    auto const options = std::make_shared<BlendOptions>();
    make::BlendIntoParams& params = options->params.patch;
    app.add_option("TARGET", params.target, "The DEM to paste into, or a mesh: .2dm, .obj, .off or .glb.")
        ->type_name("FILE")
        ->required();
    app.add_option("SOURCE", params.source.path,
                   "The DEM to take the patch from. It is warped (bilinear) if its CRS or cells differ. Into a mesh, "
                   "a mesh with one boundary.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->params.output, "Write this GeoTIFF; of meshes any format of `thalweg tin`.")
        ->type_name("FILE")
        ->required();
    add_list(app, "--at", "X,Y", options->at,
             "Place the centre of the patch here, in the target's coordinates. Default: at the patch's own "
             "coordinates, or in the centre of the target if they lie outside it.");
    app.add_option("--rotate", params.rotate_deg, "Rotate the patch by this many degrees counterclockwise.")
        ->check(CLI::Range(-360.0, 360.0));
    app.add_option("--scale", params.scale, "Scale the patch in plan by this factor.");
    app.add_option("--gain", params.gain, "Multiply heights by this factor.");
    app.add_option("--mask", params.mask.path,
                   "Replace only these cells: a raster on the target's grid (neither 0 nor no-data), or polygons in "
                   "any format OGR reads.")
        ->type_name("FILE");
    add_list(app, "--window", "C,R,W,H", options->window,
             "Take only this part of the source: column and row of its north-western cell, number of "
             "columns and rows.");
    app.add_option("--feather", params.feather_cells,
                   "Blend the target's relief into the patch's over this many cells inside the edge.")
        ->check(CLI::Range(0.0, 1e6));
    app.add_option("--keep", params.keep,
                   "Keep the heights of these cells: those under lines (a network, or any lines OGR reads), or a "
                   "raster on the target's grid.")
        ->type_name("FILE");
    app.add_flag_callback(
        "--mixed", [&params] { params.relief = blend::Relief::mixed; },
        "Between neighbouring cells, use the steeper slope of patch and target.");
    app.add_flag_callback(
        "--fill-holes", [&params] { params.holes = blend::Holes::fill; },
        "Also fill holes of the source. Default: holes keep the target's heights.");
    app.add_option("--source-crs", options->params.source_crs,
                   "Read meshes that name no CRS in this projected CRS in metres.")
        ->type_name("EPSG:N");
    add_dem_options(app, params.reading);
    add_json_option(app, session);
    add_overwrite_option(app, options->params.existing);
    app.footer("Keeps the relief of the patch and matches the target's heights along its edge (Poisson blending), so "
               "that there is no step. Outside the patch the target's heights do not change by a single bit. Of meshes "
               "the target is cut along the patch's outline and takes the patch's triangles inside.\n\n"
               "Examples:\n"
               "  thalweg blend valley/dem.tif peaks.tif -o blended.tif --feather 8\n"
               "  thalweg blend valley/dem.tif peaks.tif -o blended.tif --mask where.gpkg --rotate 30 --gain 0.5\n"
               "  thalweg blend valley/dem.tif peaks.tif -o blended.tif --window 100,80,256,256 --keep valley\n"
               "  thalweg blend land.obj hill.obj -o both.obj --at 512000,4990000 --rotate 30 --gain 1.5\n");
    return [options, &session] { return blend(*options, session); };
}

} // namespace thalweg::tools
