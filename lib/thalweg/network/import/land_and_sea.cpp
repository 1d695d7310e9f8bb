// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/land_and_sea.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/geometry/segment_grid.hpp>
#include <thalweg/network/import/prepare_lines.hpp>

namespace thalweg::network {

namespace {

constexpr std::int64_t mouth_cells = 12; ///< before an outlet, where the sea begins
constexpr double heading_cells = 8.0;    ///< length over which a river's end determines its heading
constexpr std::int64_t near_cells = 8;   ///< distance up to which a coastline determines the side of a cell

std::vector<Vec2> plan_of(RiverLine const& line) {
    std::vector<Vec2> out;
    out.reserve(line.vertices.size());
    for (Vec3 const& v : line.vertices) {
        out.push_back(in_plan(v));
    }
    return out;
}

/// The side of the nearest coastline on which cells lie.
class CoastSides {
public:
    CoastSides(RiverLines const& coastlines, Grid const& grid) : side_(grid) {
        for (RiverLine const& line : coastlines.lines) {
            for (std::size_t i = 1; i < line.vertices.size(); ++i) {
                add({in_plan(line.vertices[i - 1]), in_plan(line.vertices[i])});
            }
        }
    }

    /// 1: left, -1: right, 0: far from every coastline.
    int operator[](Cell c) const { return side_[c]; }

private:
    void add(geometry::Segment const& s) {
        if (s.a == s.b) {
            return;
        }
        Grid const& grid = side_.grid();
        double const reach_m = static_cast<double>(near_cells) * grid.cell_m;
        Cell last{-1, -1};
        for (Cell const at : cells_along({s.a, s.b}, grid)) {
            if (last.col < 0 || std::max(std::abs(at.col - last.col), std::abs(at.row - last.row)) >= near_cells / 2) {
                last = at;
                cells_around(grid, at, near_cells + near_cells / 2, [&](Cell c) { ask(s, c, reach_m * reach_m); });
            }
        }
    }

    /// If two segments meet at the point nearest to a cell, the one with the larger perpendicular distance decides.
    void ask(geometry::Segment const& s, Cell c, double reach_m2) {
        Grid const& grid = side_.grid();
        Vec2 const p = grid.centre(c);
        double const square = geometry::squared_distance(p, s);
        if (square > reach_m2) {
            return;
        }
        double const tie = 1e-6 * grid.cell_m * grid.cell_m;
        double const turn = cross(s.a, s.b, p) / distance(s.a, s.b);
        auto const [known, is_new] = nearest_.try_emplace(grid.index(c), Nearest{square, 0.0});
        Nearest& nearest = known->second;
        if (is_new || square < nearest.squared_m - tie ||
            (square <= nearest.squared_m + tie && std::fabs(turn) > nearest.aside_m)) {
            nearest = {std::min(square, nearest.squared_m), std::fabs(turn)};
            side_[c] = turn < 0.0 ? -1 : 1;
        }
    }

    struct Nearest {
        double squared_m;
        double aside_m; ///< perpendicular distance from the segment's line
    };
    Raster<std::int8_t> side_;
    std::unordered_map<std::int64_t, Nearest> nearest_; ///< only looked up, never iterated
};

/// Calls visit(begin, end, side) for the stretches of a line's cells that cross no coastline; side: the side of a
/// stretch; 0: it is near none.
template <class Visit> void each_stretch(std::vector<Cell> const& cells, CoastSides const& sides, Visit const& visit) {
    std::size_t begin = 0;
    int side = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        int const here = sides[cells[i]];
        if (here != 0 && side != 0 && here != side) {
            visit(begin, i, side);
            begin = i;
        }
        side = here != 0 ? here : side;
    }
    visit(begin, cells.size(), side);
}

/// The point on a line at a distance before its downstream end, or its upstream end.
Vec2 before_end(std::vector<Vec2> const& line, double distance_m) {
    std::size_t i = line.size() - 1;
    while (i > 0 && distance(line[i], line.back()) < distance_m) {
        --i;
    }
    return line[i];
}

} // namespace

