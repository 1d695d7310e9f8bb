// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/frame.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/run/memory.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::recipe {
namespace {

struct Box {
    double west = std::numeric_limits<double>::infinity();
    double south = std::numeric_limits<double>::infinity();
    double east = -std::numeric_limits<double>::infinity();
    double north = -std::numeric_limits<double>::infinity();
};

void enlarge(Box& box, double x, double y) {
    box.west = std::min(box.west, x);
    box.east = std::max(box.east, x);
    box.south = std::min(box.south, y);
    box.north = std::max(box.north, y);
}

Box box_of(RiverLines const& lines) {
    Box box;
    for (RiverLine const& line : lines.lines) {
        for (Vec3 const& p : line.vertices) {
            enlarge(box, p.x, p.y);
        }
    }
    return box;
}

Box box_of(Polygons const& polygons) {
    Box box;
    for (Polygon const& polygon : polygons.polygons) {
        for (auto const& ring : polygon.rings) {
            for (Vec2 const p : ring) {
                enlarge(box, p.x, p.y);
            }
        }
    }
    return box;
}

/// The requested grid, or a box and 5 % around it on multiples of the cell. what: "the rivers of walker.gpkg".
Grid frame_box(Box const& box, GridRecipe const& wanted, char const* where, std::string const& what) {
    double const cell = wanted.cell_m;
    auto const snapped_down = [cell](double v) { return std::floor(v / cell) * cell; };
    double const margin = std::max(0.05 * std::max(box.east - box.west, box.north - box.south), 2.0 * cell);

    Grid grid;
    grid.cell_m = cell;
    grid.crs = wanted.crs;
    if (wanted.width > 0) {
        grid.width = wanted.width;
        grid.height = wanted.height;
        grid.west = snapped_down((box.west + box.east - static_cast<double>(grid.width) * cell) / 2.0 + cell / 2.0);
        grid.north = snapped_down((box.south + box.north + static_cast<double>(grid.height) * cell) / 2.0 + cell / 2.0);
    } else {
        grid.west = snapped_down(box.west - margin);
        grid.north = snapped_down(box.north + margin) + cell;
    }
    if (wanted.origin) {
        grid.west = (*wanted.origin)[0];
        grid.north = (*wanted.origin)[1];
    }
    if (wanted.width == 0) {
        double const width = std::ceil((box.east + margin - grid.west) / cell);
        double const height = std::ceil((grid.north - (box.south - margin)) / cell);
        refuse_if<BadInput>(!(width >= 1.0 && height >= 1.0), where,
                            "grid.origin = [{}, {}] lies beyond {} (west {:.0f}, north {:.0f})", grid.west, grid.north,
                            what, box.west, box.north);
        refuse_if<BadInput>(width > 1e6 || height > 1e6, where,
                            "grid: {} span {:.0f} x {:.0f} cells of {} m: give a larger grid.cell", what, width, height,
                            cell);
        grid.width = static_cast<std::int64_t>(width);
        grid.height = static_cast<std::int64_t>(height);
    }
    check_memory(grid.width, grid.height);
    return grid;
}

/// Throws BadInput if a position lies outside the grid. what: "river 7 in walker.gpkg".
void require_inside(Grid const& grid, double x, double y, char const* where, std::string const& what) {
    refuse_if<BadInput>(!(x >= grid.west && x <= grid.east() && y >= grid.south() && y <= grid.north), where,
                        "grid: {} runs outside the grid at ({:.1f}, {:.1f}): the grid spans {:.1f} to {:.1f} east and "
                        "{:.1f} to {:.1f} north. Enlarge it, leave width and height out, or set grid.clip = true.",
                        what, x, y, grid.west, grid.east(), grid.south(), grid.north);
}

/// Throws BadInput if this much memory is not free.
void require(char const* where, std::string const& what, std::int64_t bytes, char const* advice) {
    if (std::int64_t const free = free_memory_bytes(); bytes > free) {
        throw BadInput(where, fmt::format("{} need {:.1f} GB; {:.1f} GB are free. {}", what,
                                          static_cast<double>(bytes) / 1e9, static_cast<double>(free) / 1e9, advice));
    }
}

struct Vertex {
    double along = 0.0; ///< its coordinate on the current axis
    Vec3 at;
    std::int64_t feature = 0;
};

[[noreturn]] void refuse(Vertex const& stray, double gap_m, RiverLines const& lines) {
    throw BadInput(
        "recipe.require_no_stray_vertex",
        fmt::format("grid: river {} in {} has a vertex at ({:.1f}, {:.1f}), {:.0f} km from the others, so that "
                    "a grid around all would be empty for the most part: correct it, or set grid.width, "
                    "grid.height and grid.clip = true",
                    stray.feature, lines.name, stray.at.x, stray.at.y, gap_m / 1000.0));
}

/// Scans sorted vertices from the beginning.
void look(std::vector<Vertex> const& sorted, RiverLines const& lines) {
    constexpr double times_as_far = 20.0;
    std::size_t const few = std::max<std::size_t>(2, sorted.size() / 100);
    for (std::size_t k = 1; k <= few; ++k) {
        double const gap = std::fabs(sorted[k].along - sorted[k - 1].along);
        double const others = std::fabs(sorted.back().along - sorted[k].along);
        if (others > 0.0 && gap > times_as_far * others) {
            refuse(sorted[k - 1], gap, lines);
        }
    }
}

} // namespace

