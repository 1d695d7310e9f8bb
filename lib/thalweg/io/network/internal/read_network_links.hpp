// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/network_file.hpp>
#include <thalweg/io/network/internal/read_network_notes.hpp>

/// How the arcs of a network file hang together. Private to this module.
namespace thalweg::io {

/// Sets ds_arc by keys. Takes: by arc its key and that of the arc downstream, 0 for none. A key that no arc has stands
/// in ds_arc as the negative of itself, for drop_links_out.
void link_by_keys(NetworkFile& file, std::vector<std::int64_t> const& keys, std::vector<std::int64_t> const& ds_keys);

/// Makes an outlet of each arc whose ds_arc the file does not hold: an extract ends there; its basins go by others.
void drop_links_out(NetworkFile& file, std::string const& what, Notes& notes);

/// Leaves out arcs whose vertices all lie at one place: arcs that flow into one flow into what is downstream of it.
/// Their Strahler numbers are then those of two streams after another, not of all that meet.
void bridge_points(NetworkFile& file, std::string const& what, Notes& notes);

/// Turns all lines when more linked arcs are drawn up than down; with as many of both, when drawn_upstream.
void turn_downstream(NetworkFile& file, bool drawn_upstream, std::string const& what, Notes& notes);

/// Makes a node for each place in plan where an arc begins or ends, from 1 in the order of the arcs, and sets from_node
/// and to_node; arcs without vertices have none (0).
void name_ends(NetworkFile& file);

/// Makes a node for each id in from_node and to_node but 0, where most ends of that id are.
void place_nodes(NetworkFile& file);

/// Sets ds_arc to the first arc that begins at the arc's end.
void link_by_nodes(NetworkFile& file);

/// Sets where the findings that name an arc are: where it begins.
void place_findings(NetworkFile& file);

} // namespace thalweg::io
