// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/vec.hpp>

/// One step of split_confluences. Private to this module.
namespace thalweg::network {

using Line = std::vector<Vec3>;

/// Two lines that begin in one point and are neighbours there, and what lies near them.
struct Neighbours {
    Line trunk;                      ///< drawn away from the point
    Line tributary;                  ///< likewise
    bool left;                       ///< the tributary is the next one counter-clockwise; else clockwise
    bool falls;                      ///< heights fall along the trunk as it is drawn
    std::vector<Line const*> others; ///< every other line nearby, also those that end in the point
};

/// The two lines after the tributary was led to a node on the trunk, all drawn as before.
struct Shifted {
    Line near;      ///< the trunk's beginning, up to the node
    Line far;       ///< the rest of it, from the node
    Line tributary; ///< from the node
};

/// Leads a tributary to a node on the trunk at a distance [m] along it: straight or round a corner, after leaving its
/// own line as far from the point, or half-way where it is shorter.
/// Gives: nothing where the new lines would meet something else or have no length. Heights between those of the ends;
/// the node's is the trunk's or the tributary's, whichever is lower.
bool shift_tributary(Neighbours const& at, double distance_m, bool round_a_corner, Shifted& shifted);

} // namespace thalweg::network
