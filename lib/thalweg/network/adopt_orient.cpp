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

// A node is left by the piece of least rank that touches it; the others run into it.
Votes by_rank(Pieces const& p, std::vector<RiverLine> const& lines, std::string const& name) {
    auto const rank = [&](std::size_t k) { return lines[p.pieces[k].line].rank; };
    Votes votes(p.pieces.size(), 0);
    for (std::size_t k = 0; k < p.pieces.size(); ++k) {
        if (rank(k) == 0) {
            continue;
        }
        auto const some = [&](std::size_t node, auto const& test) {
            return std::ranges::any_of(p.at_node[node],
                                       [&](std::size_t other) { return rank(other) != 0 && test(rank(other)); });
        };
        auto const lower = [&](std::int64_t r) { return r < rank(k); };
        auto const higher = [&](std::int64_t r) { return r > rank(k); };
        auto const& piece = p.pieces[k];
        bool const at_from = some(piece.from, lower);
        bool const at_to = some(piece.to, lower);
        if (at_from && at_to) {
            Vec2 const a = p.nodes[piece.from];
            Vec2 const b = p.nodes[piece.to];
            throw BadInput(fmt::format("network.adopt: river {} in {} has a greater rank ({}) than the rivers at both "
                                       "its ends, ({:.6f}, {:.6f}) and ({:.6f}, {:.6f}): it would run both ways; "
                                       "correct the ranks or orient by something else",
                                       lines[piece.line].feature, name, rank(k), a.x, a.y, b.x, b.y));
        }
        if (at_from || at_to) {
            votes[k] = at_to ? 1 : -1;
        } else if (some(piece.from, higher) != some(piece.to, higher)) {
            votes[k] = some(piece.from, higher) ? 1 : -1; // the last reach, away from what runs into it
        }
    }
    return votes;
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

} // namespace

std::vector<std::int64_t> orient(Pieces const& p, std::vector<RiverLine> const& lines, RiverLines const& file,
                                 Orientation orientation, std::vector<Finding>& repairs) {
    auto const asked = [&](Orientation o) { return orientation == o || orientation == Orientation::automatic; };
    bool const any_rank = std::ranges::any_of(lines, [](RiverLine const& l) { return l.rank != 0; });
    if (orientation == Orientation::height && !file.has_z) {
        throw BadInput("network.adopt: the rivers of " + file.name + " carry no heights to orient them by");
    }
    if (orientation == Orientation::rank && !any_rank) {
        throw BadInput("network.adopt: the rivers of " + file.name + " carry no rank to orient them by");
    }
    Votes const silent(p.pieces.size(), 0);
    Votes const heights = file.has_z && asked(Orientation::height) ? by_height(p, lines) : silent;
    Votes const drawn = orientation == Orientation::topology ? silent : Votes(p.pieces.size(), 1);
    Votes ranks = silent;
    bool ranks_read = false;

    Vec2 low = p.nodes.front();
    Vec2 high = low;
    for (auto const& line : lines) {
        for (auto const& v : line.vertices) {
            low = {std::min(low.x, v.x), std::min(low.y, v.y)};
            high = {std::max(high.x, v.x), std::max(high.y, v.y)};
        }
    }
    auto const to_border = [&](std::size_t n) {
        Vec2 const at = p.nodes[n];
        return std::min({at.x - low.x, high.x - at.x, at.y - low.y, high.y - at.y});
    };

    std::vector<std::int64_t> towards(p.nodes.size(), -1);
    std::vector<char> done(p.nodes.size(), 0);
    std::vector<std::int64_t> cost(p.nodes.size(), 0);
    for (std::size_t start = 0; start < p.nodes.size(); ++start) {
        if (done[start] != 0) {
            continue;
        }
        Tree tree{{}, towards};
        root_at(p, start, tree);
        auto const speaks = [&](Votes const& votes) {
            return std::ranges::any_of(tree.nodes, [&](std::size_t n) {
                return towards[n] >= 0 && votes[static_cast<std::size_t>(towards[n])] != 0;
            });
        };
        Votes const* votes = &silent;
        char const* evidence = "topology";
        if (speaks(heights)) {
            votes = &heights;
            evidence = "height";
        } else if (any_rank && asked(Orientation::rank)) {
            if (!ranks_read) {
                ranks = by_rank(p, lines, file.name);
                ranks_read = true;
            }
            if (speaks(ranks)) {
                votes = &ranks;
                evidence = "rank";
            }
        }
        auto main = against(p, tree, *votes, cost);
        auto second = against(p, tree, drawn, cost);
        if (votes == &silent && orientation != Orientation::topology) {
            bool const is_tree = *std::ranges::min_element(second) == 0;
            if (is_tree || orientation == Orientation::as_drawn) {
                votes = &drawn;
                evidence = "the drawn direction";
                main = second;
            } else {
                std::ranges::fill(second, 0);
            }
        }
        std::size_t best = 0;
        auto const key = [&](std::size_t i) {
            std::size_t const n = tree.nodes[i];
            bool const inner = votes == &silent && p.at_node[n].size() > 1;
            return std::tuple(main[i], second[i], inner, to_border(n), n);
        };
        for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
            if (key(i) < key(best)) {
                best = i;
            }
        }
        bool const contradicted = main[best] > 0;
        root_at(p, tree.nodes[best], tree);
        if (contradicted) {
            refuse_bifurcation(p, lines, tree, *votes, file.name, evidence);
        }
        for (std::size_t const n : tree.nodes) {
            done[n] = 1;
        }
    }

    std::vector<double> turned_m(lines.size(), 0.0);
    std::vector<Vec2> turned_at(lines.size());
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        if (towards[n] < 0) {
            continue;
        }
        auto const& piece = p.pieces[static_cast<std::size_t>(towards[n])];
        if (piece.to == n) {
            turned_at[piece.line] = p.nodes[piece.from];
            turned_m[piece.line] += piece.length_m;
        }
    }
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (turned_m[l] > 0.0) {
            repairs.push_back({"reversed", lines[l].feature, turned_at[l], turned_m[l],
                               fmt::format("river {} is turned round for {:.6g} m, to run towards ({:.6f}, {:.6f})",
                                           lines[l].feature, turned_m[l], turned_at[l].x, turned_at[l].y)});
        }
    }
    return towards;
}

} // namespace thalweg::network::adopt_steps
