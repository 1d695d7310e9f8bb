// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/internal/between_rivers.hpp>

#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

namespace thalweg::make {
namespace {

std::vector<Vec3> in_space(std::vector<Vec2> const& line, std::vector<double> const& z) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < line.size(); ++i) {
        out.push_back({line[i].x, line[i].y, z[i]});
    }
    return out;
}

/// Random points between the rivers.
skeleton::ScatteredPoints scattered(recipe::Recipe const& recipe, ValleyCells const& valley, Mask const& inside,
                                    StageLog& stage_log, Run const& run) {
    recipe::SkeletonRecipe const& wanted = *recipe.skeleton;
    skeleton::ScatterBetweenParams params;
    params.seed = recipe.seed;
    params.count = wanted.scatter;
    params.spacing_cells = wanted.spacing_cells;
    params.gain = wanted.ridge_gain;
    params.farthest_m = wanted.ridge_farthest_m;
    params.law = wanted.law;
    skeleton::ScatteredPoints points = stage_log.stage(
        recipe::stage::scatter.name, [&] { return skeleton::scatter_between({valley.raster()}, inside, params, run); });
    stage_log.say(fmt::format("{} points", points.points.points.size()));
    return points;
}

/// The cells of the terrain: those of the recipe's mask, or all; without the sea.
Mask inside_of(recipe::Recipe const& recipe, Mask const& land, ValleyCells const& valley, Run const& run) {
    if (recipe.surface->mask.empty()) {
        return land.values().empty() ? Mask(valley.grid, 1) : land;
    }
    Grid const& grid = valley.grid;
    Mask inside = recipe::read_mask_of_land(recipe::file_in(recipe, recipe.surface->mask), grid, run);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        inside[i] = inside[i] != 0 && (land.values().empty() || land[i] != 0) ? 1 : 0;
    }
    for (CellIndex const cell : valley.cell) {
        if (inside[cell] == 0) {
            Cell const c = grid.at(cell);
            Vec2 const at = grid.centre(c);
            throw BadInput("make.make_terrain",
                           fmt::format("surface.mask = \"{}\" leaves out cell ({}, {}) at ({:.1f}, {:.1f}), where a "
                                       "river runs",
                                       recipe.surface->mask, c.col, c.row, at.x, at.y));
        }
    }
    return inside;
}

} // namespace

RidgeLines ridges_between(GroundInput const& in, Rivers const& rivers, StageLog& stage_log, Run const& run) {
    if (!recipe::stage::ridge.runs(in.recipe)) {
        return {};
    }
    recipe::SkeletonRecipe const& wanted = *in.recipe.skeleton;
    skeleton::RidgesParams params;
    params.method = wanted.ridges == recipe::Ridges::voronoi ? skeleton::RidgesParams::Method::voronoi
                                                             : skeleton::RidgesParams::Method::segments;
    params.gain = wanted.ridge_gain;
    params.farthest_m = wanted.ridge_farthest_m;
    RidgeLines ridges = stage_log.stage(recipe::stage::ridge.name, [&] {
        return skeleton::ridges(rivers.network, network::streams(rivers.network.planform, rivers.orders), in.grid,
                                params, run);
    });
    stage_log.say(fmt::format("{} ridges", ridges.lines.size()));
    return ridges;
}

Tin triangulated(recipe::Recipe const& recipe, ElevatedNetwork const& network, RidgeLines const& ridges,
                 FeaturePoints const& points, StageLog& stage_log, Run const& run) {
    if (!recipe::stage::tin.runs(recipe)) {
        return {};
    }
    std::vector<std::vector<Vec3>> breaklines;
    for (ArcId a = 0; a < network.planform.arc_count(); ++a) {
        breaklines.push_back(in_space(network.planform.arc(a).line, network.arc_z[a]));
    }
    for (RidgeLine const& ridge : ridges.lines) {
        breaklines.push_back(ridge.line);
    }
    Tin tin = stage_log.stage(recipe::stage::tin.name,
                              [&] { return geometry::triangulate(points.points, breaklines, run).tin; });
    stage_log.say(fmt::format("{} triangles of {} vertices", tin.triangles.size(), tin.vertices.size()));
    return tin;
}

