// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <thalweg/commands/deform.hpp>
#include <thalweg/core/run/refuse.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"
#include "commands/print.hpp"

namespace thalweg::tools {

namespace {

struct DeformOptions {
    commands::DeformParams params;
    std::vector<double> pull;
    std::vector<double> axis;
};

void take_numbers(DeformOptions& options) {
    std::vector<double> const& pull = options.pull;
    std::vector<double> const& axis = options.axis;
    refuse_if<BadParameter>(pull.size() % 3 != 0, "commands.run_deform",
                            "--pull has {} numbers; it takes three for each place, X,Y,Z", pull.size());
    for (std::size_t i = 0; i < pull.size(); i += 3) {
        options.params.handles.push_back({pull[i], pull[i + 1], pull[i + 2]});
    }
    if (!axis.empty()) {
        refuse_if<BadParameter>(axis.size() != 3, "commands.run_deform", "--axis has {} numbers; it takes three, X,Y,Z",
                                axis.size());
        options.params.axis = Vec3{axis[0], axis[1], axis[2]};
    }
}

int deform(DeformOptions& options, Session const& session) {
    take_numbers(options);
    std::string const& file = options.params.output;
    std::size_t const pulled = options.params.handles.size();
    commands::DeformResult const made = commands::run_deform(options.params, session.run);
    if (auto const* const mesh = std::get_if<commands::DeformedTin>(&made)) {
        session.run.tell("deform", fmt::format("{} vertices, {} of them pulled", mesh->vertices, pulled));
        print_result(session,
                     {{"file", file}, {"vertices", mesh->vertices}, {"handles", pulled}, {"residual", mesh->residual}},
                     {file});
    } else {
        auto const& dem = std::get<commands::DeformedDem>(made);
        session.run.tell("deform", fmt::format("{} cells, {} of them pulled", dem.cells, pulled));
        print_result(session,
                     {{"file", file},
                      {"cells", dem.cells},
                      {"handles", pulled},
                      {"iterations", dem.iterations},
                      {"residual", dem.residual}},
                     {file});
    }
    return Exit::done;
}

} // namespace

Command add_deform(CLI::App& app, Session& session) {
    auto const options = std::make_shared<DeformOptions>();
    app.add_option("TARGET", options->params.target, "The DEM to bend, or a mesh: .2dm, .obj, .off or .glb.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->params.output, "Write this GeoTIFF; of a mesh any format of `thalweg tin`.")
        ->type_name("FILE")
        ->required();
    app.add_option("--mask", options->params.mask,
                   "Deform this region: a raster on the target's grid (neither 0 nor no-data), or polygons in any "
                   "format OGR reads.")
        ->type_name("FILE")
        ->required();
    app.add_option(
        "--scale", options->params.scale,
        "Multiply the region's slopes by this factor: 0 levels it, a negative factor turns hills into hollows.");
    app.add_option("--rotate", options->params.rotate_deg,
                   "Rotate the region of a mesh by this many degrees counterclockwise about --axis.")
        ->check(CLI::Range(-360.0, 360.0));
    add_list(app, "--axis", "X,Y,Z", options->axis,
             "Rotate about this direction. Default: 0,0,1, the vertical; any other turns the region out of the "
             "plane.");
    add_list(app, "--pull", "X,Y,Z", options->pull, "Pull the terrain at X,Y to the height Z [m]; may be repeated.");
    app.add_option("--source-crs", options->params.source_crs,
                   "Read a mesh that names no CRS in this projected CRS in metres.")
        ->type_name("EPSG:N");
    add_dem_options(app, options->params.reading);
    add_json_option(app, session);
    add_overwrite_option(app, options->params.existing);
    app.footer("Keeps or scales the relief of the region and pulls it smoothly to the given heights (Poisson's "
               "equation). The edge of the region and everything outside keep their heights exactly.\n\n"
               "Examples:\n"
               "  thalweg deform valley/dem.tif -o bent.tif --mask region.gpkg --scale 1.5\n"
               "  thalweg deform valley/dem.tif -o bent.tif --mask region.gpkg --pull 512000,4990000,900\n"
               "  thalweg deform mesh.obj -o bent.obj --mask region.gpkg --rotate 30 --axis 1,0,0\n");
    return [options, &session] { return deform(*options, session); };
}

} // namespace thalweg::tools
