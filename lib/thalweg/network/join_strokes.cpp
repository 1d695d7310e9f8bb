// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/join_strokes.hpp>

#include <thalweg/core/error.hpp>
#include <thalweg/core/suggest.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/segments_near.hpp>
#include <thalweg/network/rosgen.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace thalweg::network {

namespace {

std::string named(RiverLines const& strokes, std::int64_t feature, Vec2 at) {
    return fmt::format("network.grow_strokes: stroke {} of {} at ({:.3f}, {:.3f})", feature, strokes.name, at.x, at.y);
}

Stroke as_drawn(RiverLine const& drawn, RiverLines const& strokes, Grid const& grid) {
    Stroke stroke;
    stroke.feature = drawn.feature;
    for (Vec3 const& v : drawn.vertices) {
        Vec2 const p{v.x, v.y};
        if (!(p.x >= grid.west && p.x <= grid.east() && p.y >= grid.south() && p.y <= grid.north)) {
            throw BadInput(named(strokes, drawn.feature, p) +
                           fmt::format(" leaves the grid, which spans {:.1f} to {:.1f} east and {:.1f} to {:.1f} "
                                       "north; enlarge the grid or shorten the stroke",
                                       grid.west, grid.east(), grid.south(), grid.north));
        }
        if (stroke.line.empty() || !(stroke.line.back() == p)) {
            stroke.way.push_back(stroke.line.empty() ? 0.0 : stroke.way.back() + distance(stroke.line.back(), p));
            stroke.line.push_back(p);
        }
    }
    if (stroke.line.size() < 2) {
        Vec2 const at = stroke.line.empty() ? Vec2{} : stroke.line.front();
        throw BadInput(named(strokes, drawn.feature, at) + " is a single point; draw it from its mouth upstream");
    }
    if (!drawn.type.empty() && drawn.type != "none" && !rosgen_of(drawn.type)) {
        std::vector<std::string> names;
        for (Rosgen const type : rosgen_types) {
            names.emplace_back(name_of(type));
        }
        throw BadInput(named(strokes, drawn.feature, stroke.line.front()) +
                       fmt::format(" has the river type '{}', which nobody knows.{} (Rosgen's are Aa+, A, B, C, D, DA, "
                                   "E, F, G)",
                                   drawn.type, did_you_mean(drawn.type, names)));
    }
    return stroke;
}

/// Finds the stroke on which another begins, if any, and moves its beginning onto it.
void find_beginning(std::size_t number, std::vector<Stroke>& strokes, double tolerance_m) {
    Stroke& stroke = strokes[number];
    double least = tolerance_m;
    Vec2 onto = stroke.line.front();
    for (std::size_t other = 0; other < strokes.size(); ++other) {
        if (other == number) {
            continue;
        }
        std::vector<Vec2> const& line = strokes[other].line;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            geometry::Foot const foot = geometry::foot_on(line[i], line[i + 1], stroke.line.front());
            double const off = distance(foot.at, stroke.line.front());
            if (off < least || (off == least && stroke.onto < 0)) {
                least = off;
                onto = foot.at;
                stroke.onto = static_cast<std::int64_t>(other);
                stroke.onto_way_m = strokes[other].way[i] + foot.along * distance(line[i], line[i + 1]);
            }
        }
    }
    if (stroke.onto >= 0) {
        stroke.line.front() = onto;
        for (std::size_t i = 1; i < stroke.line.size(); ++i) {
            stroke.way[i] = stroke.way[i - 1] + distance(stroke.line[i - 1], stroke.line[i]);
        }
    }
}

/// Throws where strokes meet otherwise than by one that begins on another.
void require_joined(std::vector<Stroke> const& strokes, RiverLines const& names, double tolerance_m, Run const& run) {
    std::vector<std::vector<Vec2>> lines;
    for (Stroke const& s : strokes) {
        lines.push_back(s.line);
    }
    std::map<std::pair<double, double>, std::vector<std::size_t>> meetings;
    for (geometry::Crossing const& c : geometry::crossings(lines, run)) {
        meetings[{c.at.x, c.at.y}].push_back(c.line);
    }
    for (auto const& [place, who] : meetings) {
        Vec2 const at{place.first, place.second};
        std::size_t const one = who.front();
        auto const other = std::find_if(who.begin(), who.end(), [one](std::size_t k) { return k != one; });
        if (other == who.end()) {
            throw BadInput(named(names, strokes[one].feature, at) + " meets itself; draw it without loops");
        }
        auto const begins_here = [&](std::size_t k, std::size_t on) {
            return strokes[k].onto == static_cast<std::int64_t>(on) &&
                   distance(strokes[k].line.front(), at) <= tolerance_m;
        };
        if (begins_here(one, *other) || begins_here(*other, one)) {
            continue;
        }
        bool const ends = distance(strokes[one].line.back(), at) <= tolerance_m ||
                          distance(strokes[*other].line.back(), at) <= tolerance_m;
        throw BadInput(named(names, strokes[one].feature, at) +
                       fmt::format(" {} stroke {}; {}", ends ? "meets the end of or ends on" : "crosses",
                                   strokes[*other].feature,
                                   ends ? "strokes run from their mouth upstream: turn round the one that ends here"
                                        : "rivers do not cross: let one begin on the other"));
    }
}

/// Throws where two begin or join at one place, a stroke begins where another does, or strokes begin on one another in
/// a ring.
void require_apart(std::vector<Stroke> const& strokes, RiverLines const& names, double tolerance_m) {
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        for (std::size_t m = 0; m < k; ++m) {
            if (distance(strokes[k].line.front(), strokes[m].line.front()) <= tolerance_m) {
                throw BadInput(named(names, strokes[k].feature, strokes[k].line.front()) +
                               fmt::format(" begins where stroke {} does; move one of them", strokes[m].feature));
            }
        }
        Stroke const& s = strokes[k];
        if (s.onto >= 0) {
            Stroke const& below = strokes[static_cast<std::size_t>(s.onto)];
            if (s.onto_way_m >= below.way.back() - tolerance_m) {
                throw BadInput(named(names, s.feature, s.line.front()) +
                               fmt::format(" begins at the upper end of stroke {}; draw both as one, or let it begin "
                                           "lower down",
                                           below.feature));
            }
        }
        std::int64_t below = s.onto;
        for (std::size_t steps = 0; below >= 0; ++steps) {
            if (steps > strokes.size()) {
                throw BadInput(named(names, s.feature, s.line.front()) + " flows in a ring of strokes; let one end");
            }
            below = strokes[static_cast<std::size_t>(below)].onto;
        }
    }
}

} // namespace

std::vector<Stroke> join_strokes(RiverLines const& drawn, Grid const& grid, Run const& run) {
    double const tolerance_m = 0.5 * grid.cell_m;
    std::vector<Stroke> strokes;
    for (RiverLine const& line : drawn.lines) {
        strokes.push_back(as_drawn(line, drawn, grid));
    }
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        find_beginning(k, strokes, tolerance_m);
    }
    require_apart(strokes, drawn, tolerance_m);
    require_joined(strokes, drawn, 2.0 * tolerance_m, run);
    return strokes;
}

Vec2 place_at(Stroke const& stroke, double way_m) {
    std::size_t i = 1;
    while (i + 1 < stroke.line.size() && stroke.way[i] < way_m) {
        ++i;
    }
    double const share = std::clamp((way_m - stroke.way[i - 1]) / (stroke.way[i] - stroke.way[i - 1]), 0.0, 1.0);
    Vec2 const a = stroke.line[i - 1];
    Vec2 const b = stroke.line[i];
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

} // namespace thalweg::network
