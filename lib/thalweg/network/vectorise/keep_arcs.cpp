// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/internal/keep_arcs.hpp>

#include <utility>

namespace thalweg::network {

KeptArcs keep_arcs(StreamNetwork const& network, std::vector<std::int64_t> const& lengths,
                   std::vector<std::uint8_t> const& kept, Merge merge) {
    std::vector<std::int64_t> arriving(network.node_count(), 0);
    for (std::size_t a = 0; a < kept.size(); ++a) {
        arriving[network.to(a)] += kept[a];
    }
    auto const leaves = [&](NodeId n) { return network.out(n) != no_arc && kept[network.out(n)] != 0; };

    auto const is_merged = [&](NodeId n) {
        return arriving[n] == 1 && leaves(n) && (merge == Merge::all || network.in(n).size() > 1);
    };

    KeptArcs out;
    std::vector<NodeId> node(network.node_count(), 0);
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if ((leaves(n) || arriving[n] > 0) && !is_merged(n)) {
            node[n] = out.network.add_node(network.node(n).at);
        }
    }
    for (std::size_t a = 0; a < kept.size(); ++a) {
        if (kept[a] == 0 || is_merged(network.from(a))) {
            continue;
        }
        Arc arc = network.arc(a);
        std::size_t piece = a;
        std::size_t longest = a;
        std::vector<std::size_t>& pieces = out.pieces.emplace_back(1, a);
        while (is_merged(network.to(piece))) {
            piece = network.out(network.to(piece));
            pieces.push_back(piece);
            std::vector<Vec2> const& line = network.arc(piece).line;
            arc.line.insert(arc.line.end(), line.begin() + 1, line.end());
            longest = lengths[piece] > lengths[longest] ? piece : longest;
        }
        arc.feature = network.arc(longest).feature;
        arc.type = network.arc(longest).type;
        arc.is_input = network.arc(longest).is_input;
        out.network.add_arc(node[network.from(a)], node[network.to(piece)], std::move(arc));
    }
    return out;
}

} // namespace thalweg::network
