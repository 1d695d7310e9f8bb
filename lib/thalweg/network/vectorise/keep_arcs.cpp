// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/vectorise/internal/keep_arcs.hpp>

#include <utility>

namespace thalweg::network {

KeptArcs keep_arcs(StreamNetwork const& network, NetworkIndex const& index, std::vector<std::int64_t> const& lengths,
                   std::vector<std::uint8_t> const& kept, Merge merge) {
    std::vector<std::int64_t> arriving(index.out.size(), 0);
    for (std::size_t a = 0; a < kept.size(); ++a) {
        arriving[index.to[a]] += kept[a];
    }
    auto const leaves = [&](NodeId n) {
        return index.out[n] >= 0 && kept[static_cast<std::size_t>(index.out[n])] != 0;
    };

    auto const is_merged = [&](NodeId n) {
        return arriving[n] == 1 && leaves(n) && (merge == Merge::all || index.in[n].size() > 1);
    };

    KeptArcs out;
    std::vector<NodeId> node(index.out.size(), 0);
    for (NodeId n = 0; n < index.out.size(); ++n) {
        if ((leaves(n) || arriving[n] > 0) && !is_merged(n)) {
            node[n] = boost::add_vertex(network[n], out.network);
        }
    }
    for (std::size_t a = 0; a < kept.size(); ++a) {
        if (kept[a] == 0 || is_merged(index.from[a])) {
            continue;
        }
        Arc arc = network[index.arcs[a]];
        std::size_t piece = a;
        std::size_t longest = a;
        std::vector<std::size_t>& pieces = out.pieces.emplace_back(1, a);
        while (is_merged(index.to[piece])) {
            piece = static_cast<std::size_t>(index.out[index.to[piece]]);
            pieces.push_back(piece);
            std::vector<Vec2> const& line = network[index.arcs[piece]].line;
            arc.line.insert(arc.line.end(), line.begin() + 1, line.end());
            longest = lengths[piece] > lengths[longest] ? piece : longest;
        }
        arc.feature = network[index.arcs[longest]].feature;
        arc.type = network[index.arcs[longest]].type;
        arc.given = network[index.arcs[longest]].given;
        add_arc(out.network, node[index.from[a]], node[index.to[piece]], std::move(arc));
    }
    return out;
}

} // namespace thalweg::network
