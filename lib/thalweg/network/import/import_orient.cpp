// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

// Described in docs/algorithms/river_directions.md.

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
                                  std::vector<std::int64_t>& cost, std::vector<std::int64_t> const& weights) {
    auto const gain = [&](std::size_t n) { // from the node downstream to n
        PieceId const k = tree.towards[n];
        std::int64_t const w = (weights.empty() ? weight(p.pieces[k]) : weights[k]) * votes[k];
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

// By piece, in whole micrometres: an outlet up to which water would climb least is the most likely one.
std::vector<std::int64_t> falls_of(Pieces const& p, std::vector<RiverLine> const& lines) {
    std::vector<std::int64_t> falls;
    for (auto const& piece : p.pieces) {
        auto const& v = lines[piece.line].vertices;
        double const fall_m = std::fabs(v[piece.first].z - v[piece.last].z);
        falls.push_back(std::max(std::int64_t{1}, static_cast<std::int64_t>(std::floor(fall_m * 1e6))));
    }
    return falls;
}

// The piece of least rank at a node leaves it; the others flow into it. (A piece whose rank is above its neighbours' at
// both ends votes for one of them: the other neighbour contradicts it.)
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
            if (at_to && at_from) { // a channel beside others: towards the lowest rank
                vote = least(piece.from) < least(piece.to) ? -1 : 1;
            } else if (at_to) {
                vote = 1;
            } else if (at_from) {
                vote = -1;
            } else { // the last reach flows away from its tributaries
                vote = int{some(piece.from, higher)} - int{some(piece.to, higher)};
            }
        }
        votes.push_back(vote);
    }
    return votes;
}

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

// By line: the nodes where it begins and ends; none for a line without pieces.
struct LineEnds {
    std::vector<std::size_t> first;
    std::vector<std::size_t> last;
};

LineEnds ends_of(Pieces const& p, std::vector<RiverLine> const& lines) {
    LineEnds ends{std::vector<std::size_t>(lines.size(), none), std::vector<std::size_t>(lines.size(), none)};
    for (auto const& piece : p.pieces) {
        ends.first[piece.line] = ends.first[piece.line] == none ? piece.from : ends.first[piece.line];
        ends.last[piece.line] = piece.to;
    }
    return ends;
}

Votes of_pieces(Pieces const& p, Votes const& of_line) {
    Votes votes;
    for (auto const& piece : p.pieces) {
        votes.push_back(of_line[piece.line]);
    }
    return votes;
}

// A node of the file lies where most of the lines that name it have an end. Nodes that all follow the drawn direction
// repeat it, and say nothing.
Votes by_nodes(Pieces const& p, std::vector<RiverLine> const& lines) {
    auto const [first, last] = ends_of(p, lines);
    auto const has_nodes = [&, &from = first, &to = last](std::size_t l) {
        return lines[l].from_node != 0 && lines[l].to_node != 0 && from[l] != to[l];
    };
    std::map<std::pair<std::int64_t, std::size_t>, int> claims;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        for (std::int64_t const node : {lines[l].from_node, lines[l].to_node}) {
            if (has_nodes(l)) {
                ++claims[{node, first[l]}];
                ++claims[{node, last[l]}];
            }
        }
    }
    Votes of_line(lines.size(), 0);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (has_nodes(l) && lines[l].from_node != lines[l].to_node) {
            int const forth = claims[{lines[l].from_node, first[l]}] + claims[{lines[l].to_node, last[l]}];
            int const back = claims[{lines[l].from_node, last[l]}] + claims[{lines[l].to_node, first[l]}];
            of_line[l] = int{forth > back} - int{forth < back};
        }
    }
    return std::ranges::count(of_line, -1) == 0 ? Votes(p.pieces.size(), 0) : of_pieces(p, of_line);
}

// A line ends where it meets the line that the file names as downstream, and begins where it meets those that name it.
Votes by_links(Pieces const& p, std::vector<RiverLine> const& lines) {
    auto const [first, last] = ends_of(p, lines);
    auto const meets = [&](std::size_t node, auto const& test) {
        return std::ranges::any_of(p.at_node[node], [&](std::size_t k) { return test(lines[p.pieces[k].line]); });
    };
    Votes of_line(lines.size(), 0);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        RiverLine const& line = lines[l];
        if (first[l] == none || first[l] == last[l] || line.feature == 0) { // the last: through a lake
            continue;
        }
        auto const is_next = [&](RiverLine const& o) { return line.down != 0 && o.feature == line.down; };
        auto const names_it = [&](RiverLine const& o) { return o.down == line.feature; };
        int vote = int{meets(last[l], is_next)} - int{meets(first[l], is_next)};
        if (vote == 0) {
            vote = int{meets(first[l], names_it)} - int{meets(last[l], names_it)};
        }
        of_line[l] = vote;
    }
    return of_pieces(p, of_line);
}

