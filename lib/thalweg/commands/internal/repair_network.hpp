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
#include <thalweg/network/order/main_stems.hpp>

namespace thalweg::commands {

struct RepairNetworkParams {
    double near_m = 0.0;                ///< [m] >= 0: as measure::TopologyParams
    Raster<float> const* dem = nullptr; ///< as network::ImportParams
    network::MainBy main = network::MainBy::file;
};

/// A network repaired from the faults of its file.
struct RepairedNetwork {
    ElevatedNetwork network;
    NetworkOrders orders;
    bool has_heights = true;        ///< else those of the network are 0
    std::vector<double> us_area_m2; ///< by arc; -1: unknown
    std::vector<double> ds_area_m2; ///< by arc; -1: unknown
    std::vector<double> node_area_m2;
    std::vector<std::uint8_t> braided; ///< by arc
    io::UserData user;                 ///< of the file
    std::vector<SecondaryLine> secondary;
    std::vector<Finding> doubts; ///< about directions, as network::Directions, and lengths reversed, by evidence
    std::vector<Finding> mended; ///< feature = arc_id of the file
    bool done = false;           ///< a check finds no more faults; otherwise mended ends with the remaining ones
};

/// Repairs the faults that a check found, inventing as little as possible. In order: drops vertices that are not
/// numbers; draws an arc without a line straight between its nodes, or drops it; moves ends onto their node unless
/// another node is there; reverses arcs drawn against the flow; cuts loops and spikes; makes arcs that are not natural
/// watercourses secondary. Then calls network::import_lines, under foreign schemas with the file's links (makes
/// branches beside the main path secondary, joins open ends, splits arcs where they meet, drops duplicates, reverses
/// lines that contradict the others) and network::lower_rises. Orders and basins are computed. An arc whose end did not
/// move keeps its area, raised to that of a larger inflow; at a new end it gets the sum of its inflows, a lower bound.
/// Kinds of mended: left_out (vertices; arc: 0), drawn [m], moved [m], turned [m], cut [m], those of import_lines,
/// lowered [m], level (arcs), area_raised [m2], secondary [m], mended (findings of one kind), not_mended. A file
/// without faults keeps its arcs, nodes and vertices.
/// \param file as read
/// \param found result of the check with the same near_m
/// \return the repaired network
/// \throws BadParameter when a parameter is outside its range
RepairedNetwork repair_network(NetworkFile const& file, measure::TopologyReport const& found,
                               RepairNetworkParams const& params = {}, Run const& run = {});

} // namespace thalweg::commands
