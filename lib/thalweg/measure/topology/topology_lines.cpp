// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/measure/topology/internal/topology_steps.hpp>

namespace thalweg::measure::topology_steps {
namespace {

// Checks of an arc or node that do not follow the rivers.

using Id = std::pair<std::int64_t, std::size_t>; // and the number of its feature

/// Calls visit for each repeated id, with its count and its second feature.
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

// id: the file's own number.
Finding repeated_id(FindingKind kind, char const* noun, std::int64_t id, std::size_t count, Vec2 second) {
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

/// A line for comparison in either direction.
struct UndirectedLine {
    std::vector<Vec2> const* line;
    bool back;
    std::size_t arc;

    Vec2 vertex(std::size_t i) const { return back ? (*line)[line->size() - 1 - i] : (*line)[i]; }
};

UndirectedLine undirected(std::vector<Vec2> const& line, std::size_t arc) {
    auto const key = [](Vec2 p) { return std::tuple(p.x, p.y); };
    for (std::size_t i = 0, j = line.size() - 1; i < j; ++i, --j) {
        if (line[i] != line[j]) {
            return {&line, key(line[j]) < key(line[i]), arc};
        }
    }
    return {&line, false, arc};
}

/// -1, 0, 1: by number of vertices, then vertex by vertex.
int compare(UndirectedLine const& p, UndirectedLine const& q) {
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

// Where arcs meet themselves and others.

using geometry::Meeting;

/// A place where a line turns back on itself.
struct Spike {
    Vec2 tip;
    Vec2 base;
    double length_m = 0.0;
};

/// Whether the line turns back at its inner vertex i and comes within near_m of itself, or exactly onto itself.
bool turns_back(std::vector<Vec2> const& line, std::size_t i, double near_m, bool exactly, Spike& spike) {
    Vec2 const tip = line[i];
    Vec2 const base = distance(tip, line[i + 1]) < distance(tip, line[i - 1]) ? line[i + 1] : line[i - 1];
    spike = {tip, base, distance(tip, base)};
    return exactly || geometry::is_spike(line[i - 1], tip, line[i + 1], near_m);
}

class MeetingCheck {
public:
    MeetingCheck(NetworkFile const& file, Outlines const& plans, Joints const& joints, double near_m)
        : file_(file), plans_(plans), joints_(joints), near_m_(near_m) {}

    /// meetings: all of arc a with itself.
    void look_at_itself(std::size_t a, std::span<Meeting const> meetings) {
        auto const& line = plans_[a];
        std::vector<Spike> spikes;
        for (std::size_t i = 1; i + 1 < line.size(); ++i) {
            bool const exactly = std::any_of(meetings.begin(), meetings.end(), [&](Meeting const& m) {
                return m.is_stretch() && m.other_segment == i && m.segment + 1 == i;
            });
            if (Spike spike; turns_back(line, i, near_m_, exactly, spike)) {
                spikes.push_back(spike);
            }
        }
        FileArc const& arc = file_.arcs[a];
        if (!spikes.empty()) {
            Spike const& longest = *std::max_element(
                spikes.begin(), spikes.end(), [](Spike const& p, Spike const& q) { return p.length_m < q.length_m; });
            found_.push_back(
                {"spike", number_of(file_, arc), longest.tip, longest.length_m,
                 fmt::format("arc {}: turns back on itself at ({}, {}) for {} m ({} such places)",
                             number_of(file_, arc), longest.tip.x, longest.tip.y, longest.length_m, spikes.size())});
        }
        std::vector<Vec2> touches;
        for (Meeting const& m : meetings) {
            if (!belongs_to_spike(m, spikes, meetings)) {
                touches.push_back(m.at);
            }
        }
        auto const key = [](Vec2 p) { return std::tuple(p.x, p.y); };
        Vec2 const at = touches.empty() ? Vec2{} : touches.front();
        std::ranges::sort(touches, {}, key);
        touches.erase(std::unique(touches.begin(), touches.end()), touches.end());
        if (!touches.empty()) {
            found_.push_back({"self_touching", number_of(file_, arc), at, static_cast<double>(touches.size()),
                              fmt::format("arc {}: touches or crosses itself at ({}, {}) ({} such places)",
                                          number_of(file_, arc), at.x, at.y, touches.size())});
        }
    }

    /// meetings: all of arcs a < b.
    void look_at_pair(std::size_t a, std::size_t b, std::span<Meeting const> meetings) {
        FileArc const& earlier = file_.arcs[a];
        FileArc const& arc = file_.arcs[b];
        double shared_m = 0.0;
        std::vector<Vec2> stretch_ends;
        std::vector<Vec2> points;
        for (Meeting const& m : meetings) {
            if (m.is_stretch()) {
                shared_m += distance(m.at, m.until);
                stretch_ends.insert(stretch_ends.end(), {m.at, m.until});
            } else if (!is_fault_of_an_end(a, b, m.at)) {
                points.push_back(m.at);
            }
        }
        if (!stretch_ends.empty()) {
            Vec2 const at = stretch_ends.front();
            found_.push_back({"overlap", number_of(file_, arc), at, shared_m,
                              fmt::format("arc {}: shares a stretch of {} m with arc {}, at ({}, {})",
                                          number_of(file_, arc), shared_m, number_of(file_, earlier), at.x, at.y)});
        }
        std::ranges::sort(points, {}, [](Vec2 p) { return std::tuple(p.x, p.y); });
        points.erase(std::unique(points.begin(), points.end()), points.end());
        for (Vec2 const at : points) {
            if (std::find(stretch_ends.begin(), stretch_ends.end(), at) != stretch_ends.end()) {
                continue;
            }
            if (ends_at(b, at) || ends_at(a, at)) {
                touches_.push_back(ends_at(b, at) ? Touch{at, a, b} : Touch{at, b, a});
            } else {
                found_.push_back({"crossing", number_of(file_, arc), at, static_cast<double>(number_of(file_, earlier)),
                                  fmt::format("arc {}: meets arc {} at ({}, {}), where they share no node",
                                              number_of(file_, arc), number_of(file_, earlier), at.x, at.y)});
            }
        }
    }

    void finish(Findings& findings) {
        std::ranges::sort(touches_, {}, [](Touch const& t) { return std::tuple(t.at.x, t.at.y, t.through, t.ending); });
        for (std::size_t first = 0, last = 0; first < touches_.size(); first = last) {
            Touch const& touch = touches_[first];
            while (last < touches_.size() && touches_[last].at == touch.at && touches_[last].through == touch.through) {
                ++last;
            }
            // If one arc runs into the place, it is that arc's end; if several do, another arc runs through it.
            bool const through = last - first > 1 && !ends_at(touch.through, touch.at);
            FileArc const& arc = file_.arcs[through ? touch.through : touch.ending];
            FileArc const& other = file_.arcs[through ? touch.ending : touch.through];
            found_.push_back(
                {"touches", number_of(file_, arc), touch.at, static_cast<double>(number_of(file_, other)),
                 through ? fmt::format("arc {}: runs through the end of arc {} at ({}, {}), but has no "
                                       "node there",
                                       number_of(file_, arc), number_of(file_, other), touch.at.x, touch.at.y)
                         : fmt::format("arc {}: ends on arc {} at ({}, {}), where they share no node",
                                       number_of(file_, arc), number_of(file_, other), touch.at.x, touch.at.y)});
        }
        findings.insert(findings.end(), std::make_move_iterator(found_.begin()), std::make_move_iterator(found_.end()));
    }

private:
    /// An end of an arc that lies on another arc.
    struct Touch {
        Vec2 at;
        std::size_t through;
        std::size_t ending;
    };

    bool ends_at(std::size_t a, Vec2 at) const { return plans_[a].front() == at || plans_[a].back() == at; }

    bool belongs_to_spike(Meeting const& m, std::vector<Spike> const& spikes, std::span<Meeting const> all) const {
        if (spikes.empty()) {
            return false;
        }
        auto const near_spike = [&](Vec2 p) {
            return std::any_of(spikes.begin(), spikes.end(), [&](Spike const& s) {
                return distance(p, s.tip) <= 2.0 * near_m_ || distance(p, s.base) <= 2.0 * near_m_;
            });
        };
        auto const ends_stretch = [&](Vec2 p) {
            return std::any_of(all.begin(), all.end(),
                               [&](Meeting const& o) { return o.is_stretch() && (o.at == p || o.until == p); });
        };
        return m.is_stretch() || near_spike(m.at) || ends_stretch(m.at);
    }

    /// Whether two arcs of one junction meet beside it because an end is off its node, which has been reported.
    bool is_fault_of_an_end(std::size_t a, std::size_t b, Vec2 at) const {
        for (std::size_t const end_a : {0U, 1U}) {
            for (std::size_t const end_b : {0U, 1U}) {
                bool const common = joints_.meant[a][end_a] == joints_.meant[b][end_b];
                bool const faulty = joints_.faulty[a][end_a] != 0 || joints_.faulty[b][end_b] != 0;
                if (common && faulty && distance(at, joints_.place(a, end_a, plans_)) <= 2.0 * near_m_ &&
                    distance(at, joints_.place(b, end_b, plans_)) <= 2.0 * near_m_) {
                    return true;
                }
            }
        }
        return false;
    }

    NetworkFile const& file_;
    Outlines const& plans_;
    Joints const& joints_;
    double near_m_;
    Findings found_ = {};
    std::vector<Touch> touches_ = {};
};

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

Outlines check_shapes(NetworkFile const& file, Findings& findings) {
    auto const is_place = [&](Vec3 p) {
        return is_number(p.x) && is_number(p.y) && (!file.says.heights || is_number(p.z));
    };
    Outlines plans(file.arcs.size());
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

std::vector<char> check_copies(NetworkFile const& file, Outlines const& plans, Findings& findings) {
    std::vector<UndirectedLine> lines;
    for (std::size_t a = 0; a < plans.size(); ++a) {
        if (!plans[a].empty()) {
            lines.push_back(undirected(plans[a], a));
        }
    }
    std::sort(lines.begin(), lines.end(), [](UndirectedLine const& p, UndirectedLine const& q) {
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

void check_meetings(NetworkFile const& file, Outlines const& plans, Joints const& joints, double near_m,
                    Findings& findings, Run const& run) {
    std::vector<geometry::EndNodes> nodes = joints.meant;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
        if (joints.against[a] != 0) {
            std::swap(nodes[a][0], nodes[a][1]);
        }
    }
    auto const meetings = geometry::meetings(plans, nodes, run);
    MeetingCheck check(file, plans, joints, near_m);
    auto m = meetings.begin();
    for (std::size_t a = 0; a < plans.size(); ++a) {
        auto const own = m;
        while (m != meetings.end() && m->line == a && m->other == a) {
            ++m;
        }
        check.look_at_itself(a, std::span(own, m));
        while (m != meetings.end() && m->line == a) {
            auto const first = m;
            while (m != meetings.end() && m->line == a && m->other == first->other) {
                ++m;
            }
            check.look_at_pair(a, first->other, std::span(first, m));
        }
    }
    check.finish(findings);
}

} // namespace thalweg::measure::topology_steps