void check_memory(std::int64_t width, std::int64_t height) {
    constexpr std::int64_t least_a_cell = 10; // DEM 4, areas 4, directions 1, lakes 1
    require_free(width * height * least_a_cell, width, height);
}

void require_free(std::int64_t bytes, std::int64_t width, std::int64_t height) {
    require("recipe.require_free", fmt::format("grid: {}x{} cells", width, height), bytes,
            "Make grid.width and grid.height smaller or grid.cell larger.");
}

void check_memory_of_cluster(std::int64_t particles) {
    // 41 at S = M = 1, 62 at S = 0.85, M = 3: cell 16, and the fields around it, or its parent 8 and register 16
    constexpr std::int64_t bytes_a_particle = 60;
    require("recipe.check_memory_of_cluster", fmt::format("[network.dla]: {} particles", particles),
            particles * bytes_a_particle, "Make network.dla.particles smaller.");
}

std::int64_t room_for_network(std::int64_t side_cells) {
    return std::max<std::int64_t>(1, side_cells * 10 / 11);
}

std::int64_t margin_around(std::int64_t side_cells) {
    return std::max<std::int64_t>(2, (side_cells + 19) / 20);
}

FramedBranch frame_branch(growth::Branch const& branch, GridRecipe const& wanted) {
    Cell low = branch.cells.front();
    Cell high = low;
    for (Cell const& c : branch.cells) {
        low = {std::min(low.col, c.col), std::min(low.row, c.row)};
        high = {std::max(high.col, c.col), std::max(high.row, c.row)};
    }
    std::int64_t const box_width = high.col - low.col + 1;
    std::int64_t const box_height = high.row - low.row + 1;
    std::int64_t const margin = margin_around(std::max(box_width, box_height));

    Grid grid;
    grid.width = wanted.width > 0 ? wanted.width : box_width + 2 * margin;
    grid.height = wanted.height > 0 ? wanted.height : box_height + 2 * margin;
    grid.cell_m = wanted.cell_m;
    grid.west = wanted.origin ? (*wanted.origin)[0] : default_west;
    grid.north = wanted.origin ? (*wanted.origin)[1] : default_north;
    grid.crs = wanted.crs;
    check_memory(grid.width, grid.height);

    std::int64_t const right = (grid.width - box_width) / 2 - low.col;
    std::int64_t const down = (grid.height - box_height) / 2 - low.row;
    FramedBranch framed{Mask(grid), grid.centre({right, down})};
    for (Cell const& c : branch.cells) {
        framed.mask[Cell{c.col + right, c.row + down}] = 1;
    }
    return framed;
}

Grid frame_lines(RiverLines const& lines, GridRecipe const& wanted) {
    GridRecipe here = wanted;
    here.crs = lines.crs;
    if (wanted.width == 0) {
        require_no_stray_vertex(lines);
    }
    Grid const grid = frame_box(box_of(lines), here, "recipe.frame_lines", "the rivers of " + lines.name);
    if (!wanted.clip) {
        for (RiverLine const& line : lines.lines) {
            for (Vec3 const& p : line.vertices) {
                require_inside(grid, p.x, p.y, "recipe.frame_lines",
                               fmt::format("river {} in {}", line.feature, lines.name));
            }
        }
    }
    return grid;
}

