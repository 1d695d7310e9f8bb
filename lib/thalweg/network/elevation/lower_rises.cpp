// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/lower_rises.hpp>

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/internal/require_trees.hpp>

namespace thalweg::network {

Lowered lower_rises(StreamNetwork const& network, std::vector<std::vector<double>> const& arc_z) {
    require_trees(network, "network.lower_rises");
    bool whole = arc_z.size() == network.arc_count();
    for (std::size_t a = 0; whole && a < arc_z.size(); ++a) {
        whole = arc_z[a].size() == network.arc(a).line.size() && !arc_z[a].empty();
    }
    if (!whole) {
        throw BadInput(
            fmt::format("network.lower_rises: heights are not one for each vertex of {} arcs", network.arc_count()));
    }
    Lowered lowered{{network, {}, arc_z}, std::vector<double>(arc_z.size(), 0.0)};
    auto& node_z = lowered.network.node_z;
    node_z.assign(network.node_count(), std::numeric_limits<double>::infinity());
    for (auto node = network.upstream_order().rbegin(); node != network.upstream_order().rend(); ++node) {
        ArcId const a = network.out(*node);
        if (a == no_arc) {
            continue;
        }
        auto& z = lowered.network.arc_z[a];
        double low = std::min(node_z[*node], z.front());
        node_z[*node] = low;
        for (double& vertex : z) {
            low = std::min(low, vertex);
            lowered.by_m[a] = std::max(lowered.by_m[a], vertex - low);
            vertex = low;
        }
        double& below = node_z[network.to(a)];
        below = std::min(below, low);
    }
    // The last vertex of an arc takes the height that its node got from all of them.
    for (std::size_t a = 0; a < arc_z.size(); ++a) {
        double& last = lowered.network.arc_z[a].back();
        double const z = node_z[network.to(a)];
        lowered.by_m[a] = std::max(lowered.by_m[a], last - z);
        last = z;
    }
    for (double& z : node_z) {
        z = z == std::numeric_limits<double>::infinity() ? 0.0 : z; // a node without arcs
    }
    return lowered;
}

} // namespace thalweg::network