// How often a rank falls and rises downstream, by something else that the file says.
struct Sense {
    std::size_t falls = 0;
    std::size_t rises = 0;
    char const* by = "";

    void add(std::int64_t above, std::int64_t below) {
        falls += above != 0 && below != 0 && above > below ? 1 : 0;
        rises += above != 0 && below != 0 && above < below ? 1 : 0;
    }
    double share() const { return static_cast<double>(rises) / static_cast<double>(falls + rises); }
};

Sense sense_by_links(std::vector<RiverLine> const& lines) {
    std::map<std::int64_t, std::int64_t> rank_of;
    for (RiverLine const& line : lines) {
        rank_of.emplace(line.feature, line.rank);
    }
    Sense sense{.by = "the file's links"};
    for (RiverLine const& line : lines) {
        if (auto const below = rank_of.find(line.down); line.down != 0 && below != rank_of.end()) {
            sense.add(line.rank, below->second);
        }
    }
    return sense;
}

// Of the lines that meet the one with the largest area is downstream.
Sense sense_by_areas(Pieces const& p, std::vector<RiverLine> const& lines) {
    Sense sense{.by = "the file's areas"};
    for (std::vector<PieceId> const& at : p.at_node) {
        auto const area = [&](PieceId k) { return lines[p.pieces[k].line].area_m2; };
        auto const largest = std::ranges::max_element(at, {}, area);
        for (PieceId const k : at) {
            if (area(k) > 0.0 && area(k) < area(*largest)) {
                sense.add(lines[p.pieces[k].line].rank, lines[p.pieces[*largest].line].rank);
            }
        }
    }
    return sense;
}

// As the lines are drawn, where these meet more often than they fork.
Sense sense_by_drawing(Pieces const& p, std::vector<RiverLine> const& lines) {
    Sense sense{.by = "the drawn direction"};
    std::size_t meet = 0;
    std::size_t fork = 0;
    for (std::size_t n = 0; n < p.nodes.size(); ++n) {
        std::size_t arriving = 0;
        std::size_t leaving = 0;
        for (PieceId const k : p.at_node[n]) {
            arriving += p.pieces[k].to == n ? 1 : 0;
            leaving += p.pieces[k].from == n ? 1 : 0;
            for (PieceId const other : p.at_node[n]) {
                if (p.pieces[k].to == n && p.pieces[other].from == n) {
                    sense.add(lines[p.pieces[k].line].rank, lines[p.pieces[other].line].rank);
                }
            }
        }
        meet += arriving > 1 && leaving == 1 ? 1 : 0;
        fork += leaving > 1 && arriving == 1 ? 1 : 0;
    }
    return meet > fork ? sense : Sense{};
}

void turn_ranks(Pieces const& p, std::vector<RiverLine>& lines, std::string const& field,
                std::vector<Finding>& repairs) {
    constexpr std::size_t enough = 3;
    constexpr double most = 0.8;
    constexpr double nearly_all = 0.95;
    std::array<std::pair<Sense, double>, 3> const senses{
        {{sense_by_links(lines), most}, {sense_by_areas(p, lines), most}, {sense_by_drawing(p, lines), nearly_all}}};
    auto const decides = [&](auto const& said) {
        auto const& [sense, share] = said;
        return sense.falls + sense.rises >= enough && (sense.share() >= share || sense.share() <= 1.0 - share);
    };
    auto const first = std::ranges::find_if(senses, decides);
    if (first == senses.end() || first->first.share() < 0.5) {
        return;
    }
    std::int64_t const high = std::ranges::max_element(lines, {}, &RiverLine::rank)->rank;
    for (RiverLine& line : lines) {
        line.rank = line.rank == 0 ? 0 : high + 1 - line.rank;
    }
    Sense const& sense = first->first;
    repairs.push_back({"turned_rank", 0, nowhere, sense.share(),
                       fmt::format("the rank{}{} rises downstream at {} of {} places by {}: it counts the other way "
                                   "round",
                                   field.empty() ? "" : " ", field, sense.rises, sense.falls + sense.rises, sense.by)});
}

