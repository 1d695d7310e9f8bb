// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/order/main_stems.hpp>

namespace thalweg::network {

/// A network and its file's other attributes.
struct FileNetwork {
    ElevatedNetwork network;                     ///< heights are all NaN if the file has none
    std::vector<double> us_area_m2;              ///< by arc; NaN: unknown
    std::vector<double> ds_area_m2;              ///< by arc; NaN: unknown
    std::vector<double> own_area_m2;             ///< by arc: of its own catchment; NaN: unknown
    std::vector<std::uint8_t> braided;           ///< by arc: 1 or 0
    std::vector<std::int64_t> arc_ids;           ///< by arc: its id in the file
    std::vector<std::int64_t> records;           ///< by arc: of its attributes
    std::vector<std::vector<Stretch>> stretches; ///< by arc: the features it is made of
    StemClues clues;                             ///< of its main stems
};

/// What a file says of an arc's main stem.
StemClues::OfArc clues_of(NetworkFile::FileArc const& arc);

/// Builds a network from a network file. Orders and basins are not taken from the file: they follow from the network.
/// \param file as read, not yet checked
/// \return arcs and nodes in the order of their ids, or, where arcs do not name nodes, nodes in the order of arcs.
/// Lines, heights, features, types and persistence are kept; ends of arcs take the heights of derived nodes.
/// \throws BadInput naming the first fault of a file that is not a forest: a repeated id, a missing or isolated node,
/// an end that is not its node's position, a line of length 0, a coordinate that is not a number, a missing height, two
/// arcs leaving a node, a cycle, a wrong downstream arc
FileNetwork from_file(NetworkFile const& file);

/// Makes a forest of a network with divergences: where several arcs leave a node, all but the main one begin in a new
/// node in its place. The main one is that to which the file's links lead, else the one that the file calls main, else
/// the one it does not call minor.
/// \param file as read
/// \return the file with more nodes; how many arcs begin in one of them
std::pair<NetworkFile, std::int64_t> divide(NetworkFile file);

} // namespace thalweg::network
