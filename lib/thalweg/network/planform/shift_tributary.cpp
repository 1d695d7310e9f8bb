// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/internal/shift_tributary.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/crossings.hpp>

namespace thalweg::network {

namespace {

/// A place on a line: the last vertex before it, the place itself, the first vertex after it.
struct PlaceOnLine {
    std::size_t before;
    Vec3 at;
    std::size_t after;
};

/// The place at a distance along a line; a vertex where one is as good as there.
std::optional<PlaceOnLine> place_at(Line const& line, double distance_m) {
    constexpr double as_good = 1e-6;
    double along = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        double const step = distance(plan(line[i - 1]), plan(line[i]));
        if (i + 1 < line.size() && std::fabs(along + step - distance_m) <= as_good * distance_m) {
            return PlaceOnLine{i - 1, line[i], i + 1};
        }
        if (along + step > distance_m) {
            double const share = (distance_m - along) / step;
            Vec3 const a = line[i - 1];
            Vec3 const b = line[i];
            auto const between = [&](double from, double to) {
                return std::clamp(from + share * (to - from), std::min(from, to), std::max(from, to));
            };
            return PlaceOnLine{i - 1, {between(a.x, b.x), between(a.y, b.y), between(a.z, b.z)}, i};
        }
        along += step;
    }
    return std::nullopt;
}

Vec2 direction(Vec3 from, Vec3 to) {
    double const length = distance(plan(from), plan(to));
    return {(to.x - from.x) / length, (to.y - from.y) / length};
}

/// A corner between the directions in which two neighbours leave a point, on the side where nothing else is.
Vec3 corner(Vec3 point, Vec2 trunk, Vec2 tributary, bool left, double distance_m, double z) {
    double const turn = left ? 1.0 : -1.0;
    // Normals of both into the free wedge: their mean halves it, however wide it is.
    Vec2 const mean{turn * (tributary.y - trunk.y), turn * (trunk.x - tributary.x)};
    double const length = distance({}, mean);
    return {point.x + mean.x / length * distance_m, point.y + mean.y / length * distance_m, z};
}

struct Box {
    Vec2 low;
    Vec2 high;
};

Box box_of(std::vector<std::vector<Vec2>> const& lines) {
    Box box{lines[0][0], lines[0][0]};
    for (auto const& line : lines) {
        for (Vec2 const p : line) {
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
        }
    }
    return box;
}

void add_segments(Line const& line, Box const& box, std::vector<std::vector<Vec2>>& lines) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec3 const a = line[i - 1];
        Vec3 const b = line[i];
        bool const apart = std::max(a.x, b.x) < box.low.x || std::min(a.x, b.x) > box.high.x ||
                           std::max(a.y, b.y) < box.low.y || std::min(a.y, b.y) > box.high.y;
        if (!apart) {
            lines.push_back({plan(a), plan(b)});
        }
    }
}

/// Whether what was drawn anew meets nothing but its continuations: the way from the tributary's own line to the node,
/// and the trunk's segment on either side of the node.
bool is_free(std::array<std::vector<Vec2>, 3> const& drawn, std::vector<Line const*> const& rest) {
    std::vector<std::vector<Vec2>> lines(drawn.begin(), drawn.end());
    Box const box = box_of(lines);
    for (Line const* const line : rest) {
        add_segments(*line, box, lines);
    }
    Vec2 const node = drawn[0].back();
    return std::ranges::all_of(geometry::crossings(lines), [&](geometry::Crossing const& c) {
        return c.line < drawn.size() ? c.at == drawn[c.line].front() || c.at == drawn[c.line].back() : c.at != node;
    });
}

} // namespace

bool shift_tributary(Neighbours const& at, double distance_m, bool round_a_corner, Shifted& shifted) {
    double const leaving_m = std::min(distance_m, length_in_plan(at.tributary) / 2.0);
    auto node = place_at(at.trunk, distance_m);
    auto const leaving = place_at(at.tributary, leaving_m);
    if (!node || !leaving) {
        return false;
    }
    auto const offset = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
    Vec3 const point = at.trunk.front();
    node->at.z = std::min(node->at.z, leaving->at.z);
    shifted.near.assign(at.trunk.begin(), at.trunk.begin() + offset(node->before + 1));
    if (!at.falls) {
        for (Vec3& p : shifted.near) {
            p.z = std::min(p.z, node->at.z);
        }
    }
    shifted.near.push_back(node->at);
    shifted.far.assign(1, node->at);
    shifted.far.insert(shifted.far.end(), at.trunk.begin() + offset(node->after), at.trunk.end());
    shifted.tributary.assign(1, node->at);
    if (round_a_corner) {
        shifted.tributary.push_back(corner(point, direction(point, at.trunk[1]), direction(point, at.tributary[1]),
                                           at.left, leaving_m / 2.0, leaving->at.z));
    }
    std::size_t const way = shifted.tributary.size() + 2;
    shifted.tributary.push_back(leaving->at);
    shifted.tributary.insert(shifted.tributary.end(), at.tributary.begin() + offset(leaving->after),
                             at.tributary.end());

    std::array<std::vector<Vec2>, 3> drawn;
    for (std::size_t i = way; i-- > 0;) {
        drawn[0].push_back(plan(shifted.tributary[i]));
    }
    drawn[1] = {plan(at.trunk[node->before]), plan(node->at)};
    drawn[2] = {plan(node->at), plan(at.trunk[node->after])};
    for (auto const& line : drawn) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            if (!(distance(line[i - 1], line[i]) > 0.0)) { // also where squares underflow
                return false;
            }
        }
    }
    std::array<Line, 3> const kept{Line(at.trunk.begin(), at.trunk.begin() + offset(node->before + 1)),
                                   Line(at.trunk.begin() + offset(node->after), at.trunk.end()),
                                   Line(at.tributary.begin() + offset(leaving->after), at.tributary.end())};
    std::vector<Line const*> rest = at.others;
    for (Line const& line : kept) {
        rest.push_back(&line);
    }
    return is_free(drawn, rest);
}

} // namespace thalweg::network
