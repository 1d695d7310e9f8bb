// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/network/import/internal/import_lines.hpp>

namespace thalweg::network::import_steps {
namespace {

double greatest_distance(std::vector<Vec3> const& a, std::vector<Vec3> const& b, bool turned) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        most = std::max(most, distance(plan(a[i]), plan(b[turned ? b.size() - 1 - i : i])));
    }
    return most;
}

// Where an end goes.
struct Goal {
    Vec2 at;
    double moved_m = 0.0;
    std::int64_t onto = 0;             // number of the river
    std::optional<Insertion> addition; // where it meets the line between two vertices
};

struct Ends {
    std::vector<RiverLine> const& lines;
    std::vector<char> settled; // two a line

    static std::size_t number(std::size_t line, std::size_t vertex) { return 2 * line + (vertex == 0 ? 0 : 1); }
    bool is_end(std::size_t line, std::size_t vertex) const {
        return vertex == 0 || vertex + 1 == lines[line].vertices.size();
    }
    // An end that has not had its turn is no goal: it will come to this one.
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
            Vec2 const q = plan(ends.lines[s.line].vertices[v]);
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
            return !ends.fixed(s.line, v) && distance(plan(vertices[v]), p) <= snap_m;
        };
        if (awaits(s.segment) || awaits(s.segment + 1)) {
            continue;
        }
        auto const foot = geometry::foot_on(plan(vertices[s.segment]), plan(vertices[s.segment + 1]), p);
        double const d = distance(p, foot.at);
        if (foot.along <= 0.0 || foot.along >= 1.0 || d > snap_m || (best && d >= best->moved_m)) {
            continue;
        }
        // An end that lies on the line stays where it is drawn; the line takes it up as a vertex.
        Vec2 const at = d <= same_point_m ? p : rounded(foot.at);
        best = Goal{at, distance(p, at), ends.lines[s.line].number(), Insertion{s.line, s.segment, foot.along, at}};
    }
    return best;
}

// The lines, but for one, that pass through a place.
std::vector<std::size_t> lines_at(std::vector<RiverLine> const& lines, std::size_t own, Vec2 p,
                                  std::vector<geometry::NearSegment> const& near) {
    std::vector<std::size_t> found;
    for (auto const& s : near) {
        auto const& v = lines[s.line].vertices;
        if (s.line != own &&
            distance(p, geometry::foot_on(plan(v[s.segment]), plan(v[s.segment + 1]), p).at) <= same_point_m) {
            found.push_back(s.line);
        }
    }
    return found;
}

// The segments that an open end may go to: none of a line that its own meets at its other end.
std::vector<geometry::NearSegment> goals_of_open(std::vector<RiverLine> const& lines, std::size_t e,
                                                 std::vector<std::vector<geometry::NearSegment>> const& near) {
    auto const& own = lines[e / 2].vertices;
    auto const others = lines_at(lines, e / 2, plan(e % 2 == 0 ? own.back() : own.front()), near[e ^ 1U]);
    std::vector<geometry::NearSegment> goals = near[e];
    std::erase_if(goals,
                  [&](geometry::NearSegment const& s) { return std::ranges::find(others, s.line) != others.end(); });
    return goals;
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

std::vector<std::vector<Vec2>> plan_of(std::vector<RiverLine> const& lines) {
    std::vector<std::vector<Vec2>> plans(lines.size());
    for (std::size_t l = 0; l < lines.size(); ++l) {
        std::ranges::transform(lines[l].vertices, std::back_inserter(plans[l]), plan);
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
                // Rounding must not carry it past the ends: that would be a rise.
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
        line.vertices.erase(
            std::unique(line.vertices.begin(), line.vertices.end(), [](Vec3 a, Vec3 b) { return plan(a) == plan(b); }),
            line.vertices.end());
        dropped.push_back(static_cast<std::int64_t>(before - line.vertices.size()));
    }
    return dropped;
}

void drop_copies(std::vector<RiverLine>& lines, double snap_m, Left& left, Run const& run) {
    std::vector<Vec2> starts;
    for (auto const& line : lines) {
        starts.push_back(plan(line.vertices.front()));
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
                // Of two channels drawn as one the minor one goes.
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
    std::vector<RiverLine> kept;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        if (dropped[l] == 0) {
            kept.push_back(std::move(lines[l]));
        }
    }
    lines = std::move(kept);
}

void snap(std::vector<RiverLine>& lines, double snap_m, SnappedEnds snapped, Left& left, Run const& run) {
    std::vector<Vec2> drawn;
    std::vector<std::vector<Vec3>> as_drawn;
    for (auto const& line : lines) {
        drawn.push_back(plan(line.vertices.front()));
        drawn.push_back(plan(line.vertices.back()));
        as_drawn.push_back(line.vertices);
    }
    // Twice the distance: what an end shall join may itself have moved here.
    auto const near = geometry::segments_near(drawn, plan_of(lines), 2.0 * snap_m, run);
    Ends ends{lines, std::vector<char>(drawn.size(), 0)};
    std::vector<Insertion> additions;
    std::vector<char> meets(drawn.size(), 0); // another line, or itself: such ends stay where they are
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
            left.repairs.push_back(
                {"snapped", lines[own].number(), goal->at, goal->moved_m,
                 fmt::format("the {} of river {} is moved {:.3g} m onto river {}", e % 2 == 0 ? "start" : "end",
                             lines[own].number(), goal->moved_m, goal->onto)});
        }
    }
    insert(lines, std::move(additions));
    drop_repeats(lines);
    std::size_t kept = 0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        RiverLine& line = lines[l];
        if (line.vertices.size() > 1) {
            if (kept != l) {
                lines[kept] = std::move(line);
            }
            ++kept;
            continue;
        }
        left.secondary.push_back({line.feature, std::move(as_drawn[l]), "too short", line.feature, LeftOut::too_short});
        left.repairs.push_back({"removed", line.number(), plan(line.vertices.front()), 1.0,
                                fmt::format("river {} is shorter than the snapping distance {:.3g} m; it is left out",
                                            line.number(), snap_m)});
    }
    lines.resize(kept);
}

} // namespace thalweg::network::import_steps
