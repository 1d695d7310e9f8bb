// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/frame.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/pipeline/plan/frame.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::pipeline {

FeaturePoints given_points(Recipe const& recipe, Run const& run) {
    FeaturePoints points;
    std::string const crs = recipe.grid.crs.empty() ? "" : io::projected_crs(recipe.grid.crs);
    if (recipe.skeleton && !recipe.skeleton->points.empty()) {
        std::string const& name = recipe.skeleton->points;
        std::string const path = file_in(recipe, name);
        points = io::read_points({.path = path, .crs = crs}, run);
    }
    if (points.crs.empty()) {
        points.crs = io::projected_crs(crs.empty() ? "EPSG:32631" : crs);
    }
    return points;
}

void require_on_grid(FeaturePoints const& points, Grid const& grid, std::string const& name) {
    for (std::size_t i = 0; i < points.points.size(); ++i) {
        Vec3 const& p = points.points[i];
        if (p.x < grid.west || p.x > grid.east() || p.y < grid.south() || p.y > grid.north) {
            throw BadInput(
                fmt::format("skeleton.points = \"{}\": point {} at ({:.3f}, {:.3f}) lies off the grid, which "
                            "reaches from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}); widen the grid or remove it",
                            name, i + 1, p.x, p.y, grid.west, grid.south(), grid.east(), grid.north));
        }
    }
}

Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted) {
    double const cell = wanted.cell_m;
    Grid grid{wanted.width, wanted.height, cell, default_west, default_north, wanted.crs};
    if (!points.points.empty()) {
        double west = std::numeric_limits<double>::infinity();
        double south = west;
        double east = -west;
        double north = -west;
        for (Vec3 const& p : points.points) {
            west = std::min(west, p.x);
            east = std::max(east, p.x);
            south = std::min(south, p.y);
            north = std::max(north, p.y);
        }
        double const margin = wanted.width > 0 ? 0.0 : 0.05 * std::max(east - west, north - south);
        grid.west = std::floor((west - margin) / cell) * cell;
        grid.north = std::ceil((north + margin) / cell) * cell;
        if (wanted.width == 0) {
            double const columns = std::ceil((east + margin - grid.west) / cell);
            double const rows = std::ceil((grid.north - south + margin) / cell);
            if (!(columns < 1e6) || !(rows < 1e6)) {
                throw BadInput(fmt::format("grid: the points span {:.0f} x {:.0f} m, {:.3g} x {:.3g} cells of {} m: "
                                           "give a larger grid.cell or a grid",
                                           east - west, north - south, columns, rows, cell));
            }
            grid.width = std::max<std::int64_t>(1, static_cast<std::int64_t>(columns));
            grid.height = std::max<std::int64_t>(1, static_cast<std::int64_t>(rows));
        }
    }
    if (wanted.origin) {
        grid.west = (*wanted.origin)[0];
        grid.north = (*wanted.origin)[1];
    }
    check_memory(grid.width, grid.height);
    return grid;
}

} // namespace thalweg::pipeline
