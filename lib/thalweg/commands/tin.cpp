// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/commands/tin.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/tin_of_dem.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/mesh/tin.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>
#include <thalweg/network/import/river_heights.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/surface/tin/level_areas.hpp>

namespace thalweg::commands {
namespace {

using Kind = io::FileContent::Kind;
using Lines = std::vector<std::vector<Vec3>>;

struct Breaklines {
    Lines lines;
    std::string crs;
    std::vector<Finding> findings = {};
};

/// Whether lines may be all of a TIN, or go with points or other lines, and may then be level, as shores are.
enum class LinesAre : std::uint8_t { all, more };

bool have_any_heights(RiverLines const& lines, LinesAre are) {
    bool complete = true;
    bool zero = true;
    for (RiverLine const& line : lines.lines) {
        for (Vec3 const& v : line.vertices) {
            complete = complete && std::isfinite(v.z);
            zero = zero && v.z == 0.0;
        }
    }
    return lines.has_z || (are == LinesAre::more && complete && !zero);
}

/// How to name a column of heights, where there are columns of numbers.
std::string offered_columns(AttributeTable const& attributes) {
    std::vector<std::string> names;
    for (AttributeTable::Column const& column : attributes.columns) {
        using Type = AttributeTable::Type;
        if (column.type == Type::real || column.type == Type::integer || column.type == Type::integer64) {
            names.push_back(column.name);
        }
    }
    return names.empty()
               ? ""
               : fmt::format("; if a field holds heights, name it: --height-column {}", fmt::join(names, " or "));
}

Breaklines read_lines(std::string const& path, TinParams const& params, std::string const& crs, LinesAre are,
                      Run const& run) {
    bool const has_rings = are == LinesAre::more && !std::filesystem::is_directory(path) && io::holds_polygons(path);
    io::FileContent const content = has_rings ? io::FileContent{Kind::lines, path, ""} : io::content_of(path);
    refuse_if<BadInput>(content.kind != Kind::lines, "commands.run_tin", "{} holds no lines", path);
    bool const has_column = are == LinesAre::all && !params.height_column.empty();
    RiverLines rivers = io::read_rivers({.path = content.path,
                                         .layer = content.layer,
                                         .crs = crs,
                                         .height_field = has_column ? params.height_column : "",
                                         .rings = has_rings,
                                         .source_crs = params.source_crs},
                                        run);
    refuse_if<BadInput>(!have_any_heights(rivers, are), "commands.run_tin",
                        "the lines of {} have no heights (or all the same): a TIN takes lines with Z, such as layer "
                        "arcs of a network.gpkg{}",
                        content.path, are == LinesAre::all ? offered_columns(rivers.attributes) : "");
    Breaklines read{{}, rivers.crs};
    network::WithoutPlaceholders checked = network::without_placeholders(std::move(rivers));
    if (checked.vertices > 0) {
        read.findings.push_back(recipe::placeholder_finding(checked));
        run.report(read.findings);
    }
    rivers = network::with_all_heights(std::move(checked.lines), recipe::NetworkRecipe{}.slope);
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
    recipe::require_metres(dem.grid(), path, "commands.run_tin");
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

/// Whether a line closes around a place at one height, as the shore of a lake does.
bool is_lake_around(std::vector<Vec3> const& line, Vec2 place) {
    bool const is_ring = line.size() > 3 && in_plan(line.front()) == in_plan(line.back()) &&
                         std::ranges::all_of(line, [&](Vec3 const& v) { return v.z == line.front().z; });
    bool is_inside = false;
    for (std::size_t i = 1; is_ring && i < line.size(); ++i) {
        Vec2 const a = in_plan(line[i - 1]);
        Vec2 const b = in_plan(line[i]);
        if ((a.y > place.y) != (b.y > place.y) && place.x < a.x + (place.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
            is_inside = !is_inside;
        }
    }
    return is_inside;
}

/// Points for the level areas of contours, but not for lakes among the breaklines.
std::vector<Vec3> points_for_level_areas(Lines const& contours, Lines const& breaklines, Run const& run) {
    std::vector<Vec3> points = surface::medial_points(geometry::triangulate({}, contours, run), run);
    for (auto const& line : breaklines) {
        std::erase_if(points, [&](Vec3 const& p) { return is_lake_around(line, in_plan(p)); });
    }
    return points;
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
    made.flat = surface::level_share(made.tin);
    return made;
}

/// Refuses options of points for a DEM and lines.
void refuse_options_of_points(TinParams const& params, io::FileContent const& content) {
    if (content.kind == Kind::points) {
        return;
    }
    for (auto const& [option, to, given] : {std::tuple{"--duplicates", "points only", params.duplicates.has_value()},
                                            std::tuple{"--columns", "text with points", !params.columns.empty()},
                                            std::tuple{"--classes", "point clouds", !params.classes.empty()},
                                            std::tuple{"--thin", "point clouds", params.thin_m.has_value()}}) {
        if (given) {
            throw BadParameter("commands.run_tin",
                               fmt::format("{} applies to {}; {} holds {}", option, to, content.path,
                                           content.kind == Kind::raster ? "a DEM" : "lines"));
        }
    }
}

TinResult tin_of(TinParams const& params, Run const& run) {
    io::FileContent const content = io::content_of(params.path);
    refuse_options_of_points(params, content);
    if (content.kind == Kind::raster) {
        refuse_if<BadParameter>(!params.breaklines.empty() || !params.crs.empty() || !params.source_crs.empty() ||
                                    !params.height_column.empty() || params.medial_points,
                                "commands.run_tin",
                                "--breaklines, --height-column, --medial-points, --crs and --source-crs apply to "
                                "points and lines, not to a DEM");
        return of_dem(content.path, params, run);
    }
    for (auto const& [option, given] :
         {std::pair{"--error", params.error_m.has_value()},
          std::pair{"--band or --encoding",
                    !params.reading.band.empty() || params.reading.encoding != io::HeightEncoding::none}}) {
        if (given) {
            throw BadParameter("commands.run_tin",
                               fmt::format("{} applies to a DEM only; {} holds {}", option, content.path,
                                           content.kind == Kind::points ? "points" : "lines"));
        }
    }
    refuse_if<BadParameter>(params.medial_points && content.kind == Kind::points, "commands.run_tin",
                            "--medial-points applies to contours; {} holds points", content.path);
    refuse_if<BadParameter>(params.reading.nodata && content.kind == Kind::lines, "commands.run_tin",
                            "--nodata applies to a DEM or points; {} holds lines", content.path);
    if (content.kind == Kind::points) {
        FeaturePoints const points =
            io::read_points({.path = content.path,
                             .crs = params.crs,
                             .duplicates = params.duplicates.value_or(io::DuplicatePoints::averaged),
                             .height_column = params.height_column,
                             .nodata = params.reading.nodata,
                             .columns = params.columns,
                             .source_crs = params.source_crs,
                             .classes = params.classes,
                             .thin_m = params.thin_m},
                            run);
        run.report(points.findings);
        Breaklines breaklines{{}, points.crs};
        if (!params.breaklines.empty()) {
            breaklines = read_lines(params.breaklines, params, points.crs, LinesAre::more, run);
        }
        TinResult made = of_points(points.points, breaklines, "points", run);
        made.without_height = points.left_out;
        made.averaged = points.averaged;
        made.averaged_dz_m = points.averaged_dz_m;
        made.findings = points.findings;
        append(made.findings, std::move(breaklines.findings));
        return made;
    }
    Breaklines network = read_lines(content.path, params, params.crs, LinesAre::all, run);
    if (content.layer == "arcs" && io::has_layer(content.path, "ridges")) {
        RiverLines ridges = io::read_rivers(
            {.path = content.path, .layer = "ridges", .crs = network.crs, .source_crs = params.source_crs}, run);
        for (RiverLine& line : ridges.lines) {
            network.lines.push_back(std::move(line.vertices));
        }
    }
    std::vector<Vec3> points;
    Lines more;
    if (!params.breaklines.empty()) {
        Breaklines read = read_lines(params.breaklines, params, network.crs, LinesAre::more, run);
        more = std::move(read.lines);
        append(network.findings, std::move(read.findings));
    }
    if (params.medial_points) {
        points = points_for_level_areas(network.lines, more, run);
    }
    network.lines.insert(network.lines.end(), more.begin(), more.end());
    TinResult made = of_points(points, network, "network", run);
    made.findings = std::move(network.findings);
    made.medial = static_cast<std::int64_t>(points.size());
    return made;
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

} // namespace thalweg::commands
