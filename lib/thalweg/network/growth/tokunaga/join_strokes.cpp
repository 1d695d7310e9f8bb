// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/internal/grow_strokes.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/messages.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/nearby.hpp>
#include <thalweg/network/elevation/river_types.hpp>

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

void measure(Stroke& stroke) {
    stroke.way.assign(1, 0.0);
    for (std::size_t i = 1; i < stroke.line.size(); ++i) {
        stroke.way.push_back(stroke.way.back() + distance(stroke.line[i - 1], stroke.line[i]));
    }
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
        stroke.line.push_back(p);
    }
    stroke.line.erase(std::unique(stroke.line.begin(), stroke.line.end()), stroke.line.end());
    measure(stroke);
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
                       fmt::format(" has the unknown river type '{}'.{} (Rosgen's are Aa+, A, B, C, D, DA, "
                                   "E, F, G)",
                                   drawn.type, did_you_mean(drawn.type, names)));
    }
    return stroke;
}

/// A place on a stroke by one of its segments.
struct Spot {
    std::size_t segment = 0;
    double along = 0.0; ///< [0, 1]
};

/// Finds the stroke on which another begins as they are drawn, if any.
Spot find_beginning(std::size_t number, Strokes& strokes, double tolerance_m) {
    Stroke& stroke = strokes[number];
    double least = tolerance_m;
    Spot spot;
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
                spot = {i, foot.along};
                stroke.onto = static_cast<StrokeId>(other);
                stroke.onto_way_m = strokes[other].way[i] + foot.along * distance(line[i], line[i + 1]);
            }
        }
    }
    return spot;
}

/// Moves the beginning of a stroke onto the other, which lies where it shall.
void move_beginning(Stroke& stroke, Stroke const& onto, Spot spot) {
    Vec2 const a = onto.line[spot.segment];
    Vec2 const b = onto.line[spot.segment + 1];
    stroke.line.front() = {a.x + spot.along * (b.x - a.x), a.y + spot.along * (b.y - a.y)};
    stroke.onto_way_m = onto.way[spot.segment] + spot.along * distance(a, b);
    measure(stroke);
}

/// Where a line lies on a point that it shares with others or with itself.
struct Meeting {
    std::size_t stroke;
    std::size_t segment;
};

bool meets_itself(std::vector<Meeting> const& here) {
    return std::adjacent_find(here.begin(), here.end(), [](Meeting const& a, Meeting const& b) {
               return a.stroke == b.stroke && b.segment > a.segment + 1;
           }) != here.end();
}

/// Throws where strokes meet otherwise than by one that begins on another.
void require_joined(Strokes const& strokes, RiverLines const& names, double tolerance_m, Run const& run) {
    std::vector<std::vector<Vec2>> lines;
    for (Stroke const& s : strokes) {
        lines.push_back(s.line);
    }
    std::map<std::pair<double, double>, std::vector<Meeting>> meetings; // sorted by line and segment, as crossings are
    for (geometry::Crossing const& c : geometry::crossings(lines, run)) {
        meetings[{c.at.x, c.at.y}].push_back({c.line, c.segment});
    }
    for (auto const& [place, here] : meetings) {
        Vec2 const at{place.first, place.second};
        bool const alone = here.front().stroke == here.back().stroke;
        if (alone || meets_itself(here)) {
            throw BadInput(named(names, strokes[here.front().stroke].feature, at) +
                           " meets itself; draw it without loops");
        }
        auto const begins_here = [&](std::size_t k, std::size_t on) {
            return std::cmp_equal(strokes[k].onto, on) && distance(strokes[k].line.front(), at) <= tolerance_m;
        };
        for (auto const& [other, other_segment] : here) {
            for (auto const& [one, segment] : here) {
                if (one >= other || begins_here(one, other) || begins_here(other, one)) {
                    continue;
                }
                throw BadInput(named(names, strokes[one].feature, at) +
                               fmt::format(" crosses stroke {}; rivers do not cross: let one begin on the other",
                                           strokes[other].feature));
            }
        }
    }
}