LandAndSea land_and_sea(RiverLines const& coastlines, RiverLines const& rivers, Grid const& grid, Run const& run) {
    LandAndSea divided;
    CoastSides const sides(clip_lines(coastlines, grid), grid);
    std::vector<std::vector<Cell>> paths;
    for (RiverLine const& line : clip_lines(rivers, grid).lines) {
        run.check();
        paths.push_back(cells_along(plan_of(line), grid, "a river"));
    }
    std::int64_t left = 0;
    std::int64_t right = 0;
    for (std::vector<Cell> const& path : paths) {
        left += std::count_if(path.begin(), path.end(), [&](Cell c) { return sides[c] > 0; });
        right += std::count_if(path.begin(), path.end(), [&](Cell c) { return sides[c] < 0; });
    }
    int const seaward = left >= right ? -1 : 1;
    divided.behind = std::max(left, right);
    divided.beyond = std::min(left, right);

    Mask decided(grid);
    Mask land(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        int const side = sides[grid.at(i)];
        decided[i] = side != 0 ? 1 : 0;
        land[i] = side == -seaward ? 1 : 0;
    }
    for (std::vector<Cell> const& path : paths) {
        each_stretch(path, sides, [&](std::size_t begin, std::size_t end, int side) {
            for (std::size_t i = begin; side != seaward && i < end; ++i) {
                decided[path[i]] = 1;
                land[path[i]] = 1;
            }
        });
    }
    if (std::find(decided.values().begin(), decided.values().end(), 1) == decided.values().end()) {
        return divided;
    }
    Raster<std::int64_t> const nearest = nearest_cells(decided, run);
    Mask spread(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        spread[i] = land[nearest[i]];
        divided.sea_cells += spread[i] == 0 ? 1 : 0;
    }
    if (divided.sea_cells > 0) {
        divided.land = std::move(spread);
    }
    return divided;
}

Mask land_behind_outlets(StreamNetwork const& network, Grid const& grid, Run const& run) {
    Mask rivers(grid);
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        for (Cell const c : cells_along(network.arc(arc).line, grid, "a river")) {
            rivers[c] = 1;
        }
    }
    Mask decided = rivers;
    Raster<std::int64_t> nearest = nearest_cells(rivers, run);
    bool has_sea = false;
    for (NodeId const outlet : network.outlets()) {
        Cell const end = cells_along({network.node(outlet).at}, grid).front();
        if (grid.on_border(end) || network.in(outlet).empty()) {
            continue;
        }
        ArcId const last = network.in(outlet).front();
        Vec2 const from = before_end(network.arc(last).line, heading_cells * grid.cell_m);
        Vec2 const at = network.node(outlet).at;
        cells_around(grid, end, mouth_cells, [&](Cell c) {
            Vec2 const p = grid.centre(c);
            double const ahead = (p.x - at.x) * (at.x - from.x) + (p.y - at.y) * (at.y - from.y);
            bool const is_before = ahead > 0.35 * distance(p, at) * distance(at, from);
            if (rivers[c] == 0 && nearest[c] == grid.index(end) && is_before &&
                squared_cells(c, end) <= mouth_cells * mouth_cells) {
                decided[c] = 1;
                has_sea = true;
            }
        });
    }
    if (!has_sea) {
        return {};
    }
    nearest = nearest_cells(decided, run);
    Mask land(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        land[i] = rivers[nearest[i]];
    }
    return land;
}

Mask land_along_rivers(Mask land, StreamNetwork const& network) {
    Grid const grid = land.grid();
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        bool const ends = network.out_arcs(network.to(arc)).empty();
        std::vector<Cell> const cells = cells_along(network.arc(arc).line, grid, "a river");
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (ends && i + 1 == cells.size()) {
                land[cells[i]] = 1;
            } else {
                cells_around(grid, cells[i], 1, [&](Cell c) { land[c] = 1; });
            }
        }
    }
    return land;
}

bool gaps_are_sea(Mask const& land, Channels const& channels) {
    constexpr float most_m = 10.0F;
    constexpr double most_of_them = 0.9;
    constexpr std::int64_t near = 2;
    Grid const& grid = land.grid();
    double ends = 0.0;
    double low = 0.0;
    for (std::size_t n = 0; n < channels.cell.size(); ++n) {
        Cell const c = grid.at(channels.cell[n]);
        bool beside = false;
        for (std::int64_t k = 0; channels.receiver[n] < 0 && k < (2 * near + 1) * (2 * near + 1); ++k) {
            Cell const other{c.col + k % (2 * near + 1) - near, c.row + k / (2 * near + 1) - near};
            beside = beside || (grid.contains(other) && land[other] == 0);
        }
        ends += beside ? 1.0 : 0.0;
        low += beside && std::fabs(channels.z[n]) <= most_m ? 1.0 : 0.0;
    }
    return ends > 0.0 && low >= most_of_them * ends;
}

} // namespace thalweg::network