RidgeLines joined(RidgeLines some, RidgeLines const& others) {
    append(some.lines, others.lines);
    return some;
}

Raster<float> with_valley(Raster<float> dem, ValleyCells const& valley) {
    for (std::size_t i = 0; i < valley.cell.size(); ++i) {
        dem[valley.cell[i]] = valley.z[i];
    }
    return dem;
}

Raster<float> over_triangles(Between const& between, Run const& run) {
    return with_valley(
        surface::rasterise_tin(between.tin, between.valley.grid, {surface::RasteriseTinParams::Outside::nearest}, run),
        between.valley);
}

Raster<float> only_inside(Raster<float> dem, Mask const& inside) {
    for (std::int64_t i = 0; i < inside.cells(); ++i) {
        dem[i] = inside[i] != 0 ? dem[i] : std::numeric_limits<float>::quiet_NaN();
    }
    return dem;
}

Check points_missing(skeleton::ScatteredPoints const& points, recipe::SkeletonRecipe const& wanted,
                     StageLog& stage_log) {
    if (points.density > skeleton::darts_density) {
        stage_log.find({.kind = "close_points",
                        .amount = points.density,
                        .text = fmt::format("{} points {} cells apart have a density of {:.3f}, about as dense as "
                                            "points at random can stand (0.7)",
                                            wanted.scatter, wanted.spacing_cells, points.density),
                        .key = "skeleton.spacing"});
    }
    if (points.missing > 0) {
        stage_log.find({.kind = "points_without_room",
                        .amount = static_cast<double>(points.missing),
                        .text = fmt::format("{} of {} points found no room", points.missing, wanted.scatter),
                        .remedy = "A smaller skeleton.spacing or skeleton.scatter leaves them some",
                        .key = "skeleton.scatter",
                        .numbers = {{"points", static_cast<double>(wanted.scatter)}}});
    }
    return {"points_missing", static_cast<double>(points.missing), 0.0, points.missing == 0};
}

Between between_rivers(GroundInput const& in, StageLog& stage_log, Run const& run) {
    recipe::Recipe const& recipe = in.recipe;
    Between between{.rivers = rivers_of(in.rivers.network, in.planform.types, in.planform.file.clues),
                    .valley = in.rivers.valley};
    stage_log.find(in.rivers.findings);
    between.inside = inside_of(recipe, in.planform.land, between.valley, run);
    between.is_whole = recipe.surface->mask.empty() && in.planform.land.values().empty();
    if (recipe::stage::scatter.runs(recipe)) {
        skeleton::ScatteredPoints found = scattered(recipe, between.valley, between.inside, stage_log, run);
        between.checks.push_back(points_missing(found, *recipe.skeleton, stage_log));
        between.points = std::move(found.points);
    }
    between.ridges = ridges_between(in, between.rivers, stage_log, run);
    if (!in.ridges.lines.empty()) {
        between.given = skeleton::ridges_with_heights(
            in.ridges, {between.valley.raster()},
            {.gain = recipe.skeleton->ridge_gain, .farthest_m = recipe.skeleton->ridge_farthest_m}, run);
    }
    append(between.points.points, in.points.points);
    between.tin = triangulated(recipe, between.rivers.network, joined(between.ridges, between.given), between.points,
                               stage_log, run);
    between.through = in.points;
    append(between.through.points, skeleton::as_points(between.given, in.grid).points);
    append(between.points.points, skeleton::as_points(between.given, in.grid).points);
    return between;
}

Surface surface_between(GroundInput const& in, Between between, Raster<float> dem, HowMade how,
                        std::vector<Check> const& checks, StageLog& stage_log) {
    append(between.checks, checks);
    return {.ground = {.dem = std::move(dem),
                       .how = std::move(how),
                       .ridges = joined(std::move(between.ridges), between.given),
                       .tin = std::move(between.tin)},
            .rivers = std::move(between.rivers),
            .bed = {.valley = std::move(between.valley),
                    .channels = in.rivers.channels,
                    .lakes = in.rivers.lakes,
                    .heights = in.rivers.statistics},
            .notes = {std::move(between.checks), stage_log.take_findings(), stage_log.take()}};
}

} // namespace thalweg::make
