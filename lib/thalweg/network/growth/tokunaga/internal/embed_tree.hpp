// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace thalweg::network {

/// Area of a ring [m2], whichever way it runs.
double area_of(std::vector<Vec2> const& ring);

/// Middle of a ring's vertices [m], weighted by the area.
Vec2 centroid_of(std::vector<Vec2> const& ring);

/// Whether a place lies inside a ring (even-odd rule; on the ring itself either answer may come).
bool contains(std::vector<Vec2> const& ring, Vec2 p);

/// The sides of a ring.
std::vector<Segment> sides_of(std::vector<Vec2> const& ring);

/// The places of a square lattice of this width that lie inside a ring, row by row.
std::vector<Vec2> lattice_in(std::vector<Vec2> const& ring, double width_m);

/// A link that wants a place; its node is its upper end.
struct ForestLink {
    LinkId down = -1;           ///< the link it flows into, a lower number; -1: it ends in the mouth of its tree
    int order = 1;              ///< of its stream: the higher are placed first
    int turn = 0;               ///< as in TreeLink
    std::size_t tree = 0;       ///< to whose land it belongs
    std::optional<Vec2> pinned; ///< where its node must lie, with all of its stream's
};

/// Land that one tree shall fill.
struct ForestShare {
    Vec2 mouth;                                      ///< where a link of the tree with down = -1 ends
    Vec2 far;                                        ///< where its trunk shall begin, about
    double area_m2 = 0.0;                            ///< [m2] > 0
    std::function<std::vector<Vec2>(double)> sample; ///< places of a lattice of this width [m] that lie in it
};

struct Forest {
    Indexed<LinkId, ForestLink> links;
    std::vector<ForestShare> shares;  ///< by tree
    std::vector<Segment> walls;       ///< that no link may come near, but those at the mouths
    std::function<bool(Vec2)> inside; ///< the land of all
    std::uint64_t seed = 7;
    double clearance = 0.35;    ///< share of a link's length
    double min_spacing_m = 0.0; ///< [m]
};

/// Gives every link of a forest a place, streams of the highest order first, and spreads the nodes evenly.
/// Takes: binary trees of links and the land each shall fill. After each order the nodes move towards the centres of
/// the places nearest to them (Lloyd 1982) and towards a course without bends; a move that would bring links nearer to
/// one another than the clearance, or across, is not made.
/// Gives: by link the place of its upper end. No two links cross; few are nearer to others than the clearance.
/// Throws: Cancelled. Source: specification 3.2, order first.
std::vector<Vec2> spread_forest(Forest const& forest, Run const& run = {});

/// Links that keep clear of one another.
struct SettledLinks {
    Indexed<LinkId, Vec2> at;            ///< by link: the place of its node, in multiples of 1e-6 m
    Indexed<LinkId, std::uint8_t> stays; ///< by link: 1 where there was room for it
};

/// Lets links stay that keep clear of one another, pinned ones first, then streams of the highest order, and finds
/// other places for the nodes of those that do not. Takes: a forest and the place wanted for each link's node. A link
/// that has no room there tries 24 headings and lengths down to a twentieth, the nearest to its wanted place first.
/// Gives: a link that stays is clear of every other that stays and shares no node with it by clearance * the shorter
/// one's length and by min_spacing_m, meets its neighbours at 20 degrees at least and touches no wall; one whose
/// place is pinned may touch a wall, and of two such it is asked only that they do not meet, and an angle of 1 degree.
/// The link it flows into stays. Source: specification 3.2.
SettledLinks settle_links(Forest const& forest, std::vector<Vec2> wanted);

/// A network of the links that stay.
struct KeptNetwork {
    NetworkDraft network;                          ///< its arcs run between sources, confluences and outlets
    std::vector<std::vector<LinkId>> links_of_arc; ///< by arc number, upstream first
};

/// Makes a network of links: one arc of those between which no other link enters.
/// Gives: arcs in the order of their lowest link.
KeptNetwork join_links(Forest const& forest, Indexed<LinkId, Vec2> const& at,
                       Indexed<LinkId, std::uint8_t> const& stays);

} // namespace thalweg::network
