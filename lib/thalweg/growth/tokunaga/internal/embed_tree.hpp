// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/segment_grid.hpp>
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

// Described in docs/algorithms/forest_spreading.md.

namespace thalweg::growth {

/// Area-weighted centroid of a ring [m].
Vec2 centroid_of(std::vector<Vec2> const& ring);

/// The sides of a ring.
std::vector<geometry::Segment> sides_of(std::vector<Vec2> const& ring);

/// The nodes of a square lattice of this spacing that lie inside a ring, row by row.
std::vector<Vec2> lattice_in(std::vector<Vec2> const& ring, double width_m);

/// A link to be placed; its node is its upper end.
struct ForestLink {
    LinkId down = -1;           ///< the link downstream, a lower number; -1: it ends in the mouth of its tree
    int order = 1;              ///< of its stream: higher orders are placed first
    int turn = 0;               ///< as in TreeLink
    std::size_t tree = 0;       ///< the tree it belongs to
    std::optional<Vec2> pinned; ///< prescribed position of its node, as for all links of its stream
};

/// The area that one tree fills.
struct ForestShare {
    Vec2 mouth;                                      ///< where a link of the tree with down = -1 ends
    Vec2 far;                                        ///< approximate upper end of its trunk
    double area_m2 = 0.0;                            ///< [m2] > 0
    std::function<std::vector<Vec2>(double)> sample; ///< nodes of a lattice of this spacing [m] inside the area
};

struct Forest {
    std::vector<ForestLink> links;
    std::vector<ForestShare> shares;      ///< by tree
    std::vector<geometry::Segment> walls; ///< that links keep clear of, except those at the mouths
    std::function<bool(Vec2)> inside;     ///< the area of all trees
    std::uint64_t seed = 7;
    double clearance = 0.35;    ///< relative to a link's length
    double min_spacing_m = 0.0; ///< [m]
};

/// Places every link of a forest, streams of the highest order first, and spreads the nodes evenly. After each order
/// the nodes move towards the centroids of the positions nearest to them (Lloyd 1982) and towards a straight course;
/// moves that would bring links closer than the clearance, or across one another, are not made.
/// \param forest binary trees of links, and the areas they fill
/// \return by link: position of its upper end. No two links cross; few are closer to others than the clearance.
std::vector<Vec2> spread_forest(Forest const& forest, Run const& run = {});

/// Links that keep clear of one another.
struct SettledLinks {
    std::vector<Vec2> at;            ///< by link: position of its node, in multiples of 1e-6 m
    std::vector<std::uint8_t> stays; ///< by link: 1: placed
};

/// Selects links that keep clear of one another, prescribed ones first, then streams of the highest order, and
/// relocates the nodes of the others. A link without space at its wanted position tries 24 headings and lengths down to
/// a twentieth, the nearest to its wanted position first.
/// \param forest the links
/// \param wanted by link: wanted position of its node
/// \return a placed link keeps clearance * the shorter length, and min_spacing_m, from every other placed link without
/// a common node, meets its neighbours at 20 degrees or more and touches no wall. A link with a prescribed position may
/// touch a wall; two such links must only not meet, at an angle of at least 1 degree. The link downstream of a placed
/// link is placed.
SettledLinks settle_links(Forest const& forest, std::vector<Vec2> wanted);

/// A network of the placed links.
struct KeptNetwork {
    NetworkDraft network;                          ///< its arcs run between sources, confluences and outlets
    std::vector<std::vector<LinkId>> links_of_arc; ///< by arc number, upstream first
};

/// Makes a network of links: joins links between which no other link enters into one arc.
/// \return arcs in the order of their lowest link
KeptNetwork join_links(Forest const& forest, std::vector<Vec2> const& at, std::vector<std::uint8_t> const& stays);

} // namespace thalweg::growth
