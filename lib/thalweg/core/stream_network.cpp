// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/stream_network.hpp>

#include <algorithm>

namespace thalweg {

ArcId add_arc(StreamNetwork& net, NodeId from, NodeId to, Arc arc) {
    if (arc.line.size() < 2) {
        arc.line = {net[from].at, net[to].at};
    }
    arc.line.front() = net[from].at;
    arc.line.back() = net[to].at;
    return boost::add_edge(from, to, std::move(arc), net).first;
}

double length_of(std::vector<Vec2> const& line) {
    double sum = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum += distance(line[i - 1], line[i]);
    }
    return sum;
}

NetworkIndex::NetworkIndex(StreamNetwork const& net) {
    std::size_t const nodes = boost::num_vertices(net);
    out.assign(nodes, -1);
    in.resize(nodes);
    basin.assign(nodes, 0);
    auto const [first, last] = boost::edges(net);
    arcs.assign(first, last);
    for (std::size_t i = 0; i < arcs.size(); ++i) {
        from.push_back(boost::source(arcs[i], net));
        to.push_back(boost::target(arcs[i], net));
        length_m.push_back(length_of(net[arcs[i]].line));
        out[from[i]] = static_cast<std::int64_t>(i);
        in[to[i]].push_back(static_cast<std::int64_t>(i));
    }
    for (NodeId n = 0; n < nodes; ++n) {
        if (out[n] < 0 && !in[n].empty()) {
            outlets.push_back(n);
            basin[n] = static_cast<std::int64_t>(outlets.size());
            upstream_order.push_back(n);
        }
    }
    for (std::size_t k = 0; k < upstream_order.size(); ++k) {
        NodeId const n = upstream_order[k];
        for (std::int64_t const a : in[n]) {
            NodeId const up = from[static_cast<std::size_t>(a)];
            if (basin[up] == 0) {
                basin[up] = basin[n];
                upstream_order.push_back(up);
            }
        }
    }
}

NodeKind kind_of(StreamNetwork const& net, NodeId node) {
    auto const arriving = boost::in_degree(node, net);
    if (boost::out_degree(node, net) == 0) {
        return NodeKind::outlet;
    }
    return arriving == 0 ? NodeKind::source : arriving == 1 ? NodeKind::pseudo : NodeKind::confluence;
}

char const* name_of(NodeKind kind) {
    switch (kind) {
    case NodeKind::source: return "source";
    case NodeKind::confluence: return "confluence";
    case NodeKind::outlet: return "outlet";
    case NodeKind::sink: return "sink";
    case NodeKind::pseudo: break;
    }
    return "pseudo";
}

} // namespace thalweg