/// Throws where the upper end of a stroke lies on another.
void require_mouths_below(Strokes const& strokes, RiverLines const& names, double tolerance_m) {
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        Vec2 const end = strokes[k].line.back();
        for (std::size_t other = 0; other < strokes.size(); ++other) {
            if (other == k || distance_to(strokes[other], end) > tolerance_m) {
                continue;
            }
            throw BadInput(named(names, strokes[k].feature, end) +
                           fmt::format(" ends on stroke {}; strokes run from their mouth upstream: turn it round",
                                       strokes[other].feature));
        }
    }
}

/// Throws where two begin or join at one place, a stroke begins where another does, or strokes begin on one another in
/// a ring.
void require_apart(Strokes const& strokes, RiverLines const& names, double tolerance_m) {
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        for (std::size_t m = 0; m < k; ++m) {
            if (distance(strokes[k].line.front(), strokes[m].line.front()) <= tolerance_m) {
                throw BadInput(named(names, strokes[k].feature, strokes[k].line.front()) +
                               fmt::format(" begins where stroke {} does; move one of them", strokes[m].feature));
            }
        }
    }
    for (Stroke const& s : strokes) {
        if (s.onto >= 0) {
            Stroke const& below = strokes[s.onto];
            if (s.onto_way_m >= below.way.back() - tolerance_m) {
                throw BadInput(named(names, s.feature, s.line.front()) +
                               fmt::format(" begins at the upper end of stroke {}; draw both as one, or let it begin "
                                           "lower down",
                                           below.feature));
            }
        }
        StrokeId below = s.onto;
        for (std::size_t steps = 0; below >= 0; ++steps) {
            if (steps > strokes.size()) {
                throw BadInput(named(names, s.feature, s.line.front()) + " flows in a ring of strokes; let one end");
            }
            below = strokes[below].onto;
        }
    }
}

} // namespace

Strokes join_strokes(RiverLines const& drawn, Grid const& grid, Run const& run) {
    double const tolerance_m = 0.5 * grid.cell_m;
    Strokes strokes;
    for (RiverLine const& line : drawn.lines) {
        strokes.push_back(as_drawn(line, drawn, grid));
    }
    std::vector<Spot> spots;
    for (std::size_t k = 0; k < strokes.size(); ++k) {
        spots.push_back(find_beginning(k, strokes, tolerance_m));
    }
    require_apart(strokes, drawn, tolerance_m);
    for (std::size_t const k : downstream_first(strokes)) {
        if (strokes[k].onto >= 0) {
            move_beginning(strokes[k], strokes[strokes[k].onto], spots[k]);
        }
        if (!(strokes[k].way.back() > tolerance_m)) {
            throw BadInput(named(drawn, strokes[k].feature, strokes[k].line.front()) +
                           " is no longer than half a cell; draw it longer");
        }
    }
    require_mouths_below(strokes, drawn, tolerance_m);
    require_joined(strokes, drawn, 2.0 * tolerance_m, run);
    return strokes;
}

double distance_to(Stroke const& stroke, Vec2 p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < stroke.line.size(); ++i) {
        least = std::min(least, distance(p, geometry::foot_on(stroke.line[i], stroke.line[i + 1], p).at));
    }
    return least;
}

std::vector<std::size_t> downstream_first(Strokes const& strokes) {
    std::vector<std::size_t> turn;
    Indexed<StrokeId, std::uint8_t> done(strokes.size(), 0);
    while (turn.size() < strokes.size()) {
        for (std::size_t k = 0; k < strokes.size(); ++k) {
            if (done[k] == 0 && (strokes[k].onto < 0 || done[strokes[k].onto] != 0)) {
                done[k] = 1;
                turn.push_back(k);
            }
        }
    }
    return turn;
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
