// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/internal/drawing_steps.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/rosgen.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/stream_network.hpp>
#include <thalweg/studio/internal/drawn_coasts.hpp>
#include <thalweg/studio/internal/drawn_lines.hpp>
#include <thalweg/studio/internal/drawn_rivers.hpp>

namespace thalweg::studio {
namespace {

/// What an end of a river snaps to.
struct RiverEnd {
    enum class Meets : std::uint8_t { nothing, border, coast, river } meets = Meets::nothing;
    Vec2 at;
    RiverSpot spot = {};    ///< on the river that it meets
    bool continues = false; ///< the spot is the outlet of that river
};

RiverEnd find_river_end(Drawing const& drawing, Vec2 p, std::size_t left_out) {
    using Meets = RiverEnd::Meets;
    double const cell_m = drawing.grid.cell_m;
    double const reach_m = snap_cells * cell_m;
    RiverSpot const spot = nearest_on_rivers(drawing, p, left_out, reach_m);
    if (spot.river != no_number) {
        bool const is_outlet = distance(drawing.rivers[spot.river].line.back(), spot.at) <= cell_m &&
                               downstream_vertices(drawing)[spot.river].river == no_number;
        return {Meets::river, spot.at, spot, is_outlet};
    }
    NearestCoast const coast = CoastIndex(drawing.coasts).nearest(p);
    if (coast.distance_m < reach_m) {
        return {Meets::coast, rounded(coast.at)};
    }
    Vec2 const edge = nearest_on_border(drawing.grid, p);
    return distance(edge, p) < reach_m ? RiverEnd{Meets::border, edge} : RiverEnd{Meets::nothing, p};
}

/// Whether a new river runs against its stroke.
bool is_drawn_upstream(RiverEnd const& begin, RiverEnd const& end) {
    auto const can_begin = [](RiverEnd const& e) { return e.meets != RiverEnd::Meets::river || e.continues; };
    refuse_step_if(!can_begin(begin) && !can_begin(end),
                   "a river cannot flow out of another one: water has one way down. Let one end "
                   "lie apart, or begin where a river ends",
                   begin.at);
    if (can_begin(begin) != can_begin(end)) {
        return can_begin(end);
    }
    auto const rank = [](RiverEnd const& e) { return e.continues ? -1 : static_cast<int>(e.meets); };
    return rank(begin) > std::max(rank(end), 0);
}

void require_type(std::string const& type, int lambda) {
    constexpr int most = 50;
    refuse_if<BadParameter>(!type.empty() && !rosgen_of(type), "studio.drawn",
                            "{} is no river type: Aa+, A, B, C, D, DA, E, F and G are", type);
    refuse_if<BadParameter>(lambda < 0 || lambda > most, "studio.drawn", "lambda = {} is outside [1, {}]", lambda,
                            most);
}

std::size_t require_river(Drawing const& drawing, std::size_t river) {
    if (river >= drawing.rivers.size()) {
        throw NotDrawn("studio.drawn", fmt::format("there is no river {}", river));
    }
    return river;
}

/// Lengthens a river to a place.
/// \param into river that it joins there
void extend_river(Drawing& drawing, std::size_t river, Vec2 to, std::size_t into) {
    double const cell_m = drawing.grid.cell_m;
    refuse_step_if(into != no_number && river != into && flows_through(downstream_vertices(drawing), into, river),
                   "the river would flow in a circle", to);
    DrawnLine& line = drawing.rivers[river].line;
    refuse_step_if(line.back() == to, "it lies there already", to);
    if (distance(line.back(), to) <= snap_cells * cell_m && line.size() > 2 &&
        !meets_other_river(drawing, river, line.back())) {
        snap_end(line, to, cell_m);
    } else {
        line.push_back(to);
    }
    require_no_loop(line, false, cell_m);
    require_clear(drawing, river, line.size() - 2, line.size() - 1, clearance_cells);
}

/// Extends a free end of a river to what it meets, or to a place.
void join_river_end(DrawResult& result, std::size_t river, bool at_source, RiverEnd const& end) {
    Drawing& drawing = result.drawing;
    bool const is_joined = end.meets == RiverEnd::Meets::river;
    result.name = is_joined ? "rivers joined" : "a river carried on";
    if (is_joined && at_source) {
        refuse_step_if(!end.continues,
                       "a river cannot flow out of another one: water has one way down. Its "
                       "source can only be joined to where a river ends",
                       end.at);
        extend_river(drawing, end.spot.river, drawing.rivers[river].line.front(), river);
    } else if (is_joined) {
        extend_river(drawing, river, add_vertex(drawing, end.spot), end.spot.river);
    } else if (at_source) {
        DrawnLine& line = drawing.rivers[river].line;
        line.insert(line.begin(), rounded(end.at));
        require_no_loop(line, false, drawing.grid.cell_m);
        require_clear(drawing, river, 0, 1, clearance_cells);
    } else {
        extend_river(drawing, river, rounded(end.at), no_number);
    }
}

/// Removes a few cells from the lower end of a line, as long as no river joins it there.
void shorten_above_cut(Drawing const& drawing, std::size_t river, DrawnLine& line, double gap_m) {
    while (line.size() > 1) {
        Vec2 const end = line.back();
        Vec2 const before = line[line.size() - 2];
        double const step_m = distance(before, end);
        if (step_m > gap_m) {
            line.back() = rounded(end + (gap_m / step_m) * (before - end));
            return;
        }
        refuse_step_if(meets_other_river(drawing, river, before), "a river joins too near above: cut elsewhere",
                       before);
        line.pop_back();
        gap_m -= step_m;
    }
}

/// Vertices of a river before and after one of them is dragged.
struct DraggedVertices {
    std::map<Vec2, Vec2, BeforeInPlan> places; ///< from, to
    std::size_t first;
    std::size_t last;
};

/// Vertices within reach follow; the ends of the river stay, unless one of them is dragged.
DraggedVertices drag_vertices(Grid const& grid, DrawnLine const& line, std::size_t vertex, Vec2 to, double reach_m) {
    DraggedVertices dragged{{{line[vertex], to}}, vertex, vertex};
    Vec2 const by = to - line[vertex];
    double along_m = 0.0;
    for (std::size_t i = vertex + 1; i + 1 < line.size(); ++i) {
        along_m += distance(line[i - 1], line[i]);
        if (along_m >= reach_m) {
            break;
        }
        dragged.places[line[i]] = clip_to_grid(grid, line[i] + drag_weight(along_m, reach_m) * by);
        dragged.last = i;
    }
    along_m = 0.0;
    for (std::size_t i = vertex; i > 1; --i) {
        along_m += distance(line[i], line[i - 1]);
        if (along_m >= reach_m) {
            break;
        }
        dragged.places[line[i - 1]] = clip_to_grid(grid, line[i - 1] + drag_weight(along_m, reach_m) * by);
        dragged.first = i - 1;
    }
    return dragged;
}

/// Drags a vertex; vertices of other rivers at the same places go with it.
void drag_river_vertex(Drawing& drawing, std::size_t river, std::size_t vertex, Vec2 to, double reach_m) {
    DraggedVertices const dragged = drag_vertices(drawing.grid, drawing.rivers[river].line, vertex, to, reach_m);
    std::set<std::size_t> changed;
    for (std::size_t r = 0; r < drawing.rivers.size(); ++r) {
        for (Vec2& p : drawing.rivers[r].line) {
            if (auto const found = dragged.places.find(p); found != dragged.places.end()) {
                p = found->second;
                changed.insert(r);
            }
        }
    }
    for (std::size_t const r : changed) {
        DrawnLine& line = drawing.rivers[r].line;
        std::size_t const count = line.size();
        line = remove_repeats(std::move(line));
        refuse_step_if(line.size() < 2, "nothing would be left of a river here", to);
        require_no_loop(line, false, drawing.grid.cell_m);
        bool const is_own = r == river && line.size() == count;
        std::size_t const begin = is_own && dragged.first > 0 ? dragged.first - 1 : 0;
        std::size_t const end = is_own ? std::min(dragged.last + 1, line.size() - 1) : line.size() - 1;
        require_clear(drawing, r, begin, end, 0.5 * clearance_cells);
    }
}

} // namespace

void apply_step(DrawResult& result, DrawRiver const& step) {
    result.name = "a river";
    require_type(step.type, step.lambda);
    DrawnLine line = line_on_land(result, step.points, "river");
    Drawing& drawing = result.drawing;
    double const cell_m = drawing.grid.cell_m;
    RiverEnd begin = find_river_end(drawing, line.front(), no_number);
    RiverEnd end = find_river_end(drawing, line.back(), no_number);
    if (is_drawn_upstream(begin, end)) {
        std::ranges::reverse(line);
        std::swap(begin, end);
        result.said.emplace_back("the river runs against your stroke, to where it meets other water");
    }
    refuse_step_if(begin.spot.river != no_number && end.spot.river != no_number &&
                       flows_through(downstream_vertices(drawing), end.spot.river, begin.spot.river),
                   "the river would flow in a circle", end.at);
    if (end.meets != RiverEnd::Meets::nothing) {
        snap_end(line, end.spot.river == no_number ? end.at : add_vertex(drawing, end.spot), cell_m);
    }
    if (begin.meets != RiverEnd::Meets::nothing) {
        std::ranges::reverse(line);
        snap_end(line, begin.spot.river == no_number ? begin.at : drawing.rivers[begin.spot.river].line.back(), cell_m);
        std::ranges::reverse(line);
    }
    if (length_of(line) < least_length_cells * cell_m) {
        throw NotDrawn("studio.drawn", fmt::format("the river would be shorter than {} cells", least_length_cells),
                       line.back());
    }
    drawing.rivers.push_back({std::move(line), step.type, step.lambda});
    DrawnRiver const& river = drawing.rivers.back();
    require_clear(drawing, drawing.rivers.size() - 1, 0, river.line.size() - 1, clearance_cells);
    DrawnLine pins;
    std::ranges::transform(drawing.pins, std::back_inserter(pins), &DrawnPin::at);
    std::vector<bool> const is_near = find_near_lines(pins, std::span(&river, 1), in_river_cells * cell_m);
    auto const in_river = static_cast<std::size_t>(std::ranges::count(is_near, true));
    if (in_river > 0) {
        result.said.push_back(fmt::format("{} in the river now: the river's height decides there",
                                          count_of(in_river, "pin lies", "pins lie")));
    }
}

void move_river_vertex(DrawResult& result, MoveVertex const& step) {
    Drawing& drawing = result.drawing;
    std::size_t const river = step.of.number;
    DrawnLine const& line = drawing.rivers[river].line;
    Vec2 to = clip_to_grid(drawing.grid, step.to);
    bool const is_end = step.vertex == 0 || step.vertex + 1 == line.size();
    if (is_end && !meets_other_river(drawing, river, line[step.vertex])) {
        RiverEnd const end = find_river_end(drawing, to, river);
        if (end.meets == RiverEnd::Meets::river) {
            join_river_end(result, river, step.vertex == 0, end);
            return;
        }
        to = rounded(end.at);
    }
    refuse_step_if(lies_in_sea(drawing, to), "this place lies in the sea", to);
    drag_river_vertex(drawing, river, step.vertex, to, step.reach_m);
}

void apply_step(DrawResult& result, CutRiver const& step) {
    constexpr double gap_cells = 4.0; // between the two parts
    result.name = "a river cut";
    Drawing& drawing = result.drawing;
    double const cell_m = drawing.grid.cell_m;
    std::size_t const river = require_river(drawing, step.river);
    Vec2 const at = add_vertex(drawing, nearest_on_river(drawing, river, clip_to_grid(drawing.grid, step.at)));
    DrawnLine const& whole = drawing.rivers[river].line;
    auto const middle = std::ranges::find(whole, at);
    DrawnLine upper(whole.begin(), middle + 1);
    DrawnLine lower(middle, whole.end());
    double const least_m = least_length_cells * cell_m;
    refuse_step_if(length_of(lower) < least_m || length_of(upper) < least_m + gap_cells * cell_m,
                   "too near to its end to be cut", at);
    shorten_above_cut(drawing, river, upper, gap_cells * cell_m);
    drawing.rivers[river].line = std::move(lower);
    DrawnRiver above = drawing.rivers[river];
    above.line = std::move(upper);
    drawing.rivers.push_back(std::move(above));
}

void apply_step(DrawResult& result, JoinRiver const& step) {
    Drawing const& drawing = result.drawing;
    std::size_t const river = require_river(drawing, step.river);
    DrawnLine const& line = drawing.rivers[river].line;
    Vec2 const end = step.at_source ? line.front() : line.back();
    refuse_step_if(meets_other_river(drawing, river, end), "this end meets another river already: cut it off first",
                   end);
    join_river_end(result, river, step.at_source, find_river_end(drawing, clip_to_grid(drawing.grid, step.at), river));
}

void apply_step(DrawResult& result, ReverseRiver const& step) {
    result.name = "a river reversed";
    std::vector<DrawnRiver>& rivers = result.drawing.rivers;
    // The whole way down is known before the first river is turned.
    std::vector<RiverVertex> const below = downstream_vertices(result.drawing);
    std::vector<RiverVertex> way;
    RiverVertex next{require_river(result.drawing, step.river), 0};
    while (next.river != no_number && way.size() <= rivers.size()) {
        way.push_back(next);
        next = below[next.river];
    }
    for (RiverVertex const& one : way) {
        DrawnRiver turned = rivers[one.river];
        DrawnLine const line = turned.line;
        turned.line.assign(line.rbegin(), line.rend() - static_cast<std::ptrdiff_t>(one.vertex));
        if (one.vertex == 0) {
            rivers[one.river] = std::move(turned);
        } else {
            rivers[one.river].line.resize(one.vertex + 1);
            rivers.push_back(std::move(turned));
        }
    }
    if (way.size() > 1) {
        result.said.push_back(
            fmt::format("{} below it run the other way too", count_of(way.size() - 1, "river", "rivers")));
    }
}

void erase_river(DrawResult& result, std::size_t river, bool alone) {
    std::vector<std::size_t> gone = rivers_into(result.drawing, river);
    if (!gone.empty()) {
        result.said.push_back(
            alone ? fmt::format("{} end inland now", count_of(gone.size(), "river above it does", "rivers above it"))
                  : fmt::format("{} that flow into it went with it", count_of(gone.size(), "river", "rivers")));
    }
    if (alone) {
        gone.clear();
    }
    gone.push_back(river);
    std::ranges::sort(gone, std::greater());
    for (std::size_t const one : gone) {
        erase_at(result.drawing.rivers, one);
    }
}

void apply_step(DrawResult& result, SetType const& step) {
    result.name = fmt::format("river type {}", step.type.empty() ? "none" : step.type);
    require_type(step.type, 0);
    for (std::size_t const river : step.rivers) {
        result.drawing.rivers[require_river(result.drawing, river)].type = step.type;
    }
}

void apply_step(DrawResult& result, SetLambda const& step) {
    result.name = fmt::format("lambda = {}", step.lambda);
    require_type("", step.lambda);
    for (std::size_t const river : step.rivers) {
        result.drawing.rivers[require_river(result.drawing, river)].lambda = step.lambda;
    }
}

void apply_step(DrawResult& result, SetSideStreams const& step) {
    result.name = step.on ? "with side streams" : "without side streams";
    refuse_step_if(step.on && !result.drawing.coasts.empty(),
                   "rivers with side streams know no coast: erase the coasts, or draw the side "
                   "streams yourself");
    result.drawing.has_side_streams = step.on;
}

} // namespace thalweg::studio
