// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/embed_tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/network/join_links.hpp>
#include <thalweg/network/polygon.hpp>
#include <thalweg/network/settle_links.hpp>
#include <thalweg/network/spread_forest.hpp>

namespace thalweg::network {

namespace {

double rounded(double v) {
    return std::floor(v * 1e6 + 0.5) / 1e6 + 0.0;
}

bool finite(Vec2 p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

/// Throws when the ring cannot be a region.
void check_ring(std::vector<Vec2> const& ring) {
    if (ring.size() < 3) {
        throw BadParameter(
            fmt::format("network.embed_tree: the region has {} vertices, it needs three at least", ring.size()));
    }
    for (Vec2 const p : ring) {
        if (!finite(p)) {
            throw BadParameter(fmt::format("network.embed_tree: the region's vertex ({}, {}) is not finite", p.x, p.y));
        }
    }
    std::vector<Vec2> closed = ring;
    closed.push_back(ring.front());
    for (geometry::Crossing const& c : geometry::crossings({closed})) {
        bool const closing = c.at == ring.front();
        if (!closing) {
            throw BadParameter(fmt::format("network.embed_tree: the region's ring meets itself at ({}, {}); draw it "
                                           "without loops",
                                           c.at.x, c.at.y));
        }
    }
    if (!(area_of(ring) > 0.0)) {
        throw BadParameter("network.embed_tree: the region has no area; give three places that are not in line");
    }
}

void check(EmbedParams const& params, std::size_t links) {
    if (!(params.clearance >= 0.05 && params.clearance <= 0.35)) {
        throw BadParameter(
            fmt::format("network.embed_tree: clearance is {}, it must lie in [0.05, 0.35]", params.clearance));
    }
    if (!(params.min_spacing_m >= 0.0) || !std::isfinite(params.min_spacing_m)) {
        throw BadParameter(
            fmt::format("network.embed_tree: min_spacing_m is {}, it must be at least 0", params.min_spacing_m));
    }
    if (!finite(params.direction) || !finite(params.mouth)) {
        throw BadParameter("network.embed_tree: mouth and direction must be finite numbers");
    }
    check_ring(params.region);
    double const spacing = std::sqrt(area_of(params.region) / static_cast<double>(links));
    if (spacing < 1e-3) {
        throw BadParameter(fmt::format("network.embed_tree: {} links in {} m2 lie {} m apart; take a larger region or "
                                       "fewer links",
                                       links, area_of(params.region), spacing));
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (Segment const& side : sides_of(params.region)) {
        nearest = std::min(nearest, std::sqrt(squared_distance(params.mouth, side)));
    }
    if (!contains(params.region, params.mouth) && nearest > 1e-6 * spacing) {
        throw BadParameter(fmt::format("network.embed_tree: the outlet ({}, {}) lies {} m outside the region; move it "
                                       "to its edge",
                                       params.mouth.x, params.mouth.y, nearest));
    }
}

/// Where the trunk's first line ends: two thirds of the way to the other side.
Vec2 far_end(EmbedParams const& params, double spacing) {
    Vec2 ahead = params.direction;
    if (ahead.x == 0.0 && ahead.y == 0.0) {
        Vec2 const middle = centroid_of(params.region);
        ahead = {middle.x - params.mouth.x, middle.y - params.mouth.y};
    }
    double const length = std::sqrt(ahead.x * ahead.x + ahead.y * ahead.y);
    ahead = length > 0.0 ? Vec2{ahead.x / length, ahead.y / length} : Vec2{0.0, 1.0};
    // The first leaving of the region, found by steps: rings are of any shape.
    double const step = 0.25 * spacing;
    double reach = step;
    auto const there = [&](double way) { return Vec2{params.mouth.x + way * ahead.x, params.mouth.y + way * ahead.y}; };
    while (contains(params.region, there(reach + step))) {
        reach += step;
    }
    return there(0.66 * reach);
}

} // namespace

EmbeddedTree embed_tree(TokunagaTree const& tree, EmbedParams const& params, Run const& run) {
    check(params, tree.links.size());
    EmbeddedTree out;
    double const area = area_of(params.region);
    out.spacing_m = std::sqrt(area / static_cast<double>(tree.links.size()));
    Forest forest;
    for (TreeLink const& link : tree.links) {
        forest.links.push_back({.down = link.down, .order = link.order, .turn = link.turn, .tree = 0, .pinned = {}});
    }
    forest.shares.push_back({.mouth = {rounded(params.mouth.x), rounded(params.mouth.y)},
                             .far = far_end(params, out.spacing_m),
                             .area_m2 = area,
                             .sample = [&](double width) { return lattice_in(params.region, width); }});
    forest.walls = sides_of(params.region);
    forest.inside = [&](Vec2 p) { return contains(params.region, p); };
    forest.seed = params.seed;
    forest.clearance = params.clearance;
    forest.min_spacing_m = params.min_spacing_m;

    SettledLinks const settled = settle_links(forest, spread_forest(forest, run));
    out.placed = std::count(settled.stays.begin(), settled.stays.end(), std::uint8_t{1});
    out.dropped = static_cast<std::int64_t>(tree.links.size()) - out.placed;
    KeptNetwork kept = join_links(forest, settled.at, settled.stays);
    out.network = std::move(kept.network);
    out.links_of_arc = std::move(kept.links_of_arc);
    return out;
}

std::vector<Vec2> outline(Grid const& grid) {
    return {{grid.west, grid.south()}, {grid.east(), grid.south()}, {grid.east(), grid.north}, {grid.west, grid.north}};
}

} // namespace thalweg::network
