// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

// A component is a tree, so its outlet alone says which way every piece runs. Each kind of evidence is a vote of every
// piece for one of its ends; the outlet is the node against which the least length votes.
namespace thalweg::network::import_steps {
namespace {

[[noreturn]] void refuse_bifurcation(Pieces const& p, std::vector<RiverLine> const& lines, Tree const& tree,
                                     Votes const& votes, std::string const& name, char const* evidence) {
    for (std::size_t const n : tree.nodes) {
        auto const k = tree.towards[n];
        if (k == no_piece) {
            continue;
        }
        auto const& piece = p.pieces[k];
        int const vote = votes[k];
        if (vote == 0 || (vote > 0) == (piece.from == n)) {
            continue;
        }
        std::size_t const place = other_end(piece, n); // left by this piece and by the one towards the outlet
        auto const& next = p.pieces[tree.towards[place]];
        Vec2 const at = p.nodes[place];
        throw BadInput(
            fmt::format("network.import_lines: rivers {} and {} in {} both run away from ({:.6f}, {:.6f}) by {}; "
                        "water has one way down from every place: remove one, or orient by something else",
                        lines[piece.line].number(), lines[next.line].number(), name, at.x, at.y, evidence));
    }
    throw BadInput("network.import_lines: the rivers of " + name + " cannot be oriented by " + evidence);
}

} // namespace

void report_turned(Pieces const& p, std::vector<RiverLine> const& lines, std::vector<PieceId> const& leaves,
                   std::vector<Finding>& repairs) {
    std::vector<double> length_m(lines.size(), 0.0);
    std::vector<Vec2> towards(lines.size());
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        if (leaves[n] == no_piece) {
            continue;
        }
        auto const& piece = p.pieces[leaves[n]];
        if (piece.to == n) {
            towards[piece.line] = p.nodes[piece.from];
            length_m[piece.line] += piece.length_m;
        }
    }
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (length_m[l] > 0.0) {
            repairs.push_back({"reversed", lines[l].number(), towards[l], length_m[l],
                               fmt::format("river {} is turned round for {:.6g} m, to run towards ({:.6f}, {:.6f})",
                                           lines[l].number(), length_m[l], towards[l].x, towards[l].y)});
        }
    }
}

std::vector<PieceId> orient(Pieces const& p, std::vector<RiverLine> const& lines, RiverLines const& file,
                            ImportParams const& params, std::vector<Evidence> const& evidence,
                            std::vector<int> const& drawn_or_found) {
    Orientation const orientation = params.orientation;
    Evidence const silence{Evidence::Kind::drawn, Votes(p.pieces.size(), 0), "nothing"};
    Votes const drawn = orientation == Orientation::topology ? Votes(p.pieces.size(), 0) : drawn_or_found;
    auto const border_m = border_distances(p, lines);
    std::vector<PieceId> leaves(p.nodes.size(), no_piece);
    std::vector<std::int64_t> cost(p.nodes.size(), 0);
    std::vector<char> done(p.nodes.size(), 0);
    for (std::size_t start = 0; start < p.nodes.size(); ++start) {
        if (done[start] != 0) {
            continue;
        }
        Tree tree{{}, leaves};
        root_at(p, start, tree);
        auto const speaks = [&](Evidence const& e) {
            return std::ranges::any_of(tree.nodes,
                                       [&](std::size_t n) { return leaves[n] != no_piece && e.votes[leaves[n]] != 0; });
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
        if (contradicted && params.divergences == Divergences::error) {
            refuse_bifurcation(p, lines, tree, chosen.votes, file.name, chosen.name);
        }
        for (std::size_t const n : tree.nodes) {
            done[n] = 1;
        }
    }
    return leaves;
}

} // namespace thalweg::network::import_steps
