// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/commands/tin.hpp>

#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/tin_of_dem.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>

namespace thalweg::pipeline {
namespace {

using Kind = io::FileContent::Kind;
using Lines = std::vector<std::vector<Vec3>>;

struct Breaklines {
    Lines lines;
    std::string crs;
};

Breaklines read_lines(std::string const& path, std::string const& crs, std::string const& source_crs, Run const& run) {
    io::FileContent const content = io::content_of(path);
    refuse_if<BadInput>(content.kind != Kind::lines, "pipeline.run_tin: {} holds no lines", path);
    RiverLines rivers =
        io::read_rivers({.path = content.path, .layer = content.layer, .crs = crs, .source_crs = source_crs}, run);
    refuse_if<BadInput>(!rivers.has_z,
                        "pipeline.run_tin: the lines of {} have no heights (or all the same): a TIN takes lines with "
                        "Z, such as layer arcs of a network.gpkg",
                        content.path);
    Breaklines read{{}, rivers.crs};
    for (RiverLine& line : rivers.lines) {
        read.lines.push_back(std::move(line.vertices));
    }
    return read;
}

TinResult of_dem(std::string const& path, TinParams const& params, Run const& run) {
    double const error_m = params.error_m.value_or(geometry::TinOfDemParams{}.error_m);
    io::DemFile const read = io::read_dem_file(path, params.reading, run);
    run.report(read.findings);
    Raster<float> const& dem = read.dem;
    require_metres(dem.grid(), path, "pipeline.run_tin");
    auto simplified = geometry::tin_of_dem(dem, {error_m}, run);
    TinResult made;
    made.tin = std::move(simplified.tin);
    made.crs = dem.grid().crs;
    made.source = "dem";
    made.error_m = simplified.error_m;
    made.left_out = simplified.left_out;
    made.findings = read.findings;
    return made;
}

TinResult of_points(std::vector<Vec3> const& points, Breaklines const& breaklines, char const* source, Run const& run) {
    auto triangulation = geometry::triangulate(points, breaklines.lines, run);
    TinResult made;
    made.tin = std::move(triangulation.tin);
    made.crs = breaklines.crs;
    made.source = source;
    made.merged = triangulation.merged;
    made.merged_dz_m = triangulation.merged_dz_m;
    made.crossings = triangulation.crossings;
    made.crossings_dz_m = triangulation.crossings_dz_m;
    return made;
}

TinResult tin_of(TinParams const& params, Run const& run) {
    io::FileContent const content = io::content_of(params.path);
    if (params.duplicates && content.kind != Kind::points) {
        throw BadParameter(fmt::format("pipeline.run_tin: --duplicates applies to points only; {} holds {}",
                                       content.path, content.kind == Kind::raster ? "a DEM" : "lines"));
    }
    if (!params.columns.empty() && content.kind != Kind::points) {
        throw BadParameter(fmt::format("pipeline.run_tin: --columns applies to text with points; {} holds {}",
                                       content.path, content.kind == Kind::raster ? "a DEM" : "lines"));
    }
    if (content.kind == Kind::raster) {
        refuse_if<BadParameter>(
            !params.breaklines.empty() || !params.crs.empty() || !params.source_crs.empty(),
            "pipeline.run_tin: --breaklines, --crs and --source-crs apply to points and lines, not to a DEM");
        return of_dem(content.path, params, run);
    }
    for (auto const& [option, given] :
         {std::pair{"--error", params.error_m.has_value()},
          std::pair{"--nodata, --band or --encoding", params.reading != io::ReadDemParams{}}}) {
        if (given) {
            throw BadParameter(fmt::format("pipeline.run_tin: {} applies to a DEM only; {} holds {}", option,
                                           content.path, content.kind == Kind::points ? "points" : "lines"));
        }
    }
    if (content.kind == Kind::points) {
        FeaturePoints const points =
            io::read_points({.path = content.path,
                             .crs = params.crs,
                             .duplicates = params.duplicates.value_or(io::DuplicatePoints::averaged),
                             .columns = params.columns,
                             .source_crs = params.source_crs},
                            run);
        Breaklines breaklines{{}, points.crs};
        if (!params.breaklines.empty()) {
            breaklines = read_lines(params.breaklines, points.crs, params.source_crs, run);
        }
        TinResult made = of_points(points.points, breaklines, "points", run);
        made.averaged = points.averaged;
        made.averaged_dz_m = points.averaged_dz_m;
        return made;
    }
    Breaklines network = read_lines(content.path, params.crs, params.source_crs, run);
    if (content.layer == "arcs" && io::has_layer(content.path, "ridges")) {
        RiverLines ridges = io::read_rivers(
            {.path = content.path, .layer = "ridges", .crs = network.crs, .source_crs = params.source_crs}, run);
        for (RiverLine& line : ridges.lines) {
            network.lines.push_back(std::move(line.vertices));
        }
    }
    if (!params.breaklines.empty()) {
        Breaklines more = read_lines(params.breaklines, network.crs, params.source_crs, run);
        network.lines.insert(network.lines.end(), more.lines.begin(), more.lines.end());
    }
    return of_points({}, network, "network", run);
}

} // namespace

TinResult run_tin(TinParams const& params, Run const& run) {
    io::TinFormat const format = io::tin_format(params.format, params.output);
    io::OutputFile file(params.output, params.existing);
    TinResult made = tin_of(params, run);
    io::write_tin(made.tin, made.crs, file.staging(), format, HeightUnit::metre, run);
    file.commit();
    return made;
}

} // namespace thalweg::pipeline
