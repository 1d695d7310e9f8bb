// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/forest_land.hpp>

#include <thalweg/blend/mask_polygons.hpp>
#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/gdal/sources.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/polygons.hpp>
#include <thalweg/network/growth/forest/plant_forest.hpp>
#include <thalweg/network/growth/forest/shape_island.hpp>
#include <thalweg/network/growth/forest/spread_outlets.hpp>
#include <thalweg/network/import/clip_lines.hpp>
#include <thalweg/pipeline/plan/frame.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace thalweg::pipeline {

namespace {

/// The land on its grid: the region's polygons, an island, or all of it.
Mask land_of(Recipe const& recipe, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    if (wanted.region.empty()) {
        Grid const grid = frame_tree(1, recipe.grid);
        return wanted.shape == LandShape::island ? network::shape_island(grid, {wanted.ruggedness, recipe.seed}, run)
                                                 : Mask(grid, 1);
    }
    Polygons const polygons = io::read_polygons(file_in(recipe, wanted.region), recipe.grid.crs, run);
    return blend::mask_polygons(polygons, frame_polygons(polygons, recipe.grid));
}

/// Which of some cells lie near marked ones.
std::vector<Cell> near_to(Mask const& marked, std::vector<Cell> const& cells, std::int64_t reach) {
    std::vector<Cell> found;
    for (Cell const c : cells) {
        bool near = false;
        cells_around(marked.grid(), c, reach, [&](Cell other) { near = near || marked[other] != 0; });
        if (near) {
            found.push_back(c);
        }
    }
    return found;
}

std::vector<Cell> spread(Recipe const& recipe, Mask const& land, std::vector<Cell> const& coast, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    constexpr std::int64_t spacings = 6;
    std::int64_t const every =
        wanted.outlet_spacing_cells > 0 ? wanted.outlet_spacing_cells : spacings * wanted.spacing_cells;
    return network::spread_outlets(land, coast, {wanted.seeds, static_cast<double>(every), recipe.seed}, run);
}

/// The cells of the coast nearest to the points of a file.
std::vector<Cell> at_points(Recipe const& recipe, Mask const& land, std::vector<Finding>& notes, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    Grid const& grid = land.grid();
    if (wanted.seeds > 0) {
        throw BadInput(
            fmt::format("network.forest.outlets = \"{}\" holds points, each an outlet; leave network.forest.seeds out",
                        wanted.outlets));
    }
    if (wanted.outlet_spacing_cells > 0 && recipe.set_at.contains("network.forest.outlet_spacing")) {
        throw BadInput(fmt::format("network.forest.outlets = \"{}\" holds points, each an outlet; leave "
                                   "network.forest.outlet_spacing out",
                                   wanted.outlets));
    }
    io::ReadPointsParams params;
    params.path = file_in(recipe, wanted.outlets);
    params.crs = grid.crs;
    params.heights = io::PointHeights::passed_over;
    std::vector<Cell> const coast = network::coast_cells(land);
    std::vector<Cell> outlets;
    for (Vec3 const& p : io::read_points(params, run).points) {
        run.check();
        Vec2 const at{p.x, p.y};
        auto const nearest = std::ranges::min_element(coast, {}, [&](Cell c) {
            Vec2 const there = grid.centre(c);
            return (there.x - at.x) * (there.x - at.x) + (there.y - at.y) * (there.y - at.y);
        });
        if (nearest == coast.end()) {
            return {}; // no land: that is told where the forest is planted
        }
        double const moved = distance(at, grid.centre(*nearest));
        if (moved > grid.cell_m) {
            notes.push_back({"moved_outlet", 0, grid.centre(*nearest), moved,
                             fmt::format("the outlet at ({:.1f}, {:.1f}) lies off the coast and was moved {:.0f} m to "
                                         "cell ({}, {})",
                                         at.x, at.y, moved, nearest->col, nearest->row)});
        }
        outlets.push_back(*nearest);
    }
    return outlets;
}

/// The coast along the lines of a file, or along its polygons, which become water.
std::vector<Cell> coast_along_file(Recipe const& recipe, Mask& land, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    Grid const& grid = land.grid();
    std::string const path = file_in(recipe, wanted.outlets);
    Mask marked;
    std::int64_t reach = 1;
    if (io::holds_polygons(path)) {
        marked = blend::mask_polygons(io::read_polygons(path, grid.crs, run), grid);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            land[i] = marked[i] != 0 ? 0 : land[i];
        }
    } else {
        RiverLines const lines = io::read_rivers({.path = path, .crs = grid.crs}, run);
        marked = cells_under(network::clip_lines(lines, grid), grid, wanted.outlets);
        reach = wanted.spacing_cells; // coasts are drawn in more or less detail
    }
    std::vector<Cell> coast = near_to(marked, network::coast_cells(land), reach);
    if (coast.empty()) {
        throw BadInput(fmt::format("network.forest.outlets: no coast of the land lies within {} cells of {}; give "
                                   "outlets on the coast, or the region whose coast they lie on",
                                   reach, wanted.outlets));
    }
    return coast;
}

std::vector<Cell> outlets_of(Recipe const& recipe, Mask& land, std::vector<Finding>& notes, Run const& run) {
    ForestRecipe const& wanted = recipe.network->forest;
    std::string const path = file_in(recipe, wanted.outlets);
    if (wanted.outlets.empty()) {
        std::vector<Cell> const coast = network::coast_cells(land);
        return coast.empty() ? coast : spread(recipe, land, coast, run);
    }
    bool const points = io::is_text_of_points(path) ||
                        (!io::holds_polygons(path) && io::content_of(path).kind == io::FileContent::Kind::points);
    return points ? at_points(recipe, land, notes, run)
                  : spread(recipe, land, coast_along_file(recipe, land, run), run);
}

} // namespace

Recipe on_crs_of_region(Recipe recipe) {
    std::string const& region = recipe.network->forest.region;
    std::string& crs = recipe.grid.crs;
    crs = !crs.empty()     ? io::projected_crs(crs)
          : region.empty() ? io::projected_crs("EPSG:32631")
                           : io::crs_for_polygons(file_in(recipe, region));
    return recipe;
}

ForestLand forest_land(Recipe const& recipe, Diary& diary, Run const& run) {
    ForestLand found;
    found.land = diary.stage("shape", [&] { return land_of(recipe, run); });
    found.outlets = outlets_of(recipe, found.land, found.notes, run);
    found.has_sea = std::ranges::any_of(found.land.values(), [](std::uint8_t v) { return v == 0; });
    return found;
}

} // namespace thalweg::pipeline