Grid frame_polygons(Polygons const& polygons, GridRecipe const& wanted) {
    Grid const grid = frame_box(box_of(polygons), wanted, "recipe.frame_polygons", "the polygons of " + polygons.name);
    if (wanted.clip) {
        return grid;
    }
    for (Polygon const& polygon : polygons.polygons) {
        for (auto const& ring : polygon.rings) {
            for (Vec2 const p : ring) {
                require_inside(grid, p.x, p.y, "recipe.frame_polygons",
                               fmt::format("polygon {} in {}", polygon.feature, polygons.name));
            }
        }
    }
    return grid;
}

Grid frame_tree(std::int64_t links, GridRecipe const& wanted) {
    constexpr double link_cells = 12.0;
    constexpr double share = 0.96; // share of the grid's side that the network fills
    auto const side = static_cast<std::int64_t>(std::ceil(link_cells * std::sqrt(static_cast<double>(links)) / share));
    Grid grid;
    grid.width = wanted.width > 0 ? wanted.width : side;
    grid.height = wanted.height > 0 ? wanted.height : side;
    grid.cell_m = wanted.cell_m;
    grid.west = wanted.origin ? (*wanted.origin)[0] : default_west;
    grid.north = wanted.origin ? (*wanted.origin)[1] : default_north;
    grid.crs = wanted.crs;
    check_memory(grid.width, grid.height);
    return grid;
}

void require_no_stray_vertex(RiverLines const& lines) {
    constexpr std::size_t fewest = 20;
    for (double Vec3::*const axis : {&Vec3::x, &Vec3::y}) {
        std::vector<Vertex> vertices;
        for (RiverLine const& line : lines.lines) {
            for (Vec3 const& v : line.vertices) {
                vertices.push_back({v.*axis, v, line.feature});
            }
        }
        if (vertices.size() < fewest) {
            return;
        }
        std::stable_sort(vertices.begin(), vertices.end(),
                         [](Vertex const& a, Vertex const& b) { return a.along < b.along; });
        look(vertices, lines);
        std::reverse(vertices.begin(), vertices.end());
        look(vertices, lines);
    }
}

namespace {

/// Throws BadInput naming the first point off the grid. name: the file, as in the recipe.
void require_on_grid(FeaturePoints const& points, Grid const& grid, std::string const& name) {
    for (std::size_t i = 0; i < points.points.size(); ++i) {
        Vec3 const& p = points.points[i];
        refuse_if<BadInput>(p.x < grid.west || p.x > grid.east() || p.y < grid.south() || p.y > grid.north,
                            "recipe.require_skeleton_on_grid",
                            "skeleton.points = \"{}\": point {} at ({:.3f}, {:.3f}) lies off the grid, which reaches "
                            "from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}); widen the grid or remove it",
                            name, i + 1, p.x, p.y, grid.west, grid.south(), grid.east(), grid.north);
    }
}

} // namespace

void require_skeleton_on_grid(Recipe const& recipe, FeaturePoints const& points, RiverLines const& ridges,
                              Grid const& grid) {
    if (!recipe.skeleton) {
        return;
    }
    require_on_grid(points, grid, recipe.skeleton->points);
    for (RiverLine const& ridge : ridges.lines) {
        for (Vec3 const& p : ridge.vertices) {
            refuse_if<BadInput>(p.x < grid.west || p.x > grid.east() || p.y < grid.south() || p.y > grid.north,
                                "recipe.require_skeleton_on_grid",
                                "skeleton.ridge_lines = \"{}\": feature {} reaches ({:.3f}, {:.3f}), off the grid, "
                                "which reaches from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}); widen the grid or cut the "
                                "line",
                                recipe.skeleton->ridge_lines, ridge.feature, p.x, p.y, grid.west, grid.south(),
                                grid.east(), grid.north);
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
            refuse_if<BadInput>(!(columns < 1e6) || !(rows < 1e6), "recipe.frame_land",
                                "grid: the points span {:.0f} x {:.0f} m, {:.3g} x {:.3g} cells of {} m: give a larger "
                                "grid.cell or a grid",
                                east - west, north - south, columns, rows, cell);
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

} // namespace thalweg::recipe