bool is_through_lake(Piece const& piece, std::vector<RiverLine> const& lines) {
    return lines[piece.line].feature == 0;
}

/// The same pieces where each lake that lines run through is one place.
Pieces with_lakes_as_places(Pieces const& pieces, std::vector<RiverLine> const& lines) {
    Sets places(pieces.nodes.size());
    for (Piece const& piece : pieces.pieces) {
        if (is_through_lake(piece, lines)) {
            places.join(piece.from, piece.to);
        }
    }
    Pieces merged = pieces;
    merged.at_node.assign(pieces.nodes.size(), {});
    for (PieceId k = 0; k < merged.pieces.size(); ++k) {
        Piece& piece = merged.pieces[k];
        piece.from = places.of(piece.from);
        piece.to = places.of(piece.to);
        merged.at_node[piece.from].push_back(k);
        if (piece.from != piece.to) {
            merged.at_node[piece.to].push_back(k);
        }
    }
    return merged;
}

// A component is a tree, so that its outlet determines the direction of every piece. Each kind of evidence is a vote of
// every piece for one of its ends; the outlet is the node with the least length of opposing votes.

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
        std::size_t const place = other_end(piece, n); // both this piece and the one towards the outlet leave it
        auto const& next = p.pieces[tree.towards[place]];
        Vec2 const at = p.nodes[place];
        throw BadInput(
            "network.import_lines",
            fmt::format("rivers {} and {} in {} both run away from ({:.6f}, {:.6f}) by {}; water has one way down from "
                        "every place: remove one, or orient by something else (network.lines.orientation)",
                        lines[piece.line].number(), lines[next.line].number(), name, at.x, at.y, evidence));
    }
    throw BadInput("network.import_lines", "the rivers of " + name + " cannot be oriented by " + evidence);
}

} // namespace

std::vector<Evidence> evidence_of(Pieces const& pieces, std::vector<RiverLine>& lines, RiverLines const& file,
                                  Orientation asked, std::vector<Finding>& repairs) {
    bool const any_lake =
        std::ranges::any_of(pieces.pieces, [&](Piece const& piece) { return is_through_lake(piece, lines); });
    std::optional<Pieces> const merged = any_lake ? std::optional(with_lakes_as_places(pieces, lines)) : std::nullopt;
    Pieces const& p = merged ? *merged : pieces;
    if (asked != Orientation::rank) {
        turn_ranks(p, lines, file.rank_field, repairs);
    }
    bool const any_rank = std::ranges::any_of(lines, [](RiverLine const& l) { return l.rank != 0; });
    if (asked == Orientation::height && !file.has_z) {
        throw BadInput("network.import_lines", "the rivers of " + file.name + " carry no heights to orient them by");
    }
    if (asked == Orientation::rank && !any_rank) {
        throw BadInput("network.import_lines", "the rivers of " + file.name + " carry no rank to orient them by");
    }
    std::vector<Evidence> evidence;
    bool const any_link = std::ranges::any_of(lines, [](RiverLine const& l) { return l.down != 0; });
    if (any_link && (asked == Orientation::automatic || asked == Orientation::links)) {
        evidence.push_back({Evidence::Kind::links, by_links(p, lines), "the file's links"});
    }
    bool const any_node = std::ranges::any_of(lines, [](RiverLine const& l) { return l.to_node != 0; });
    if (any_node && (asked == Orientation::automatic || asked == Orientation::links)) {
        evidence.push_back({Evidence::Kind::nodes, by_nodes(p, lines), "the file's nodes"});
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
        evidence.push_back({Evidence::Kind::height, by_height(p, lines), "height", falls_of(p, lines)});
    }
    if (any_rank && (asked == Orientation::rank || asked == Orientation::automatic)) {
        evidence.push_back({Evidence::Kind::rank, by_rank(p, lines), "rank"});
    }
    if (asked == Orientation::as_drawn) {
        evidence.push_back({Evidence::Kind::drawn, Votes(p.pieces.size(), 1), "the drawn direction"});
    }
    return evidence;
}

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
        auto const against_it = against(p, tree, chosen.votes, cost, chosen.weights);
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
