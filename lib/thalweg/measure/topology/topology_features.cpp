// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/measure/topology/internal/topology_steps.hpp>

// What can be said of an arc or node without following the rivers.
namespace thalweg::measure::topology_steps {

namespace {

using Id = std::pair<std::int64_t, std::size_t>; // and the number of its feature

/// The ids that several features have, each with how many and the second of them.
template <class Visit> void each_repeated(std::vector<Id> ids, Visit const& visit) {
    std::sort(ids.begin(), ids.end());
    for (auto first = ids.begin(); first != ids.end();) {
        auto const last = std::find_if(first, ids.end(), [&](Id const& id) { return id.first != first->first; });
        if (last - first > 1) {
            visit(std::span<Id const>(first, last));
        }
        first = last;
    }
}

// id: as the file itself has it.
Finding repeated_id(char const* kind, char const* noun, std::int64_t id, std::size_t count, Vec2 second) {
    return {
        kind, id, second, static_cast<double>(count),
        fmt::format("{} {}: {} {}s have this id, the second at ({}, {})", noun, id, count, noun, second.x, second.y)};
}

std::vector<Vec2> without_repeats(std::vector<Vec3> const& vertices) {
    std::vector<Vec2> line;
    line.reserve(vertices.size());
    for (Vec3 const p : vertices) {
        if (line.empty() || !(line.back() == plan_of(p))) {
            line.push_back(plan_of(p));
        }
    }
    return line;
}

/// A line as it compares with others, whichever way it is drawn.
struct Undirected {
    std::vector<Vec2> const* line;
    bool back;
    std::size_t arc;

    Vec2 vertex(std::size_t i) const { return back ? (*line)[line->size() - 1 - i] : (*line)[i]; }
};

Undirected undirected(std::vector<Vec2> const& line, std::size_t arc) {
    auto const key = [](Vec2 p) { return std::tuple(p.x, p.y); };
    for (std::size_t i = 0, j = line.size() - 1; i < j; ++i, --j) {
        if (line[i] != line[j]) {
            return {&line, key(line[j]) < key(line[i]), arc};
        }
    }
    return {&line, false, arc};
}

/// -1, 0, 1: by number of vertices, then vertex by vertex.
int compare(Undirected const& p, Undirected const& q) {
    if (p.line->size() != q.line->size()) {
        return p.line->size() < q.line->size() ? -1 : 1;
    }
    for (std::size_t i = 0; i < p.line->size(); ++i) {
        Vec2 const a = p.vertex(i);
        Vec2 const b = q.vertex(i);
        if (a != b) {
            return std::tie(a.x, a.y) < std::tie(b.x, b.y) ? -1 : 1;
        }
    }
    return 0;
}

} // namespace

Vec2 start_of(FileArc const& arc) {
    auto const p =
        std::find_if(arc.line.begin(), arc.line.end(), [](Vec3 v) { return is_number(v.x) && is_number(v.y); });
    return p == arc.line.end() ? Vec2{} : plan_of(*p);
}

std::vector<char> check_ids(NetworkFile const& file, Findings& findings) {
    std::vector<char> ambiguous(file.arcs.size(), 0);
    std::vector<Id> ids;
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        FileArc const& arc = file.arcs[a];
        ids.emplace_back(arc.id, a);
        if (arc.id < 1) {
            ambiguous[a] = 1;
            findings.push_back(
                {"bad_arc_id", number_of(file, arc), start_of(arc), static_cast<double>(number_of(file, arc)),
                 fmt::format("arc {}: ids of arcs start at {}", number_of(file, arc), 1 - file.id_shift)});
        }
    }
    each_repeated(std::move(ids), [&](std::span<Id const> same) {
        findings.push_back(repeated_id("duplicate_arc_id", "arc", number_of(file, file.arcs[same[0].second]),
                                       same.size(), start_of(file.arcs[same[1].second])));
        for (Id const& id : same) {
            ambiguous[id.second] = 1;
        }
    });
    ids.clear();
    for (std::size_t n = 0; n < file.nodes.size(); ++n) {
        ids.emplace_back(file.nodes[n].id, n);
    }
    each_repeated(std::move(ids), [&](std::span<Id const> same) {
        Vec3 const second = file.nodes[same[1].second].at;
        findings.push_back(repeated_id("duplicate_node_id", "node", same[0].first, same.size(),
                                       is_number(second.x) && is_number(second.y) ? plan_of(second) : Vec2{}));
    });
    return ambiguous;
}

