// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

double greatest_distance(std::vector<Vec3> const& a, std::vector<Vec3> const& b, bool turned) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, distance(in_plan(a[i]), in_plan(b[turned ? b.size() - 1 - i : i])));
    }
    return most;
}

// The target of an end.
struct Goal {
    Vec2 at;
    double moved_m = 0.0;
    std::int64_t onto = 0;             // number of the river
    std::optional<Insertion> addition; // the insertion, if it lies between two vertices
};

struct Ends {
    std::vector<RiverLine> const& lines;
    std::vector<char> settled; // two per line

    static std::size_t number(std::size_t line, std::size_t vertex) { return 2 * line + (vertex == 0 ? 0 : 1); }
    bool is_end(std::size_t line, std::size_t vertex) const {
        return vertex == 0 || vertex + 1 == lines[line].vertices.size();
    }
    // An end not yet processed is not a target: it will move to this one.
    bool fixed(std::size_t line, std::size_t vertex) const {
        return !is_end(line, vertex) || settled[number(line, vertex)] != 0;
    }
};

std::optional<Goal> nearest_vertex(Ends const& ends, std::size_t own, Vec2 p, double snap_m,
                                   std::vector<geometry::NearSegment> const& near) {
    std::optional<Goal> best;
    for (auto const& s : near) {
        for (std::size_t const v : {s.segment, s.segment + 1}) {
            if (s.line == own || !ends.fixed(s.line, v)) {
                continue;
            }
            Vec2 const q = in_plan(ends.lines[s.line].vertices[v]);
            double const d = distance(p, q);
            if (d <= snap_m && (!best || d < best->moved_m)) {
                best = Goal{q, d, ends.lines[s.line].number(), std::nullopt};
            }
        }
    }
    return best;
}

std::optional<Goal> nearest_foot(Ends const& ends, std::size_t own, Vec2 p, double snap_m,
                                 std::vector<geometry::NearSegment> const& near) {
    std::optional<Goal> best;
    for (auto const& s : near) {
        if (s.line == own) {
            continue;
        }
        auto const& vertices = ends.lines[s.line].vertices;
        auto const awaits = [&](std::size_t v) {
            return !ends.fixed(s.line, v) && distance(in_plan(vertices[v]), p) <= snap_m;
        };
        if (awaits(s.segment) || awaits(s.segment + 1)) {
            continue;
        }
        auto const foot = geometry::foot_on(in_plan(vertices[s.segment]), in_plan(vertices[s.segment + 1]), p);
        double const d = distance(p, foot.at);
        if (foot.along <= 0.0 || foot.along >= 1.0 || d > snap_m || (best && d >= best->moved_m)) {
            continue;
        }
        // An end on the line stays in place; the line gets a vertex there.
        Vec2 const at = d <= same_point_m ? p : rounded(foot.at);
        best = Goal{at, distance(p, at), ends.lines[s.line].number(), Insertion{s.line, s.segment, foot.along, at}};
    }
    return best;
}

// The lines, except one, that pass through a position.
std::vector<std::size_t> lines_at(std::vector<RiverLine> const& lines, std::size_t own, Vec2 p,
                                  std::vector<geometry::NearSegment> const& near) {
    std::vector<std::size_t> found;
    for (auto const& s : near) {
        auto const& v = lines[s.line].vertices;
        if (s.line != own &&
            distance(p, geometry::foot_on(in_plan(v[s.segment]), in_plan(v[s.segment + 1]), p).at) <= same_point_m) {
            found.push_back(s.line);
        }
    }
    return found;
}

// The segments to which an open end may be joined: not of a line that its own line meets at the other end.
std::vector<geometry::NearSegment> goals_of_open(std::vector<RiverLine> const& lines, std::size_t e,
                                                 std::vector<std::vector<geometry::NearSegment>> const& near) {
    auto const& own = lines[e / 2].vertices;
    auto const others = lines_at(lines, e / 2, in_plan(e % 2 == 0 ? own.back() : own.front()), near[e ^ 1U]);
    std::vector<geometry::NearSegment> goals = near[e];
    std::erase_if(goals,
                  [&](geometry::NearSegment const& s) { return std::ranges::find(others, s.line) != others.end(); });
    return goals;
}

