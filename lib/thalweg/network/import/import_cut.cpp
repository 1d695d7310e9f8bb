// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <limits>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

constexpr std::size_t no_owner = std::numeric_limits<std::size_t>::max();

struct Hash {
    static std::size_t mix(std::uint64_t a, std::uint64_t b) {
        std::uint64_t h = (a ^ (b * 0x9e3779b97f4a7c15ULL)) * 0xbf58476d1ce4e5b9ULL;
        return static_cast<std::size_t>(h ^ (h >> 29));
    }
    std::size_t operator()(Vec2 p) const {
        return mix(std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y));
    }
    std::size_t operator()(std::pair<std::size_t, std::size_t> e) const { return mix(e.first, e.second); }
};

// Vertices by number in the order of the lines; positions equal bit for bit are one vertex.
struct Numbering {
    std::vector<Vec2> at;
    std::vector<std::vector<std::size_t>> of_line;
};

Numbering number(std::vector<RiverLine> const& lines) {
    Numbering numbering;
    std::unordered_map<Vec2, std::size_t, Hash> known;
    for (auto const& line : lines) {
        auto& numbers = numbering.of_line.emplace_back();
        for (auto const& v : line.vertices) {
            auto const [entry, fresh] = known.try_emplace(Vec2{v.x, v.y}, numbering.at.size());
            if (fresh) {
                numbering.at.push_back(entry->first);
            }
            numbers.push_back(entry->second);
        }
    }
    return numbering;
}

// For every segment of every line the line that has it first.
std::vector<std::vector<std::size_t>> owners_of(Numbering const& numbering) {
    std::unordered_map<std::pair<std::size_t, std::size_t>, std::size_t, Hash> known;
    std::vector<std::vector<std::size_t>> owners;
    for (std::size_t l = 0; l < numbering.of_line.size(); ++l) {
        auto const& v = numbering.of_line[l];
        auto& of_line = owners.emplace_back();
        for (std::size_t i = 0; i + 1 < v.size(); ++i) {
            auto const [entry, fresh] = known.try_emplace(std::minmax(v[i], v[i + 1]), l);
            of_line.push_back(fresh ? no_owner : entry->second);
        }
    }
    return owners;
}

/// The vertices of all lines, and how the lines meet there.
struct Junctions {
    Numbering numbering;
    std::vector<std::vector<std::size_t>> owners;
    std::vector<int> degree;  ///< by vertex: segments, each counted for the line that has it first
    std::vector<char> is_end; ///< by vertex: whether a line ends there
};

Junctions junctions_of(std::vector<RiverLine> const& lines) {
    Junctions j{number(lines), {}, {}, {}};
    j.owners = owners_of(j.numbering);
    j.degree.assign(j.numbering.at.size(), 0);
    j.is_end.assign(j.numbering.at.size(), 0);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        auto const& v = j.numbering.of_line[l];
        j.is_end[v.front()] = j.is_end[v.back()] = 1;
        for (std::size_t i = 0; i + 1 < v.size(); ++i) {
            if (j.owners[l][i] == no_owner) {
                ++j.degree[v[i]];
                ++j.degree[v[i + 1]];
            }
        }
    }
    return j;
}

/// Vertices first ... last of a line, up to where rivers meet or the line begins or ceases to repeat another.
struct Part {
    std::size_t first;
    std::size_t last;
    double length;
};

Part part_from(Junctions const& j, std::size_t line, std::size_t first) {
    auto const& v = j.numbering.of_line[line];
    auto const& owners = j.owners[line];
    std::size_t i = first;
    double length = 0.0;
    do {
        length += distance(j.numbering.at[v[i]], j.numbering.at[v[i + 1]]);
        ++i;
    } while (i + 1 < v.size() && owners[i] == owners[first] &&
             (owners[first] != no_owner || (j.degree[v[i]] == 2 && j.is_end[v[i]] == 0)));
    return {first, i, length};
}

void leave_out(RiverLine const& line, Part const& part, RiverLine const& owner, Left& left) {
    auto const begin = line.vertices.begin();
    auto const& from = line.vertices[part.first];
    left.secondary.push_back(
        {line.feature,
         {begin + static_cast<std::ptrdiff_t>(part.first), begin + static_cast<std::ptrdiff_t>(part.last) + 1},
         "duplicate",
         line.feature,
         LeftOut::duplicate});
    left.repairs.push_back({"duplicate", line.number(), Vec2{from.x, from.y}, part.length,
                            fmt::format("river {} repeats river {} for {:.6g} m; that part is left out", line.number(),
                                        owner.number(), part.length)});
}

/// Drops the end at the front of a line where it passes the first river that it meets by most_m or less.
void drop_overshoot(RiverLine& line, std::vector<std::size_t>& numbers, Junctions const& j, double most_m, Left& left) {
    std::size_t i = 0;
    double length_m = 0.0;
    while (i + 1 < numbers.size() && j.degree[numbers[i]] == (i == 0 ? 1 : 2)) {
        length_m += distance(j.numbering.at[numbers[i]], j.numbering.at[numbers[i + 1]]);
        ++i;
    }
    if (i == 0 || i + 1 >= numbers.size() || length_m > most_m) {
        return;
    }
    Vec2 const at = j.numbering.at[numbers[i]];
    auto const begin = line.vertices.begin();
    auto const end = static_cast<std::ptrdiff_t>(i);
    left.repairs.push_back({"cut", line.number(), at, length_m,
                            fmt::format("river {} passes the river that it meets at ({:.6f}, {:.6f}) by {:.3g} m; that "
                                        "end is removed",
                                        line.number(), at.x, at.y, length_m)});
    left.secondary.push_back(
        {line.feature, {begin, begin + end + 1}, "passes the river that it meets", line.feature, LeftOut::too_short});
    line.vertices.erase(begin, begin + end);
    numbers.erase(numbers.begin(), numbers.begin() + end);
}

} // namespace

