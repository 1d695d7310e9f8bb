// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/embed_tree.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>

namespace thalweg::network {

namespace {

constexpr std::uint64_t embed_stage = 0x656d626564; // "embed"

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
    require_in("network.embed_tree", "clearance", params.clearance, Range::between(0.05, 0.35));
    require_in("network.embed_tree", "min_spacing_m", params.min_spacing_m, Range::at_least(0.0));
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

/// A tree without its lowest orders; links between which nothing enters any more are one.
struct Thinned {
    Indexed<LinkId, ForestLink> links;
    Indexed<LinkId, std::vector<LinkId>> links_of; ///< of the tree, by link of the forest, downstream first
};

Thinned thinned(TokunagaTree const& tree, int lowest) {
    Indexed<LinkId, int> arrivals(tree.links.size(), 0);
    for (TreeLink const& link : tree.links) {
        if (link.down >= 0 && link.order >= lowest) {
            ++arrivals[link.down];
        }
    }
    Thinned out;
    Indexed<LinkId, LinkId> part(tree.links.size(), -1); // of the forest
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        TreeLink const& link = tree.links[i];
        if (link.order < lowest) {
            continue;
        }
        LinkId const below = link.down < 0 ? -1 : part[link.down];
        if (link.down >= 0 && arrivals[link.down] == 1) {
            part[i] = below;
        } else {
            part[i] = out.links.count();
            out.links.push_back({.down = below, .order = link.order, .turn = link.turn, .tree = 0, .pinned = {}});
            out.links_of.emplace_back();
        }
        out.links_of[part[i]].push_back(static_cast<LinkId>(i));
    }
    return out;
}

/// As many orders as leave room for what keeps the spacing asked for.
Thinned thinned_to_fit(TokunagaTree const& tree, double area_m2, double min_spacing_m) {
    constexpr double room = 1.8; // links keep apart that share no node, along a stream too
    int const highest = tree.links.empty() ? 1 : tree.links.front().order;
    for (int lowest = 1;; ++lowest) {
        Thinned out = thinned(tree, lowest);
        if (lowest >= highest || std::sqrt(area_m2 / static_cast<double>(out.links.size())) >= room * min_spacing_m) {
            return out;
        }
    }
}

} // namespace

EmbeddedTree embed_tree(TokunagaTree const& tree, EmbedParams const& params, Run const& run) {
    check(params, tree.links.size());
    EmbeddedTree out;
    double const area = area_of(params.region);
    out.spacing_m = std::sqrt(area / static_cast<double>(tree.links.size()));
    Thinned const fits = thinned_to_fit(tree, area, params.min_spacing_m);
    Forest forest;
    forest.links = fits.links;
    forest.shares.push_back({.mouth = {rounded(params.mouth.x), rounded(params.mouth.y)},
                             .far = far_end(params, out.spacing_m),
                             .area_m2 = area,
                             .sample = [&](double width) { return lattice_in(params.region, width); }});
    forest.walls = sides_of(params.region);
    forest.inside = [&](Vec2 p) { return contains(params.region, p); };
    forest.clearance = params.clearance;
    forest.min_spacing_m = params.min_spacing_m;

    // Of a few beginnings the one that leaves out the fewest links; large trees leave out few in any.
    constexpr std::uint64_t beginnings = 6;
    constexpr std::size_t large = 5000;
    constexpr double enough = 0.98;
    SettledLinks settled;
    std::int64_t most = -1;
    for (std::uint64_t k = 0; k < beginnings; ++k) {
        forest.seed = k == 0 ? params.seed : random_word(params.seed, embed_stage, k);
        SettledLinks found = settle_links(forest, spread_forest(forest, run));
        std::int64_t const placed = std::count(found.stays.begin(), found.stays.end(), std::uint8_t{1});
        if (placed > most) {
            most = placed;
            settled = std::move(found);
        }
        if (forest.links.size() > large ||
            static_cast<double>(most) >= enough * static_cast<double>(forest.links.size())) {
            break;
        }
    }
    KeptNetwork kept = join_links(forest, settled.at, settled.stays);
    out.network = std::move(kept.network);
    for (std::vector<LinkId> const& parts : kept.links_of_arc) {
        std::vector<LinkId>& links = out.links_of_arc.emplace_back();
        for (LinkId const part : parts) {
            std::vector<LinkId> const& own = fits.links_of[part];
            links.insert(links.end(), own.rbegin(), own.rend());
        }
        out.placed += static_cast<std::int64_t>(links.size());
    }
    out.dropped = static_cast<std::int64_t>(tree.links.size()) - out.placed;
    return out;
}

std::vector<Vec2> outline(Grid const& grid) {
    return {{grid.west, grid.south()}, {grid.east(), grid.south()}, {grid.east(), grid.north}, {grid.west, grid.north}};
}

} // namespace thalweg::network
