// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include <thalweg/core/stream_network.hpp>

/// What the stages that set heights share: from the heights of nodes to those of vertices. Private to this module.
namespace thalweg::network {

/// Makes sure that heights can be set. Takes: as require_trees. Throws: BadInput like it, and for an arc of no length.
void require_raisable(StreamNetwork const& network, std::string_view who);

/// A height just above another one, as far as doubles tell them apart; 0 above 0.
inline double next_above(double below) {
    return below * (1.0 + 0x1p-52);
}

/// The way from a line's first vertex to each of them [m].
std::vector<double> way_along(std::vector<Vec2> const& line);

/// Heights of a line's vertices, from z_up to z_down as `way` grows from 0 to its last value, which is above 0.
/// Gives: the ends bit for bit; no vertex above the one before where z_up > z_down.
std::vector<double> between(std::vector<double> const& way, double z_up, double z_down);

/// Throws: BadInput, naming the node, where a height is no number (lengths or slopes beyond the range of doubles).
void require_heights(StreamNetwork const& network, std::vector<double> const& node_z, std::string_view who);

/// A network with heights of its nodes and vertices linear by length along the arcs.
/// Throws: like require_heights.
ElevatedNetwork raise_linearly(StreamNetwork const& network, std::vector<double> node_z, std::string_view who);

} // namespace thalweg::network
