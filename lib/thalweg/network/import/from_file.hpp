// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/network_file.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::network {

/// A network with what its file says beside lines and heights.
struct FileNetwork {
    ElevatedNetwork network;                     ///< heights are NaN, all of them, where the file has none
    std::vector<double> us_area_m2;              ///< by arc; NaN where the file does not say
    std::vector<double> ds_area_m2;              ///< by arc; NaN where the file does not say
    std::vector<std::uint8_t> braided;           ///< by arc: 1 or 0
    std::vector<std::int64_t> arc_ids;           ///< by arc: its id in the file
    std::vector<std::int64_t> records;           ///< by arc: of its attributes
    std::vector<std::vector<Stretch>> stretches; ///< by arc: the features it is made of
};

/// Builds the network that a file describes.
/// \param file the network as in its file
/// \return arcs in the order of their ids, nodes in that of theirs, or where arcs name none as they come along the
/// arcs; lines and heights bit for bit, but the ends of arcs take the heights of nodes that were made for them;
/// feature, type and survives as the file has them. Orders and basins follow from the network: those of the file are
/// not taken.
/// \throws BadInput naming the first fault, for a file that is not a set of trees: ids that repeat, a node that is
/// missing or has no arc, an end that is not its node, a line without length or with a coordinate that is not a number,
/// a height where others have none, two arcs leaving a node, a cycle, a downstream arc that is another
FileNetwork from_file(NetworkFile const& file);

} // namespace thalweg::network
