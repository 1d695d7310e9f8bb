// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/stream_network.hpp>

#include <algorithm>
#include <utility>

#include <thalweg/core/run/refuse.hpp>

namespace thalweg {
namespace {

void require_nodes(NetworkDraft const& draft) {
    for (std::size_t a = 0; a < draft.arcs.size(); ++a) {
        NodeId const last = std::max(draft.arcs[a].from, draft.arcs[a].to);
        refuse_if<BadInput>(last >= draft.nodes.size(), "core.StreamNetwork",
                            "arc {} ends at node {} of {}; add the node first", a + 1, last + 1, draft.nodes.size());
    }
}

void set_ends(std::vector<Vec2>& line, Vec2 from, Vec2 to) {
    if (line.size() < 2) {
        line = {from, to};
    }
    line.front() = from;
    line.back() = to;
}

} // namespace

NodeId NetworkDraft::add_node(Vec2 at) {
    nodes.push_back({at});
    return nodes.size() - 1;
}

ArcId NetworkDraft::add_arc(NodeId from, NodeId to, Arc arc) {
    arcs.push_back({from, to, std::move(arc)});
    return arcs.size() - 1;
}

double length_of(std::vector<Vec2> const& line) {
    double sum = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum += distance(line[i - 1], line[i]);
    }
    return sum;
}

StreamNetwork::ArcsAt::ArcsAt(std::vector<NodeId> const& node_of_arc, std::size_t nodes)
    : begin(nodes + 1, 0), arcs(node_of_arc.size()) {
    for (NodeId const n : node_of_arc) {
        ++begin[n + 1];
    }
    for (NodeId n = 0; n < nodes; ++n) {
        begin[n + 1] += begin[n];
    }
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (ArcId a = 0; a < arcs.size(); ++a) {
        arcs[next[node_of_arc[a]]++] = a;
    }
}

StreamNetwork::StreamNetwork(NetworkDraft draft) {
    require_nodes(draft);
    nodes_ = std::move(draft.nodes);
    for (DraftArc& drawn : draft.arcs) {
        set_ends(drawn.arc.line, nodes_[drawn.from].at, nodes_[drawn.to].at);
        from_.push_back(drawn.from);
        to_.push_back(drawn.to);
        length_m_.push_back(length_of(drawn.arc.line));
        arcs_.push_back(std::move(drawn.arc));
    }
    in_ = ArcsAt(to_, nodes_.size());
    out_ = ArcsAt(from_, nodes_.size());
    find_basins();
}

void StreamNetwork::find_basins() {
    basin_.assign(nodes_.size(), 0);
    for (NodeId n = 0; n < nodes_.size(); ++n) {
        if (out_arcs(n).empty() && !in(n).empty()) {
            outlets_.push_back(n);
            basin_[n] = static_cast<std::int64_t>(outlets_.size());
        }
    }
    upstream_order_ = outlets_;
    for (std::size_t k = 0; k < upstream_order_.size(); ++k) {
        NodeId const n = upstream_order_[k];
        for (ArcId const a : in(n)) {
            if (basin_[from_[a]] == 0) {
                basin_[from_[a]] = basin_[n];
                upstream_order_.push_back(from_[a]);
            }
        }
    }
}

NetworkDraft StreamNetwork::draft() const {
    NetworkDraft copy{nodes_, {}};
    for (ArcId a = 0; a < arcs_.size(); ++a) {
        copy.arcs.push_back({from_[a], to_[a], arcs_[a]});
    }
    return copy;
}

NodeKind kind_of(StreamNetwork const& net, NodeId node) {
    std::size_t const arriving = net.in(node).size();
    if (net.out_arcs(node).empty()) {
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
