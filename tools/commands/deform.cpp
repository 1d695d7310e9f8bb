// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/commands/make_deform.hpp>

#include "commands/commands.hpp"
#include "commands/options.hpp"

namespace thalweg::tools {

namespace {

struct DeformOptions {
    pipeline::MakeDeformParams params;
    std::vector<double> pull;
    std::vector<double> axis;
    double rotate_deg = 0.0;
    std::string file;
    std::string source_crs;
    bool overwrite = false;
};

void take_handles(DeformOptions& options) {
    refuse_if<BadParameter>(options.pull.size() % 3 != 0, "--pull has {} numbers; it takes three for each place, X,Y,Z",
                            options.pull.size());
    for (std::size_t i = 0; i < options.pull.size(); i += 3) {
        options.params.handles.push_back({options.pull[i], options.pull[i + 1], options.pull[i + 2]});
    }
}

int deform_mesh(DeformOptions const& options, Session const& session) {
    refuse_if<BadParameter>(options.params.nodata.has_value(), "--nodata is for DEMs: a mesh has no cells");
    pipeline::MakeDeformTinParams params{options.params.target, options.params.mask, options.params.scale,
                                         options.rotate_deg};
    params.handles = options.params.handles;
    params.source_crs = options.source_crs;
    if (!options.axis.empty()) {
        refuse_if<BadParameter>(options.axis.size() != 3, "--axis has {} numbers; it takes three, X,Y,Z",
                                options.axis.size());
        refuse_if<BadParameter>(options.axis == std::vector<double>(3, 0.0), "--axis 0,0,0 has no direction");
        params.axis = {options.axis[0], options.axis[1], options.axis[2]};
    }
    auto const format = io::tin_format("", options.file);
    io::OutputFile file(options.file, options.overwrite ? io::Existing::replace : io::Existing::refuse);
    pipeline::DeformedTin const made = pipeline::make_deform_tin(params, session.run);
    io::write_tin(made.tin, made.crs, file.staging(), format, HeightUnit::metre, session.run);
    file.commit();
    session.run.tell("deform", fmt::format("{} vertices, {} of them pulled", made.vertices, params.handles.size()));
    nlohmann::ordered_json const json{{"file", options.file},
                                      {"vertices", made.vertices},
                                      {"handles", params.handles.size()},
                                      {"residual", made.residual}};
    fmt::print("{}", session.json ? json.dump(2) + "\n" : options.file + "\n");
    return Exit::done;
}

int deform_file(DeformOptions& options, Session const& session) {
    take_handles(options);
    if (io::holds_tin(options.params.target)) {
        return deform_mesh(options, session);
    }
    refuse_if<BadParameter>(options.rotate_deg != 0.0 || !options.axis.empty(),
                            "--rotate and --axis turn meshes (.2dm, .obj, .off); a DEM has one height a cell. `thalweg "
                            "tin` makes a mesh of it, `thalweg blend --rotate` turns a patch about the vertical");
    refuse_if<BadParameter>(
        !options.source_crs.empty(),
        "--source-crs is for meshes (.2dm, .obj, .off); assign a DEM its CRS by gdal_edit.py -a_srs");
    io::OutputFile file(options.file, options.overwrite ? io::Existing::replace : io::Existing::refuse);
    blend::Deformed const made = pipeline::make_deform(options.params, session.run);
    io::write_dem(made.dem, file.staging(), session.run);
    file.commit();
    session.run.tell("deform", fmt::format("{} cells, {} of them pulled", made.cells, options.params.handles.size()));
    nlohmann::ordered_json const json{{"file", options.file},
                                      {"cells", made.cells},
                                      {"handles", options.params.handles.size()},
                                      {"iterations", made.iterations},
                                      {"residual", made.residual}};
    fmt::print("{}", session.json ? json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"
                                  : options.file + "\n");
    return Exit::done;
}

} // namespace

Command add_deform(CLI::App& app, Session& session) {
    auto const options = std::make_shared<DeformOptions>();
    app.add_option("TARGET", options->params.target, "The DEM to bend, or a mesh: .2dm, .obj or .off.")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->file, "Write this GeoTIFF; of a mesh any format of `thalweg tin`.")
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
    app.add_option("--rotate", options->rotate_deg,
                   "Rotate the region of a mesh by this many degrees counterclockwise about --axis.")
        ->check(CLI::Range(-360.0, 360.0));
    app.add_option("--axis", options->axis,
                   "Rotate about this direction. Default: 0,0,1, the vertical; any other turns the region out of the "
                   "plane.")
        ->type_name("X,Y,Z")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--pull", options->pull, "Pull the terrain at X,Y to the height Z [m]; may be repeated.")
        ->type_name("X,Y,Z")
        ->delimiter(',')
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--source-crs", options->source_crs,
                   "Read a mesh that names no CRS in this projected CRS in metres.")
        ->type_name("EPSG:N");
    add_nodata_option(app, options->params.nodata);
    app.add_flag("--json", session.json, "Print one JSON object.");
    app.add_flag("--overwrite", options->overwrite, "Replace an existing file.");
    app.footer("Keeps or scales the relief of the region and pulls it smoothly to the given heights (Poisson's "
               "equation). The edge of the region and everything outside keep their heights exactly.\n\n"
               "Examples:\n"
               "  thalweg deform valley/dem.tif -o bent.tif --mask region.gpkg --scale 1.5\n"
               "  thalweg deform valley/dem.tif -o bent.tif --mask region.gpkg --pull 512000,4990000,900\n"
               "  thalweg deform mesh.obj -o bent.obj --mask region.gpkg --rotate 30 --axis 1,0,0\n");
    return [options, &session] { return deform_file(*options, session); };
}

} // namespace thalweg::tools
