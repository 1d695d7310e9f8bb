// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/network/growth/tokunaga/internal/embed_tree.hpp>

namespace thalweg::network {

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

} // namespace thalweg::network