void drop_overshoots(std::vector<RiverLine>& lines, double most_m, Left& left) {
    Junctions j = junctions_of(lines);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        auto& vertices = lines[l].vertices;
        auto& numbers = j.numbering.of_line[l];
        drop_overshoot(lines[l], numbers, j, most_m, left);
        std::ranges::reverse(vertices);
        std::ranges::reverse(numbers);
        drop_overshoot(lines[l], numbers, j, most_m, left);
        std::ranges::reverse(vertices);
        std::ranges::reverse(numbers);
    }
}

void refuse_cycles(Pieces const& p, std::vector<RiverLine> const& lines, std::string const& name) {
    Sets sets(p.nodes.size());
    for (std::size_t closing = 0; closing < p.pieces.size(); ++closing) {
        auto const& piece = p.pieces[closing];
        if (sets.join(piece.from, piece.to)) {
            continue;
        }
        // The way round: breadth first through the pieces before the closing one.
        std::vector<std::size_t> came_by(p.nodes.size(), no_owner);
        std::vector<std::size_t> queue{piece.from};
        auto const other = [&](std::size_t k, std::size_t n) {
            return p.pieces[k].from == n ? p.pieces[k].to : p.pieces[k].from;
        };
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (std::size_t const k : p.at_node[queue[i]]) {
                std::size_t const n = other(k, queue[i]);
                if (k < closing && n != piece.from && came_by[n] == no_owner) {
                    came_by[n] = k;
                    queue.push_back(n);
                }
            }
        }
        std::vector<std::int64_t> features{lines[piece.line].number()};
        for (std::size_t n = piece.to; n != piece.from; n = other(came_by[n], n)) {
            features.push_back(lines[p.pieces[came_by[n]].line].number());
        }
        std::ranges::sort(features);
        features.erase(std::unique(features.begin(), features.end()), features.end());
        constexpr std::size_t most_named = 8;
        std::string named;
        for (std::size_t i = 0; i < std::min(features.size(), most_named); ++i) {
            named += fmt::format("{}{}", i == 0 ? "" : i + 1 == features.size() ? " and " : ", ", features[i]);
        }
        if (features.size() > most_named) {
            named += fmt::format(" and {} more", features.size() - most_named);
        }
        Vec2 const at = p.nodes[piece.from];
        Vec2 const through = p.nodes[piece.to];
        throw BadInput(
            fmt::format("network.import_lines: river{} {} in {} {} a cycle through ({:.6f}, {:.6f}) and ({:.6f}, "
                        "{:.6f}); water has one way down from every place: remove one "
                        "branch, or keep the main one by divergences = \"main\"",
                        features.size() == 1 ? "" : "s", named, name, features.size() == 1 ? "forms" : "form", at.x,
                        at.y, through.x, through.y));
    }
}

Pieces cut(std::vector<RiverLine> const& lines, Left& left) {
    Junctions const junctions = junctions_of(lines);
    std::vector<Vec2> const& at = junctions.numbering.at;
    Pieces p;
    std::vector<std::size_t> node_of(at.size(), no_owner);
    auto const node = [&](std::size_t vertex) {
        if (node_of[vertex] == no_owner) {
            node_of[vertex] = p.nodes.size();
            p.nodes.push_back(at[vertex]);
            p.at_node.emplace_back();
        }
        return node_of[vertex];
    };
    for (std::size_t l = 0; l < lines.size(); ++l) {
        auto const& v = junctions.numbering.of_line[l];
        for (std::size_t i = 0; i + 1 < v.size();) {
            Part const part = part_from(junctions, l, i);
            std::size_t const owner = junctions.owners[l][i];
            i = part.last;
            if (owner == no_owner) {
                std::size_t const from = node(v[part.first]);
                p.pieces.push_back({l, part.first, part.last, from, node(v[part.last]), part.length});
            } else {
                leave_out(lines[l], part, lines[owner], left);
            }
            if (i + 1 < v.size() && junctions.degree[v[i]] > 2) {
                left.repairs.push_back({"split", lines[l].number(), at[v[i]],
                                        static_cast<double>(junctions.degree[v[i]]),
                                        fmt::format("river {} is divided at ({:.6f}, {:.6f}), where rivers meet",
                                                    lines[l].number(), at[v[i]].x, at[v[i]].y)});
            }
        }
    }
    for (std::size_t k = 0; k < p.pieces.size(); ++k) {
        p.at_node[p.pieces[k].from].push_back(k);
        if (p.pieces[k].to != p.pieces[k].from) {
            p.at_node[p.pieces[k].to].push_back(k);
        }
    }
    return p;
}

} // namespace thalweg::network::import_steps
