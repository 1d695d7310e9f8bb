// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>

namespace thalweg::network {
namespace {

/// A vertex, or the middle of what a line runs through a cell.
struct WayPoint {
    Vec3 at;
    bool is_vertex = false;
    bool is_in = false;
};

/// Where a segment goes from one cell to the next, as shares of it, with both ends.
std::vector<double> shares_by_cell(Vec3 a, Vec3 b, Grid const& grid) {
    std::vector<double> shares{0.0, 1.0};
    auto const add = [&](double from, double to) {
        for (double edge = std::ceil(std::min(from, to)); edge < std::max(from, to); edge += 1.0) {
            shares.push_back(std::clamp((edge - from) / (to - from), 0.0, 1.0));
        }
    };
    add((a.x - grid.west) / grid.cell_m, (b.x - grid.west) / grid.cell_m);
    add((grid.north - a.y) / grid.cell_m, (grid.north - b.y) / grid.cell_m);
    std::ranges::sort(shares);
    return shares;
}

std::vector<WayPoint> way_points(std::vector<Vec3> const& line, Mask const& land) {
    auto const place = [&](Vec3 p, bool is_vertex) {
        Cell const cell = land.grid().cell_of({p.x, p.y});
        return WayPoint{p, is_vertex, land.grid().contains(cell) && land[cell] != 0};
    };
    std::vector<WayPoint> places{place(line.front(), true)};
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec3 const a = line[i - 1];
        Vec3 const b = line[i];
        std::vector<double> const shares = shares_by_cell(a, b, land.grid());
        for (std::size_t k = 1; k < shares.size(); ++k) {
            double const middle = 0.5 * (shares[k - 1] + shares[k]);
            if (shares[k - 1] < shares[k]) {
                places.push_back(
                    place({a.x + middle * (b.x - a.x), a.y + middle * (b.y - a.y), a.z + middle * (b.z - a.z)}, false));
            }
        }
        places.push_back(place(b, true));
    }
    return places;
}

/// Vertices, and the places between which a line leaves the land; without vertices on the edge of a cell beside it.
std::vector<WayPoint> turning_points(std::vector<WayPoint> const& all) {
    std::vector<WayPoint> places;
    for (std::size_t i = 0; i < all.size(); ++i) {
        WayPoint const& here = all[i];
        WayPoint const& before = all[i > 0 ? i - 1 : i];
        WayPoint const& after = all[i + 1 < all.size() ? i + 1 : i];
        bool const on_edge_of_land = !here.is_in && before.is_in && after.is_in;
        bool const turns = here.is_in != before.is_in || here.is_in != after.is_in;
        if (here.is_vertex ? !on_edge_of_land : turns) {
            places.push_back(here);
        }
    }
    return places;
}

std::vector<Vec2> plan_of(std::vector<Vec3> const& line) {
    std::vector<Vec2> result;
    for (Vec3 const p : line) {
        result.push_back(in_plan(p));
    }
    return result;
}

// Removes the tips of spikes; that may expose another spike.
std::vector<Vec3> without_spikes(std::vector<Vec3> const& line, double near_m) {
    std::vector<Vec3> result;
    for (Vec3 const p : line) {
        while (result.size() > 1 &&
               geometry::is_spike(in_plan(result[result.size() - 2]), in_plan(result.back()), in_plan(p), near_m)) {
            result.pop_back();
        }
        if (result.empty() || in_plan(result.back()) != in_plan(p)) {
            result.push_back(p);
        }
    }
    return result;
}

// Adds a vertex wherever the line meets itself.
std::vector<Vec3> with_crossings(std::vector<Vec3> const& line) {
    auto const found = geometry::crossings({plan_of(line)}); // by segment, then along it
    std::vector<Vec3> result;
    auto next = found.begin();
    for (std::size_t i = 0; i < line.size(); ++i) {
        result.push_back(line[i]);
        for (; next != found.end() && next->segment == i; ++next) {
            double const z = line[i].z + next->along * (line[i + 1].z - line[i].z);
            if (in_plan(result.back()) != next->at && in_plan(line[i + 1]) != next->at) {
                result.push_back({next->at.x, next->at.y, z});
            }
        }
    }
    return result;
}

// Skips from a vertex to where the line leaves it for the last time.
std::vector<Vec3> without_returns(std::vector<Vec3> const& line) {
    std::map<std::pair<double, double>, std::size_t> last;
    for (std::size_t i = 0; i < line.size(); ++i) {
        last[{line[i].x, line[i].y}] = i;
    }
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < line.size(); ++i) {
        result.push_back(line[i]);
        i = last[{line[i].x, line[i].y}];
    }
    if (result.size() > 1) {
        result.back() = line.back();
    }
    return result;
}

} // namespace

RiverLines clip_lines(RiverLines const& lines, Mask const& land) {
    RiverLines out = lines;
    out.lines.clear();
    for (RiverLine const& line : lines.lines) {
        std::vector<WayPoint> const places = turning_points(way_points(line.vertices, land));
        for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
            bool const is_in = places[begin].is_in;
            while (end < places.size() && places[end].is_in == is_in) {
                ++end;
            }
            std::size_t const first = is_in || begin == 0 ? begin : begin - 1; // what is beyond reaches to the pieces
            std::size_t const last = is_in || end == places.size() ? end : end + 1;
            std::vector<Vec3> vertices;
            for (std::size_t i = first; i < last; ++i) {
                vertices.push_back(places[i].at);
            }
            if (vertices.size() > 1 && is_in) {
                RiverLine& piece = out.lines.emplace_back(line);
                piece.vertices = std::move(vertices);
            } else if (vertices.size() > 1) {
                out.secondary.push_back(
                    {line.feature, std::move(vertices), "beyond the terrain", line.feature, LeftOut::grid});
            }
        }
    }
    return out;
}

CutLine cut_loops(std::vector<Vec3> const& line, double near_m) {
    CutLine cut{without_spikes(line, near_m), 0.0};
    // A rounded crossing bends the line slightly: the first round nearly always suffices.
    constexpr int rounds = 16;
    for (int round = 0; round < rounds; ++round) {
        auto const crossed = with_crossings(cut.line);
        auto next = without_returns(crossed);
        bool const settled = next.size() == cut.line.size();
        cut.line = std::move(next);
        if (settled) {
            break;
        }
    }
    cut.cut_m = std::max(0.0, length_in_plan(line) - length_in_plan(cut.line));
    return cut;
}

} // namespace thalweg::network
