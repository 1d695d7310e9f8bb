// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// A network and its file's other attributes.
struct FileNetwork {
    ElevatedNetwork network;                     ///< heights are all NaN if the file has none
    std::vector<double> us_area_m2;              ///< by arc; NaN: not in the file
    std::vector<double> ds_area_m2;              ///< by arc; NaN: not in the file
    std::vector<std::uint8_t> braided;           ///< by arc: 1 or 0
    std::vector<std::int64_t> arc_ids;           ///< by arc: its id in the file
    std::vector<std::int64_t> records;           ///< by arc: of its attributes
    std::vector<std::vector<Stretch>> stretches; ///< by arc: the features it is made of
};

/// Builds a network from a network file. Orders and basins are not taken from the file: they follow from the network.
/// \param file as read, not yet checked
/// \return arcs and nodes in the order of their ids, or, where arcs do not name nodes, nodes in the order of arcs.
/// Lines, heights, features, types and persistence are kept; ends of arcs take the heights of derived nodes.
/// \throws BadInput naming the first fault of a file that is not a forest: a repeated id, a missing or isolated node,
/// an end that is not its node's position, a line of length 0, a coordinate that is not a number, a missing height, two
/// arcs leaving a node, a cycle, a wrong downstream arc
FileNetwork from_file(NetworkFile const& file);

} // namespace thalweg::network
