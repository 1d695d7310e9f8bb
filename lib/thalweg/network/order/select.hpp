// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::network {

/// Lists the arcs whose water flows through an arc.
/// \param network any
/// \param arc number of the arc
/// \return ascending, the arc itself included
/// \throws BadParameter when there is no such arc
std::vector<ArcId> upstream_of(StreamNetwork const& network, ArcId arc);

/// Lists the arcs that water of an arc flows through.
/// \param network at most one arc leaves a node
/// \param arc number of the arc
/// \return downstream, from the arc itself to the outlet
/// \throws BadParameter when there is no such arc
/// \throws BadInput when arcs form a cycle, or several leave a node
std::vector<ArcId> downstream_of(StreamNetwork const& network, ArcId arc);

/// Finds the arc that is nearest to a point.
/// \param network with at least one arc
/// \param at [m] position
/// \return number of the arc (ties: the lowest)
/// \throws BadInput for a network without arcs or a point that is not finite
ArcId nearest_arc(StreamNetwork const& network, Vec2 at);

/// Takes some arcs of a network.
/// \param network any
/// \param arcs numbers, in any order; each counts once
/// \return these arcs in ascending order, and the nodes that they join in the order of their numbers
/// \throws BadParameter when there is no such arc
StreamNetwork select(StreamNetwork const& network, std::vector<ArcId> const& arcs);

/// Takes some arcs of a network with heights.
/// \param network any
/// \param arcs numbers, in any order; each counts once
/// \return as of a network without heights, with the heights of these arcs and nodes
/// \throws BadParameter when there is no such arc
ElevatedNetwork select(ElevatedNetwork const& network, std::vector<ArcId> const& arcs);

} // namespace thalweg::network
