// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>
#include <thalweg/network/adopt_steps.hpp>

// A component is a tree, so its outlet alone says which way every piece runs. Each kind of evidence is a vote of every
// piece for one of its ends; the outlet is the node against which the least length votes.
namespace thalweg::network::adopt_steps {
namespace {

using Votes = std::vector<int>; // by piece: 1 runs as drawn, -1 against it, 0 does not say

Votes by_height(Pieces const& p, std::vector<RiverLine> const& lines) {
    Votes votes;
    for (auto const& piece : p.pieces) {
        auto const& v = lines[piece.line].vertices;
        double const fall = v[piece.first].z - v[piece.last].z;
        votes.push_back(fall > 0.0 ? 1 : fall < 0.0 ? -1 : 0);
    }
    return votes;
}

// A node is left by the piece of least rank that touches it; the others run into it. (One that is above its neighbours
// at both ends votes for one of them: the other neighbour contradicts it.)
Votes by_rank(Pieces const& p, std::vector<RiverLine> const& lines) {
    auto const rank = [&](std::size_t k) { return lines[p.pieces[k].line].rank; };
    Votes votes;
    for (std::size_t k = 0; k < p.pieces.size(); ++k) {
        auto const some = [&](std::size_t node, auto const& test) {
            return std::ranges::any_of(p.at_node[node],
                                       [&](std::size_t other) { return rank(other) != 0 && test(rank(other)); });
        };
        auto const lower = [&](std::int64_t r) { return r < rank(k); };
        auto const higher = [&](std::int64_t r) { return r > rank(k); };
        auto const& piece = p.pieces[k];
        int vote = 0;
        if (rank(k) != 0) {
            if (some(piece.to, lower)) {
                vote = 1;
            } else if (some(piece.from, lower)) {
                vote = -1;
            } else { // the last reach runs away from what runs into it
                vote = int{some(piece.from, higher)} - int{some(piece.to, higher)};
            }
        }
        votes.push_back(vote);
    }
    return votes;
}

struct Evidence {
    Votes votes;
    char const* name;
};

// What the file says for certain, the most trusted first.
std::vector<Evidence> evidence_of(Pieces const& p, std::vector<RiverLine> const& lines, RiverLines const& file,
                                  Orientation asked) {
    bool const any_rank = std::ranges::any_of(lines, [](RiverLine const& l) { return l.rank != 0; });
    if (asked == Orientation::height && !file.has_z) {
        throw BadInput("network.adopt: the rivers of " + file.name + " carry no heights to orient them by");
    }
    if (asked == Orientation::rank && !any_rank) {
        throw BadInput("network.adopt: the rivers of " + file.name + " carry no rank to orient them by");
    }
    std::vector<Evidence> evidence;
    if (file.has_z && (asked == Orientation::height || asked == Orientation::automatic)) {
        evidence.push_back({by_height(p, lines), "height"});
    }
    if (any_rank && (asked == Orientation::rank || asked == Orientation::automatic)) {
        evidence.push_back({by_rank(p, lines), "rank"});
    }
    if (asked == Orientation::as_drawn) {
        evidence.push_back({Votes(p.pieces.size(), 1), "the drawn direction"});
    }
    return evidence;
}

struct Tree {
    std::vector<std::size_t> nodes;     // the component, each after the one it was reached from
    std::vector<std::int64_t>& towards; // by node: piece towards the first of them, -1 for it
};

std::size_t other_end(Piece const& piece, std::size_t node) {
    return piece.from == node ? piece.to : piece.from;
}

void root_at(Pieces const& p, std::size_t outlet, Tree& tree) {
    tree.nodes = {outlet};
    tree.towards[outlet] = -1;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        std::size_t const n = tree.nodes[i];
        for (std::size_t const k : p.at_node[n]) {
            if (static_cast<std::int64_t>(k) != tree.towards[n]) {
                std::size_t const up = other_end(p.pieces[k], n);
                tree.towards[up] = static_cast<std::int64_t>(k);
                tree.nodes.push_back(up);
            }
        }
    }
}

// Whole micrometres: sums of them are exact in any order.
std::int64_t weight(Piece const& piece) {
    return std::max(std::int64_t{1}, static_cast<std::int64_t>(std::floor(piece.length_m * 1e6)));
}

// By place in tree.nodes: the length of the pieces that vote against this node as outlet. cost: room for every node.
std::vector<std::int64_t> against(Pieces const& p, Tree const& tree, Votes const& votes,
                                  std::vector<std::int64_t>& cost) {
    auto const gain = [&](std::size_t n) { // from the node downstream to n
        auto const k = static_cast<std::size_t>(tree.towards[n]);
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
        auto const k = static_cast<std::size_t>(tree.towards[n]);
        cost[n] = cost[other_end(p.pieces[k], n)] + gain(n);
        result.push_back(cost[n]);
    }
    return result;
}

[[noreturn]] void refuse_bifurcation(Pieces const& p, std::vector<RiverLine> const& lines, Tree const& tree,
                                     Votes const& votes, std::string const& name, char const* evidence) {
    for (std::size_t const n : tree.nodes) {
        auto const k = tree.towards[n];
        if (k < 0) {
            continue;
        }
        auto const& piece = p.pieces[static_cast<std::size_t>(k)];
        int const vote = votes[static_cast<std::size_t>(k)];
        if (vote == 0 || (vote > 0) == (piece.from == n)) {
            continue;
        }
        std::size_t const place = other_end(piece, n); // left by this piece and by the one towards the outlet
        auto const& next = p.pieces[static_cast<std::size_t>(tree.towards[place])];
        Vec2 const at = p.nodes[place];
        throw BadInput(fmt::format("network.adopt: rivers {} and {} in {} both run away from ({:.6f}, {:.6f}) by {}; "
                                   "water has one way down from every place: remove one, or orient by something else",
                                   lines[piece.line].feature, lines[next.line].feature, name, at.x, at.y, evidence));
    }
    throw BadInput("network.adopt: the rivers of " + name + " cannot be oriented by " + evidence);
}

// [m] By node: distance to the border of the lines' box.
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

void report_turned(Pieces const& p, std::vector<RiverLine> const& lines, std::vector<std::int64_t> const& leaves,
                   std::vector<Finding>& repairs) {
    std::vector<double> length_m(lines.size(), 0.0);
    std::vector<Vec2> towards(lines.size());
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        if (leaves[n] < 0) {
            continue;
        }
        auto const& piece = p.pieces[static_cast<std::size_t>(leaves[n])];
        if (piece.to == n) {
            towards[piece.line] = p.nodes[piece.from];
            length_m[piece.line] += piece.length_m;
        }
    }
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (length_m[l] > 0.0) {
            repairs.push_back({"reversed", lines[l].feature, towards[l], length_m[l],
                               fmt::format("river {} is turned round for {:.6g} m, to run towards ({:.6f}, {:.6f})",
                                           lines[l].feature, length_m[l], towards[l].x, towards[l].y)});
        }
    }
}

} // namespace

