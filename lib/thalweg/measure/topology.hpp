// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/network_file.hpp>
#include <thalweg/core/run.hpp>
#include <thalweg/core/stream_network.hpp>

namespace thalweg::measure {

struct TopologyReport {
    std::vector<Finding> findings; ///< feature = arc_id or node_id as the file has it
    std::vector<Check> checks;     ///< one a kind of fault, value = how many
};

/// Checks a network as it stands in its file: ends, direction, trees, orders, heights, geometry, crossings.
/// Gives: no finding exactly when the file keeps every law of the network schema. Crossings are exact (CGAL).
TopologyReport check_topology(NetworkFile const& file, Run const& run = {});

/// What a network will be in its file.
NetworkFile as_file(RaisedNetwork const& network, NetworkOrders const& orders);

} // namespace thalweg::measure
