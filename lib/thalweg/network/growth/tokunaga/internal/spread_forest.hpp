// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/network/planform/internal/segment_grid.hpp>

namespace thalweg::network {

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

} // namespace thalweg::network