using geometry::Crossing;

bool inside(Crossing const& c, std::vector<std::vector<Vec2>> const& plans) {
    return c.at != plans[c.line][c.segment] && c.at != plans[c.line][c.segment + 1];
}

// The vertex for the lines of one crossing: an existing one or an earlier crossing if one is that close, so that no
// segment is shorter than the precision of coordinates.
Vec2 meeting(std::vector<Crossing const*> const& group, std::vector<std::vector<Vec2>> const& plans,
             std::vector<Vec2> const& earlier) {
    Vec2 const at = group.front()->at;
    Vec2 best = at;
    double least = same_point_m;
    auto const offer = [&](Vec2 p) {
        if (double const d = distance(at, p); d < least) {
            least = d;
            best = p;
        }
    };
    for (auto const* c : group) {
        offer(plans[c->line][c->segment]);
        offer(plans[c->line][c->segment + 1]);
    }
    if (best == at) {
        for (auto p = earlier.rbegin(); p != earlier.rend() && at.x - p->x < 3.0 * same_point_m; ++p) {
            offer(*p);
        }
    }
    return best;
}

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

// Vertices numbered in the order of lines; bitwise equal positions are one vertex.
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

// For every segment of every line: the first line with that segment.
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

/// The vertices of all lines, and how lines meet there.
struct Junctions {
    Numbering numbering;
    std::vector<std::vector<std::size_t>> owners;
    std::vector<int> degree;  ///< by vertex: number of segments, each counted for the first line that has it
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

/// Vertices first ... last of a line, between confluences and the ends of duplicated parts.
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

/// Drops the beginning of a line that passes the first river it meets by at most most_m.
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

double diagonal_of(std::vector<RiverLine> const& lines) {
    Vec3 low = lines.front().vertices.front();
    Vec3 high = low;
    for (auto const& line : lines) {
        for (auto const& v : line.vertices) {
            low = {std::min(low.x, v.x), std::min(low.y, v.y), 0.0};
            high = {std::max(high.x, v.x), std::max(high.y, v.y), 0.0};
        }
    }
    return distance({low.x, low.y}, {high.x, high.y});
}

double noise_of(std::vector<RiverLine> const& lines) {
    double low_m = std::numeric_limits<double>::infinity();
    double high_m = -low_m;
    for (RiverLine const& line : lines) {
        for (Vec3 const& v : line.vertices) {
            low_m = std::min(low_m, v.z);
            high_m = std::max(high_m, v.z);
        }
    }
    return noise_of_heights(low_m, high_m);
}

std::vector<std::vector<Vec2>> plan_of(std::vector<RiverLine> const& lines) {
    std::vector<std::vector<Vec2>> plans(lines.size());
    for (std::size_t l = 0; l < lines.size(); ++l) {
        plans[l] = in_plan(lines[l].vertices);
    }
    return plans;
}

void insert(std::vector<RiverLine>& lines, std::vector<Insertion> insertions) {
    std::ranges::stable_sort(insertions, {}, [](Insertion const& i) { return std::tuple(i.line, i.segment, i.along); });
    for (std::size_t first = 0; first < insertions.size();) {
        auto& line = lines[insertions[first].line];
        std::vector<Vec3> vertices;
        std::size_t next = first;
        for (std::size_t v = 0; v < line.vertices.size(); ++v) {
            vertices.push_back(line.vertices[v]);
            for (; next < insertions.size() && insertions[next].line == insertions[first].line &&
                   insertions[next].segment == v;
                 ++next) {
                auto const& i = insertions[next];
                double const a = line.vertices[v].z;
                double const b = line.vertices[v + 1].z;
                // Rounding must not exceed the ends, which would be a rise.
                double const z = std::clamp(a + i.along * (b - a), std::min(a, b), std::max(a, b));
                vertices.push_back({i.at.x, i.at.y, z});
            }
        }
        line.vertices = std::move(vertices);
        first = next;
    }
}

std::vector<std::int64_t> drop_repeats(std::vector<RiverLine>& lines) {
    std::vector<std::int64_t> dropped;
    for (auto& line : lines) {
        auto const before = line.vertices.size();
        line.vertices.erase(std::unique(line.vertices.begin(), line.vertices.end(),
                                        [](Vec3 a, Vec3 b) { return in_plan(a) == in_plan(b); }),
                            line.vertices.end());
        dropped.push_back(static_cast<std::int64_t>(before - line.vertices.size()));
    }
    return dropped;
}

void erase_marked(std::vector<RiverLine>& lines, std::vector<char> const& is_gone) {
    std::size_t kept = 0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (is_gone[l] == 0) {
            if (kept != l) {
                lines[kept] = std::move(lines[l]);
            }
            ++kept;
        }
    }
    lines.resize(kept);
}

