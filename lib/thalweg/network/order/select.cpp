// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/select.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/geometry/nearby.hpp>

namespace thalweg::network {
namespace {

void require_arc(StreamNetwork const& network, ArcId arc, char const* where) {
    refuse_if<BadParameter>(arc >= network.arc_count(), where, "there is no arc {}; they are 0 to {}",
                            static_cast<std::int64_t>(arc), static_cast<std::int64_t>(network.arc_count()) - 1);
}

/// A part of a network, and the arcs and nodes that it consists of.
struct SelectedPart {
    StreamNetwork network;
    std::vector<ArcId> arcs;
    std::vector<NodeId> nodes;
};

SelectedPart selected(StreamNetwork const& network, std::vector<ArcId> arcs) {
    std::ranges::sort(arcs);
    arcs.erase(std::unique(arcs.begin(), arcs.end()), arcs.end());
    std::vector<NodeId> nodes;
    for (ArcId const arc : arcs) {
        require_arc(network, arc, "network.select");
        nodes.push_back(network.from(arc));
        nodes.push_back(network.to(arc));
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    NetworkDraft draft;
    for (NodeId const node : nodes) {
        draft.add_node(network.node(node).at);
    }
    auto const number = [&](NodeId node) {
        return static_cast<NodeId>(std::ranges::lower_bound(nodes, node) - nodes.begin());
    };
    for (ArcId const arc : arcs) {
        draft.add_arc(number(network.from(arc)), number(network.to(arc)), network.arc(arc));
    }
    return {std::move(draft), std::move(arcs), std::move(nodes)};
}

} // namespace

std::vector<ArcId> upstream_of(StreamNetwork const& network, ArcId arc) {
    require_arc(network, arc, "network.upstream_of");
    std::vector<bool> is_found(network.arc_count());
    std::vector<ArcId> found{arc};
    is_found[arc] = true;
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (ArcId const above : network.in(network.from(found[i]))) {
            if (!is_found[above]) {
                is_found[above] = true;
                found.push_back(above);
            }
        }
    }
    std::ranges::sort(found);
    return found;
}

std::vector<ArcId> downstream_of(StreamNetwork const& network, ArcId arc) {
    require_arc(network, arc, "network.downstream_of");
    std::vector<ArcId> found;
    for (ArcId at = arc; at != no_arc; at = network.out(network.to(at))) {
        refuse_if<BadInput>(found.size() >= network.arc_count(), "network.downstream_of", "arcs form a cycle");
        refuse_if<BadInput>(network.out_arcs(network.to(at)).size() > 1, "network.downstream_of",
                            "several arcs leave node {}; the network must be a forest", network.to(at));
        found.push_back(at);
    }
    return found;
}

ArcId nearest_arc(StreamNetwork const& network, Vec2 at) {
    refuse_if<BadInput>(network.arc_count() == 0, "network.nearest_arc", "the network has no arcs");
    refuse_if<BadInput>(!is_finite(at), "network.nearest_arc", "the point is not finite");
    ArcId nearest = 0;
    double least_m = std::numeric_limits<double>::infinity();
    for (ArcId arc = 0; arc < network.arc_count(); ++arc) {
        std::vector<Vec2> const& line = network.arc(arc).line;
        for (std::size_t v = 0; v + 1 < line.size(); ++v) {
            double const away_m = distance(geometry::foot_on(line[v], line[v + 1], at).at, at);
            if (away_m < least_m) {
                least_m = away_m;
                nearest = arc;
            }
        }
    }
    return nearest;
}

StreamNetwork select(StreamNetwork const& network, std::vector<ArcId> const& arcs) {
    return selected(network, arcs).network;
}

ElevatedNetwork select(ElevatedNetwork const& network, std::vector<ArcId> const& arcs) {
    SelectedPart part = selected(network.planform, arcs);
    ElevatedNetwork found{std::move(part.network), {}, {}};
    for (NodeId const node : part.nodes) {
        found.node_z.push_back(network.node_z[node]);
    }
    for (ArcId const arc : part.arcs) {
        found.arc_z.push_back(network.arc_z[arc]);
    }
    return found;
}

} // namespace thalweg::network
