// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/around_rivers.hpp>

#include <thalweg/core/elementary.hpp>
#include <thalweg/core/error.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/raster_files.hpp>
#include <thalweg/pipeline/land.hpp>
#include <thalweg/pipeline/recipe_files.hpp>
#include <thalweg/surface/rasterise_tin.hpp>

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// The triangles of points and rivers, whose arcs are breaklines.
void make_skeleton_tin(Terrain& terrain, FeaturePoints const& points, Diary& diary, Run const& run) {
    std::vector<std::vector<Vec3>> breaklines;
    std::size_t number = 0;
    for (auto const& arc : boost::make_iterator_range(boost::edges(terrain.network.plan))) {
        std::vector<Vec2> const& line = terrain.network.plan[arc].line;
        std::vector<double> const& z = terrain.network.arc_z[number++];
        std::vector<Vec3> breakline;
        for (std::size_t i = 0; i < line.size(); ++i) {
            breakline.push_back({line[i].x, line[i].y, z[i]});
        }
        breaklines.push_back(std::move(breakline));
    }
    terrain.tin = diary.stage("tin", [&] { return geometry::triangulate(points.points, breaklines, run).tin; });
    diary.say(fmt::format("{} triangles of {} vertices", terrain.tin->triangles.size(), terrain.tin->vertices.size()));
}

/// Land over the skeleton's triangles: as it is, or as the base that slopes rise from. Valley cells keep their heights.
surface::Dilated draw_over_tin(Terrain const& terrain, Run const& run) {
    SurfaceRecipe const& wanted = *terrain.recipe.surface;
    surface::Dilated drawn;
    if (wanted.method == Method::dilate) {
        Valley level = terrain.valley;
        for (float& z : level.z.values()) {
            z = std::isnan(z) ? z : 0.0F;
        }
        drawn = surface::dilate(level, wanted.dilate, run);
    }
    Raster<float> base =
        surface::rasterise_tin(*terrain.tin, terrain.grid, {surface::RasteriseTinParams::Outside::nearest}, run);
    for (std::int64_t i = 0; i < base.cells(); ++i) {
        if (!std::isnan(terrain.valley.z[i])) {
            base[i] = terrain.valley.z[i];
        } else if (wanted.method == Method::dilate) {
            base[i] += drawn.dem[i];
        }
    }
    drawn.dem = std::move(base);
    return drawn;
}

Mask read_inside(Recipe const& recipe, Valley const& valley) {
    Raster<float> const given = io::read_dem(file_in(recipe, recipe.surface->mask));
    Grid const& grid = valley.z.grid();
    if (given.width() != grid.width || given.height() != grid.height) {
        throw BadInput(fmt::format("surface.mask: {} has {}x{} cells, the grid {}x{}", recipe.surface->mask,
                                   given.width(), given.height(), grid.width, grid.height));
    }
    Mask inside(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        inside[i] = !std::isnan(given[i]) && given[i] != 0.0F;
        if (inside[i] == 0 && !std::isnan(valley.z[i])) {
            Cell const c = grid.at(i);
            throw BadInput(fmt::format("surface.mask: {} leaves out cell ({}, {}), where a river runs",
                                       recipe.surface->mask, c.col, c.row));
        }
    }
    return inside;
}

surface::Dilated draw_surface(Recipe const& recipe, Valley const& valley, Run const& run) {
    surface::DilateParams const& params = recipe.surface->dilate;
    return recipe.surface->mask.empty() ? surface::dilate(valley, params, run)
                                        : surface::dilate(valley, read_inside(recipe, valley), params, run);
}

/// Adds fractal detail to land with rivers: none in the valleys, all of it some cells away.
void add_detail(Terrain const& terrain, Raster<float>& dem, Run const& run) {
    constexpr double near_cells = 8.0; // within which detail grows from nothing to two thirds
    if (levels_of(terrain.recipe) == 0) {
        return;
    }
    Raster<float> const noise = detail_alone(terrain.recipe, terrain.grid, run);
    surface::Expansion const expansion = surface::expand(terrain.valley, run);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        double const share = 1.0 - exact::exp(-static_cast<double>(expansion.level[i]) / near_cells);
        dem[i] = static_cast<float>(static_cast<double>(dem[i]) + share * static_cast<double>(noise[i]));
    }
}

} // namespace

void draw_around_rivers(Terrain& terrain, FeaturePoints const& points, Diary& diary, Run const& run) {
    Recipe const& recipe = terrain.recipe;
    SurfaceRecipe const& wanted = *recipe.surface;
    bool const over_tin = wanted.method == Method::tin || wanted.base == Base::tin;
    if (over_tin || (recipe.skeleton && recipe.skeleton->tin)) {
        make_skeleton_tin(terrain, points, diary, run);
    }
    terrain.surface = diary.stage(
        "fill", [&] { return over_tin ? draw_over_tin(terrain, run) : draw_surface(recipe, terrain.valley, run); });
    bool const dilated = wanted.method == Method::dilate;
    diary.say(fmt::format("{}x{}, {}", terrain.grid.width, terrain.grid.height,
                          dilated
                              ? fmt::format("{}, {} levels", wanted.dilate.increment.increment, terrain.surface->levels)
                              : std::string("over triangles")));
    add_detail(terrain, terrain.surface->dem, run);
}

} // namespace thalweg::pipeline