Finding moved_onto(RiverLine const& line, bool is_start, Vec2 to, double moved_m, std::int64_t onto) {
    return {"snapped", line.number(), to, moved_m,
            fmt::format("the {} of river {} is moved {:.3g} m onto river {}", is_start ? "start" : "end", line.number(),
                        moved_m, onto)};
}

void drop_copies(std::vector<RiverLine>& lines, double snap_m, Left& left, Run const& run) {
    std::vector<Vec2> starts;
    for (auto const& line : lines) {
        starts.push_back(in_plan(line.vertices.front()));
    }
    auto const near = geometry::segments_near(starts, plan_of(lines), snap_m, run);
    std::vector<char> dropped(lines.size(), 0);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        for (auto const& s : near[l]) {
            auto const& other = lines[s.line];
            if (s.line >= l || dropped[s.line] != 0 || other.vertices.size() != lines[l].vertices.size()) {
                continue;
            }
            double const apart = std::min(greatest_distance(lines[l].vertices, other.vertices, false),
                                          greatest_distance(lines[l].vertices, other.vertices, true));
            if (apart <= snap_m) {
                // Of two channels with the same line the minor one is dropped.
                bool const other_goes = other.channel == Channel::minor && lines[l].channel != Channel::minor;
                std::size_t const gone = other_goes ? s.line : l;
                std::size_t const stays = other_goes ? l : s.line;
                dropped[gone] = 1;
                double const length = length_of(plan_of({lines[gone]}).front());
                left.repairs.push_back({"duplicate", lines[gone].number(), starts[gone], length,
                                        fmt::format("river {} repeats river {} within {:.3g} m; it is left out",
                                                    lines[gone].number(), lines[stays].number(), apart)});
                left.secondary.push_back(
                    {lines[gone].feature, lines[gone].vertices, "duplicate", lines[gone].feature, LeftOut::duplicate});
                break;
            }
        }
    }
    erase_marked(lines, dropped);
}

