// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/internal/import_lines.hpp>

#include <algorithm>
#include <cmath>

namespace thalweg::network::import_steps {

std::size_t other_end(Piece const& piece, std::size_t node) {
    return piece.from == node ? piece.to : piece.from;
}

void root_at(Pieces const& p, std::size_t outlet, Tree& tree) {
    tree.nodes = {outlet};
    tree.towards[outlet] = no_piece;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        std::size_t const n = tree.nodes[i];
        for (PieceId const k : p.at_node[n]) {
            if (k != tree.towards[n]) {
                std::size_t const up = other_end(p.pieces[k], n);
                tree.towards[up] = k;
                tree.nodes.push_back(up);
            }
        }
    }
}

std::int64_t weight(Piece const& piece) {
    return std::max(std::int64_t{1}, static_cast<std::int64_t>(std::floor(piece.length_m * 1e6)));
}

std::vector<std::int64_t> against(Pieces const& p, Tree const& tree, Votes const& votes,
                                  std::vector<std::int64_t>& cost) {
    auto const gain = [&](std::size_t n) { // from the node downstream to n
        PieceId const k = tree.towards[n];
        std::int64_t const w = weight(p.pieces[k]) * votes[k];
        return p.pieces[k].from == n ? w : -w;
    };
    std::size_t const first = tree.nodes.front();
    cost[first] = 0;
    for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
        cost[first] += std::max(std::int64_t{0}, -gain(tree.nodes[i]));
    }
    std::vector<std::int64_t> result{cost[first]};
    for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
        std::size_t const n = tree.nodes[i];
        PieceId const k = tree.towards[n];
        cost[n] = cost[other_end(p.pieces[k], n)] + gain(n);
        result.push_back(cost[n]);
    }
    return result;
}

std::vector<double> border_distances(Pieces const& p, std::vector<RiverLine> const& lines) {
    Vec2 low = p.nodes.front();
    Vec2 high = low;
    for (auto const& line : lines) {
        for (auto const& v : line.vertices) {
            low = {std::min(low.x, v.x), std::min(low.y, v.y)};
            high = {std::max(high.x, v.x), std::max(high.y, v.y)};
        }
    }
    std::vector<double> result;
    for (Vec2 const at : p.nodes) {
        result.push_back(std::min({at.x - low.x, high.x - at.x, at.y - low.y, high.y - at.y}));
    }
    return result;
}

} // namespace thalweg::network::import_steps
