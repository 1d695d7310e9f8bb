// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/measure/topology/topology.hpp>

namespace thalweg::pipeline {

struct MendNetworkParams {
    double near_m = 0.0;                ///< [m] >= 0: as measure::TopologyParams
    Raster<float> const* dem = nullptr; ///< as network::ImportParams
};

/// A network without the faults of its file.
struct MendedNetwork {
    ElevatedNetwork network;
    NetworkOrders orders;
    std::vector<double> us_area_m2; ///< by arc
    std::vector<double> ds_area_m2; ///< by arc
    std::vector<double> node_area_m2;
    std::vector<std::uint8_t> braided; ///< by arc
    io::UserData user;                 ///< of the file
    std::vector<SecondaryLine> secondary;
    std::vector<Finding> doubts; ///< of directions, as network::Directions, and what was turned by which evidence
    std::vector<Finding> mended; ///< feature = arc_id of the file
    bool done = false;           ///< the check finds nothing any more; else mended ends with what is left
};

/// Mends what a check has found, without inventing more than it must.
/// Takes: the file, and what the check of it found with the same near_m. Gives, in this order: vertices that are no
/// numbers left out, an arc without a line drawn straight between its nodes or left out, ends put onto their node where
/// no other lies in their place, arcs drawn against the flow turned, loops and spikes cut off,
/// arcs that are no natural watercourse secondary; then network::adopt, which under a foreign schema is told the file's
/// links (branches beside the main path secondary, open ends joined, arcs split where they meet, copies left out, what
/// still runs against the rest turned round) and network::lower_rises. Orders and basins are those of the result. Areas
/// stay where an arc keeps its end, and are otherwise what flows in, which is the least; 0 where the file does not say.
/// Heights are 0 in a file without. Kinds of mended: left_out (vertices; arc: 0), drawn [m], moved [m], turned [m], cut
/// [m], those of adopt, lowered [m], level (arcs), secondary [m], mended (findings of one kind), not_mended. A file
/// without a fault keeps its arcs, nodes and vertices. Throws: Cancelled; BadParameter.
MendedNetwork mend_network(NetworkFile const& file, measure::TopologyReport const& found,
                           MendNetworkParams const& params = {}, Run const& run = {});

} // namespace thalweg::pipeline