void snap(std::vector<RiverLine>& lines, double snap_m, SnappedEnds snapped, Left& left, Run const& run) {
    std::vector<Vec2> drawn;
    std::vector<std::vector<Vec3>> as_drawn;
    for (auto const& line : lines) {
        drawn.push_back(in_plan(line.vertices.front()));
        drawn.push_back(in_plan(line.vertices.back()));
        as_drawn.push_back(line.vertices);
    }
    // Twice the distance: the target may itself have moved.
    auto const near = geometry::segments_near(drawn, plan_of(lines), 2.0 * snap_m, run);
    Ends ends{lines, std::vector<char>(drawn.size(), 0)};
    std::vector<Insertion> additions;
    std::vector<char> meets(drawn.size(), 0); // another line or itself: such ends stay in place
    for (std::size_t e = 0; e < drawn.size() && snapped == SnappedEnds::open; ++e) {
        meets[e] = drawn[e] == drawn[e ^ 1U] || !lines_at(lines, e / 2, drawn[e], near[e]).empty() ? 1 : 0;
        ends.settled[e] = meets[e];
    }
    for (std::size_t e = 0; e < drawn.size(); ++e) {
        std::size_t const own = e / 2;
        double const reach_m = meets[e] != 0 ? same_point_m : snap_m;
        bool const is_open = snapped == SnappedEnds::open && meets[e] == 0;
        auto const of_open = is_open ? goals_of_open(lines, e, near) : std::vector<geometry::NearSegment>();
        auto const& goals = is_open ? of_open : near[e];
        auto goal = nearest_vertex(ends, own, drawn[e], reach_m, goals);
        if (!goal) {
            goal = nearest_foot(ends, own, drawn[e], reach_m, goals);
        }
        ends.settled[e] = 1;
        if (!goal) {
            continue;
        }
        if (goal->addition) {
            additions.push_back(*goal->addition);
        }
        auto& end = e % 2 == 0 ? lines[own].vertices.front() : lines[own].vertices.back();
        end.x = goal->at.x;
        end.y = goal->at.y;
        if (goal->moved_m > 0.0) {
            left.repairs.push_back(moved_onto(lines[own], e % 2 == 0, goal->at, goal->moved_m, goal->onto));
        }
    }
    insert(lines, std::move(additions));
    drop_repeats(lines);
    std::vector<char> is_gone(lines.size(), 0);
    for (std::size_t l = 0; l < lines.size(); ++l) {
        RiverLine const& line = lines[l];
        if (line.vertices.size() > 1) {
            continue;
        }
        is_gone[l] = 1;
        left.secondary.push_back({line.feature, std::move(as_drawn[l]), "too short", line.feature, LeftOut::too_short});
        left.repairs.push_back({"removed", line.number(), in_plan(line.vertices.front()), 1.0,
                                fmt::format("river {} is shorter than the snapping distance {:.3g} m; it is left out",
                                            line.number(), snap_m)});
    }
    erase_marked(lines, is_gone);
}

void split(std::vector<RiverLine>& lines, Run const& run) {
    // Rounding a crossing bends its lines by less than a millionth of a millimetre, which matters only if a third line
    // is as close: the second round nearly always finds nothing.
    constexpr int rounds = 16;
    Vec2 unsettled;
    for (int round = 0; round < rounds; ++round) {
        auto const plans = plan_of(lines);
        auto const found = geometry::crossings(plans, run);
        std::vector<Crossing const*> order;
        for (auto const& c : found) {
            order.push_back(&c);
        }
        std::ranges::stable_sort(order, {}, [](Crossing const* c) { return std::tuple(c->at.x, c->at.y); });
        std::vector<Insertion> additions;
        std::vector<Vec2> targets;
        for (std::size_t first = 0; first < order.size();) {
            std::size_t next = first + 1;
            while (next < order.size() && order[next]->at == order[first]->at) {
                ++next;
            }
            std::vector<Crossing const*> const group(order.begin() + static_cast<std::ptrdiff_t>(first),
                                                     order.begin() + static_cast<std::ptrdiff_t>(next));
            first = next;
            if (std::ranges::none_of(group, [&](auto const* c) { return inside(*c, plans); })) {
                continue;
            }
            Vec2 const target = meeting(group, plans, targets);
            targets.push_back(target);
            unsettled = target;
            for (auto const* c : group) {
                if (target != plans[c->line][c->segment] && target != plans[c->line][c->segment + 1]) {
                    additions.push_back({c->line, c->segment, c->along, target});
                }
            }
        }
        if (additions.empty()) {
            return;
        }
        insert(lines, std::move(additions));
        drop_repeats(lines);
    }
    throw BadInput("network.import_lines", fmt::format("rivers run so close together at ({:.6f}, {:.6f}) that their "
                                                       "crossings cannot be told apart; remove one of them there",
                                                       unsettled.x, unsettled.y));
}

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
        // The rest of the cycle: breadth-first through the pieces before the closing one.
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
            "network.import_lines",
            fmt::format("river{} {} in {} {} a cycle through ({:.6f}, {:.6f}) and ({:.6f}, {:.6f}); water has one way "
                        "down from every place: remove one branch, or keep the main one by divergences = \"main\"",
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