std::vector<std::int64_t> orient(Pieces const& p, std::vector<RiverLine> const& lines, RiverLines const& file,
                                 Orientation orientation, std::vector<Finding>& repairs) {
    auto const evidence = evidence_of(p, lines, file, orientation);
    Evidence const silence{Votes(p.pieces.size(), 0), "nothing"};
    Votes const drawn(p.pieces.size(), orientation == Orientation::topology ? 0 : 1);
    auto const border_m = border_distances(p, lines);
    std::vector<std::int64_t> leaves(p.nodes.size(), -1);
    std::vector<std::int64_t> cost(p.nodes.size(), 0);
    std::vector<char> done(p.nodes.size(), 0);
    for (std::size_t start = 0; start < p.nodes.size(); ++start) {
        if (done[start] != 0) {
            continue;
        }
        Tree tree{{}, leaves};
        root_at(p, start, tree);
        auto const speaks = [&](Evidence const& e) {
            return std::ranges::any_of(tree.nodes, [&](std::size_t n) {
                return leaves[n] >= 0 && e.votes[static_cast<std::size_t>(leaves[n])] != 0;
            });
        };
        auto const first = std::ranges::find_if(evidence, speaks);
        Evidence const& chosen = first == evidence.end() ? silence : *first;
        auto const against_it = against(p, tree, chosen.votes, cost);
        auto const against_drawn = against(p, tree, drawn, cost);
        auto const key = [&](std::size_t i) {
            std::size_t const n = tree.nodes[i];
            bool const inner = p.at_node[n].size() > 1;
            return std::tuple(against_it[i], against_drawn[i], inner, border_m[n], n);
        };
        std::size_t best = 0;
        for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
            if (key(i) < key(best)) {
                best = i;
            }
        }
        bool const contradicted = against_it[best] > 0;
        root_at(p, tree.nodes[best], tree);
        if (contradicted) {
            refuse_bifurcation(p, lines, tree, chosen.votes, file.name, chosen.name);
        }
        for (std::size_t const n : tree.nodes) {
            done[n] = 1;
        }
    }
    report_turned(p, lines, leaves, repairs);
    return leaves;
}

} // namespace thalweg::network::adopt_steps
