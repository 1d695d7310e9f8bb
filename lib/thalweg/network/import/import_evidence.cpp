// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/internal/import_lines.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <thalweg/core/run/error.hpp>

namespace thalweg::network::import_steps {
namespace {

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
    auto const least = [&](std::size_t node) {
        std::int64_t result = std::numeric_limits<std::int64_t>::max();
        for (std::size_t const k : p.at_node[node]) {
            result = rank(k) != 0 ? std::min(result, rank(k)) : result;
        }
        return result;
    };
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
            bool const at_to = some(piece.to, lower);
            bool const at_from = some(piece.from, lower);
            if (at_to && at_from) { // a channel beside others: where the least of them is
                vote = least(piece.from) < least(piece.to) ? -1 : 1;
            } else if (at_to) {
                vote = 1;
            } else if (at_from) {
                vote = -1;
            } else { // the last reach runs away from what runs into it
                vote = int{some(piece.from, higher)} - int{some(piece.to, higher)};
            }
        }
        votes.push_back(vote);
    }
    return votes;
}

// A line ends where it meets the line that the file names as the next downstream, and begins where it meets those that
// name it.
Votes by_links(Pieces const& p, std::vector<RiverLine> const& lines) {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> first(lines.size(), none);
    std::vector<std::size_t> last(lines.size(), none);
    for (auto const& piece : p.pieces) {
        first[piece.line] = first[piece.line] == none ? piece.from : first[piece.line];
        last[piece.line] = piece.to;
    }
    auto const meets = [&](std::size_t node, auto const& test) {
        return std::ranges::any_of(p.at_node[node], [&](std::size_t k) { return test(lines[p.pieces[k].line]); });
    };
    Votes of_line(lines.size(), 0);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (first[l] == none || first[l] == last[l]) {
            continue;
        }
        RiverLine const& line = lines[l];
        auto const is_next = [&](RiverLine const& o) { return line.down != 0 && o.feature == line.down; };
        auto const names_it = [&](RiverLine const& o) { return o.down == line.feature; };
        int vote = int{meets(last[l], is_next)} - int{meets(first[l], is_next)};
        if (vote == 0) {
            vote = int{meets(first[l], names_it)} - int{meets(last[l], names_it)};
        }
        of_line[l] = vote;
    }
    Votes votes;
    for (auto const& piece : p.pieces) {
        votes.push_back(of_line[piece.line]);
    }
    return votes;
}

} // namespace

std::vector<Evidence> evidence_of(Pieces const& p, std::vector<RiverLine> const& lines, RiverLines const& file,
                                  Orientation asked) {
    bool const any_rank = std::ranges::any_of(lines, [](RiverLine const& l) { return l.rank != 0; });
    if (asked == Orientation::height && !file.has_z) {
        throw BadInput("network.import_lines: the rivers of " + file.name + " carry no heights to orient them by");
    }
    if (asked == Orientation::rank && !any_rank) {
        throw BadInput("network.import_lines: the rivers of " + file.name + " carry no rank to orient them by");
    }
    std::vector<Evidence> evidence;
    bool const any_link = std::ranges::any_of(lines, [](RiverLine const& l) { return l.down != 0; });
    if (any_link && (asked == Orientation::automatic || asked == Orientation::links)) {
        evidence.push_back({Evidence::Kind::links, by_links(p, lines), "the file's links"});
    }
    bool const any_runs = std::ranges::any_of(lines, [](RiverLine const& l) { return l.runs != 0; });
    if (any_runs && (asked == Orientation::automatic || asked == Orientation::links)) {
        Votes votes;
        for (auto const& piece : p.pieces) {
            votes.push_back(lines[piece.line].runs);
        }
        evidence.push_back({Evidence::Kind::column, std::move(votes), "the direction column"});
    }
    if (file.has_z && (asked == Orientation::height || asked == Orientation::automatic)) {
        evidence.push_back({Evidence::Kind::height, by_height(p, lines), "height"});
    }
    if (any_rank && (asked == Orientation::rank || asked == Orientation::automatic)) {
        evidence.push_back({Evidence::Kind::rank, by_rank(p, lines), "rank"});
    }
    if (asked == Orientation::as_drawn) {
        evidence.push_back({Evidence::Kind::drawn, Votes(p.pieces.size(), 1), "the drawn direction"});
    }
    return evidence;
}

} // namespace thalweg::network::import_steps