Plans check_shapes(NetworkFile const& file, Findings& findings) {
    auto const is_place = [&](Vec3 p) {
        return is_number(p.x) && is_number(p.y) && (!file.says.heights || is_number(p.z));
    };
    Plans plans(file.arcs.size());
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        FileArc const& arc = file.arcs[a];
        if (arc.line.size() < 2) {
            findings.push_back(
                {"null_geometry", number_of(file, arc), start_of(arc), static_cast<double>(arc.line.size()),
                 fmt::format("arc {}: has no line ({} vertices)", number_of(file, arc), arc.line.size())});
            continue;
        }
        if (auto const bad =
                arc.line.size() - static_cast<std::size_t>(std::count_if(arc.line.begin(), arc.line.end(), is_place));
            bad > 0) {
            findings.push_back(
                {"nan", number_of(file, arc), start_of(arc), static_cast<double>(bad),
                 fmt::format("arc {}: {} of its {} vertices have coordinates that are not numbers below {}",
                             number_of(file, arc), bad, arc.line.size(), greatest_coordinate)});
            continue;
        }
        plans[a] = without_repeats(arc.line);
        if (length_of(plans[a]) <= 0.0) {
            plans[a].clear();
            findings.push_back({"zero_length", number_of(file, arc), start_of(arc), 0.0,
                                fmt::format("arc {}: has no length, its {} vertices lie at ({}, {})",
                                            number_of(file, arc), arc.line.size(), arc.line[0].x, arc.line[0].y)});
        } else if (std::size_t const repeated = arc.line.size() - plans[a].size(); repeated > 0) {
            auto const second = std::next(std::adjacent_find(arc.line.begin(), arc.line.end(),
                                                             [](Vec3 p, Vec3 q) { return plan_of(p) == plan_of(q); }));
            findings.push_back(
                {"repeated_vertex", number_of(file, arc), plan_of(*second), static_cast<double>(repeated),
                 fmt::format("arc {}: vertex {} at ({}, {}) repeats the one before it ({} such)", number_of(file, arc),
                             second - arc.line.begin(), second->x, second->y, repeated)});
        }
    }
    for (FileNode const& node : file.nodes) {
        if (!is_place(node.at)) {
            findings.push_back({"nan",
                                node.id,
                                {},
                                1.0,
                                fmt::format("node {}: its coordinates ({}, {}, {}) are not numbers below {}", node.id,
                                            node.at.x, node.at.y, node.at.z, greatest_coordinate)});
        }
    }
    return plans;
}

std::vector<char> check_copies(NetworkFile const& file, Plans const& plans, Findings& findings) {
    std::vector<Undirected> lines;
    for (std::size_t a = 0; a < plans.size(); ++a) {
        if (!plans[a].empty()) {
            lines.push_back(undirected(plans[a], a));
        }
    }
    std::sort(lines.begin(), lines.end(), [](Undirected const& p, Undirected const& q) {
        int const order = compare(p, q);
        return order != 0 ? order < 0 : p.arc < q.arc;
    });
    std::vector<char> copies(plans.size(), 0);
    for (std::size_t i = 1, first = 0; i < lines.size(); ++i) {
        if (compare(lines[i], lines[first]) != 0) {
            first = i;
            continue;
        }
        FileArc const& arc = file.arcs[lines[i].arc];
        FileArc const& earlier = file.arcs[lines[first].arc];
        copies[lines[i].arc] = 1;
        findings.push_back({"duplicate_geometry", number_of(file, arc), start_of(arc),
                            static_cast<double>(number_of(file, earlier)),
                            fmt::format("arc {}: lies on the vertices of arc {}, from ({}, {})", number_of(file, arc),
                                        number_of(file, earlier), start_of(arc).x, start_of(arc).y)});
    }
    return copies;
}

} // namespace thalweg::measure::topology_steps
