// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/studio/drawing.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/run/refuse.hpp>
#include <thalweg/studio/internal/drawing_steps.hpp>
#include <thalweg/studio/internal/drawn_coasts.hpp>
#include <thalweg/studio/internal/drawn_lines.hpp>
#include <thalweg/studio/internal/drawn_rivers.hpp>

namespace thalweg::studio {
namespace {

char const* name_of_part(Part const& part) {
    static constexpr char const* names[] = {"a river", "a coast", "a lake", "a mask", "a pin", "a ridge"};
    return names[static_cast<std::size_t>(part.kind)];
}

void require_vertices(Part const& part) {
    refuse_step_if(part.kind == Part::Kind::pin, "a pin is one place: it has no vertices");
}

/// Whether a line is closed: a coast explicitly, lakes and masks implicitly.
bool is_ring(Part::Kind kind, DrawnLine const& line) {
    return kind == Part::Kind::lake || kind == Part::Kind::mask ||
           (kind == Part::Kind::coast && line.front() == line.back());
}

std::size_t least_vertices(Part::Kind kind, DrawnLine const& line) {
    return !is_ring(kind, line) ? 2U : kind == Part::Kind::coast ? 4U : 3U;
}

/// [m] To each vertex along a line, or around a ring, and to its end.
std::vector<double> distances_along(DrawnLine const& line, std::size_t count, bool is_closed) {
    std::vector<double> along{0.0};
    for (std::size_t i = 0; i < count; ++i) {
        double const step = i + 1 < count || is_closed ? distance(line[i], line[(i + 1) % count]) : 0.0;
        along.push_back(along.back() + step);
    }
    return along;
}

/// Removes the height of a vertex. That of an end goes to the next vertex, if that one has none.
void remove_ridge_height(std::vector<std::optional<double>>& heights_m, std::size_t vertex) {
    std::optional<double> const height_m = heights_m[vertex];
    bool const is_first = vertex == 0;
    bool const is_last = vertex + 1 == heights_m.size();
    erase_at(heights_m, vertex);
    std::optional<double>& next = is_first ? heights_m.front() : heights_m.back();
    if ((is_first || is_last) && !next) {
        next = height_m;
    }
}

/// Of vertices in a row at one place the first one stays, with the first height.
void merge_ridge_repeats(DrawnRidge& ridge) {
    for (std::size_t i = 1; i < ridge.line.size();) {
        if (ridge.line[i] != ridge.line[i - 1]) {
            ++i;
            continue;
        }
        ridge.heights_m[i - 1] = ridge.heights_m[i - 1] ? ridge.heights_m[i - 1] : ridge.heights_m[i];
        erase_at(ridge.line, i);
        erase_at(ridge.heights_m, i);
    }
}

/// Cleans and checks a part after a change between two vertices. Rivers follow a coast.
void finish_change(DrawResult& result, Part const& part, std::size_t first, std::size_t last) {
    Drawing& drawing = result.drawing;
    double const cell_m = drawing.grid.cell_m;
    DrawnLine& line = line_of_part(drawing, part, 0);
    if (part.kind == Part::Kind::ridge) {
        merge_ridge_repeats(drawing.ridges[part.number]);
    }
    line = remove_repeats(std::move(line));
    if (line.size() < least_vertices(part.kind, line)) {
        throw NotDrawn("studio.drawn", fmt::format("nothing would be left of {} here", name_of_part(part)),
                       line.front());
    }
    DrawnLine changed = line;
    if (part.kind == Part::Kind::lake || part.kind == Part::Kind::mask) {
        changed.push_back(changed.front());
    }
    require_no_loop(changed, is_ring(part.kind, line), cell_m);
    if (part.kind == Part::Kind::river) {
        std::size_t const end = std::min(last + 1, line.size() - 1);
        require_clear(drawing, part.number, first > 0 ? std::min(first, end) - 1 : 0, end, 0.5 * clearance_cells);
    } else if (part.kind == Part::Kind::coast) {
        erase_at(drawing.coasts, part.number); // it is apart from itself
        require_apart_from_coasts(drawing, changed);
        drawing.coasts.insert(drawing.coasts.begin() + static_cast<std::ptrdiff_t>(part.number), std::move(changed));
        cut_rivers_at_coasts(result);
    } else if (part.kind == Part::Kind::ridge) {
        DrawnLine const places = resample_line(changed, sampling_cells * cell_m);
        if (auto const at = first_near_lines(places, drawing.rivers, 0.5 * clearance_cells * cell_m)) {
            throw NotDrawn("studio.drawn", "the ridge would cross or touch a river here: no water crosses it", at);
        }
    }
}

/// Moves a vertex of a coast, a lake, a mask or a ridge, and others within reach. An end of a coast stays on the
/// border.
void move_shape_vertex(DrawResult& result, MoveVertex const& step, DrawnLine& line) {
    Grid const& grid = result.drawing.grid;
    bool const is_coast = step.of.kind == Part::Kind::coast;
    bool const is_closed = is_ring(step.of.kind, line);
    DrawnLine const before = line;
    std::size_t const count = is_coast && is_closed ? line.size() - 1 : line.size();
    std::size_t const vertex = step.vertex % count;
    bool const is_end = is_coast && !is_closed && (step.vertex == 0 || step.vertex + 1 == count);
    Vec2 const to = clip_to_grid(grid, step.to);
    Vec2 const by = (is_end ? nearest_on_border(grid, to) : to) - before[vertex];
    std::vector<double> const along = distances_along(before, count, is_closed);
    for (std::size_t i = 0; i < count; ++i) {
        bool const is_other_end = !is_closed && (i == 0 || i + 1 == count);
        double const between = std::fabs(along[i] - along[vertex]);
        double const away_m = is_closed ? std::min(between, along[count] - between) : between;
        if (i == vertex || (away_m < step.reach_m && !is_other_end)) {
            double const weight = i == vertex ? 1.0 : drag_weight(away_m, step.reach_m);
            line[i] = clip_to_grid(grid, before[i] + weight * by);
        }
    }
    if (is_coast && is_closed) {
        line.back() = line.front();
    }
    finish_change(result, step.of, 0, line.size() - 1);
}

} // namespace

void require_part(Drawing const& drawing, Part const& part) {
    std::size_t const counts[] = {drawing.rivers.size(), drawing.coasts.size(), drawing.lakes.size(),
                                  drawing.masks.size(),  drawing.pins.size(),   drawing.ridges.size()};
    if (part.number >= counts[static_cast<std::size_t>(part.kind)]) {
        throw NotDrawn("studio.drawn",
                       fmt::format("{} with the number {} is not there", name_of_part(part), part.number));
    }
}

DrawnLine& line_of_part(Drawing& drawing, Part const& part, std::size_t vertex) {
    require_part(drawing, part);
    DrawnLine& line = part.kind == Part::Kind::river   ? drawing.rivers[part.number].line
                      : part.kind == Part::Kind::coast ? drawing.coasts[part.number]
                      : part.kind == Part::Kind::lake  ? drawing.lakes[part.number].rings.front()
                      : part.kind == Part::Kind::ridge ? drawing.ridges[part.number].line
                                                       : drawing.masks[part.number];
    if (vertex >= line.size()) {
        throw NotDrawn("studio.drawn", fmt::format("{} has no vertex {}", name_of_part(part), vertex));
    }
    return line;
}

void require_height(double height_m, char const* what) {
    constexpr double deepest = -12000.0;
    constexpr double highest = 30000.0;
    refuse_if<BadParameter>(!(height_m >= deepest && height_m <= highest), "studio.drawn",
                            "{} lies between {} and {} m", what, deepest, highest);
}

std::string count_of(std::size_t count, char const* one, char const* more) {
    return fmt::format("{} {}", count, count == 1 ? one : more);
}

void apply_step(DrawResult& result, MoveVertex const& step) {
    if (step.of.kind == Part::Kind::pin) {
        move_pin(result, step);
        return;
    }
    DrawnLine& line = line_of_part(result.drawing, step.of, step.vertex);
    result.name = fmt::format("{} moved", name_of_part(step.of));
    if (step.of.kind == Part::Kind::river) {
        move_river_vertex(result, step);
    } else {
        move_shape_vertex(result, step, line);
    }
}

void apply_step(DrawResult& result, InsertVertex const& step) {
    require_vertices(step.of);
    DrawnLine& line = line_of_part(result.drawing, step.of, 0);
    result.name = fmt::format("a vertex of {}", name_of_part(step.of));
    bool const is_area = step.of.kind == Part::Kind::lake || step.of.kind == Part::Kind::mask;
    refuse_step_if(step.vertex > line.size() || (!is_area && (step.vertex == 0 || step.vertex == line.size())),
                   "a vertex is put between two others");
    auto const before = static_cast<std::ptrdiff_t>(step.vertex);
    line.insert(line.begin() + before, clip_to_grid(result.drawing.grid, step.at));
    if (step.of.kind == Part::Kind::ridge) {
        auto& heights_m = result.drawing.ridges[step.of.number].heights_m;
        heights_m.insert(heights_m.begin() + before, std::nullopt);
    }
    finish_change(result, step.of, step.vertex, step.vertex);
}

void apply_step(DrawResult& result, RemoveVertex const& step) {
    require_vertices(step.of);
    Drawing& drawing = result.drawing;
    DrawnLine& line = line_of_part(drawing, step.of, step.vertex);
    result.name = fmt::format("a vertex of {} removed", name_of_part(step.of));
    Vec2 const at = line[step.vertex];
    refuse_step_if(step.of.kind == Part::Kind::river && step.vertex + 1 != line.size() &&
                       meets_other_river(drawing, step.of.number, at),
                   "another river joins here: move it first", at);
    refuse_step_if(line.size() <= least_vertices(step.of.kind, line), "no vertex more can go: erase it as a whole", at);
    bool const is_closed_coast = step.of.kind == Part::Kind::coast && line.front() == line.back();
    erase_at(line, step.vertex);
    if (step.of.kind == Part::Kind::ridge) {
        remove_ridge_height(drawing.ridges[step.of.number].heights_m, step.vertex);
    }
    if (is_closed_coast && step.vertex == 0) {
        line.back() = line.front();
    } else if (is_closed_coast && step.vertex == line.size()) {
        line.front() = line.back();
    }
    std::size_t const vertex = std::min(step.vertex, line.size() - 1);
    finish_change(result, step.of, vertex, vertex);
}

void apply_step(DrawResult& result, Erase const& step) {
    Drawing& drawing = result.drawing;
    require_part(drawing, step.of);
    result.name = fmt::format("{} erased", name_of_part(step.of));
    std::size_t const number = step.of.number;
    switch (step.of.kind) {
    case Part::Kind::river: erase_river(result, number, step.alone); break;
    case Part::Kind::coast: erase_at(drawing.coasts, number); break;
    case Part::Kind::lake: erase_at(drawing.lakes, number); break;
    case Part::Kind::mask:
        erase_at(drawing.masks, number);
        if (number < drawing.mask_islands.size()) {
            erase_at(drawing.mask_islands, number);
        }
        break;
    case Part::Kind::pin: erase_at(drawing.pins, number); break;
    case Part::Kind::ridge: erase_at(drawing.ridges, number); break;
    }
}

void apply_step(DrawResult& result, Clear const&) {
    result.name = "an empty sheet";
    Drawing empty;
    empty.grid = std::move(result.drawing.grid);
    result.drawing = std::move(empty);
}

DrawResult drawn(Drawing drawing, DrawStep const& step) {
    DrawResult result{std::move(drawing), {}, {}};
    std::visit([&](auto const& one) { apply_step(result, one); }, step);
    require_no_circle(result.drawing);
    if (result.drawing.has_side_streams) { // there, a river that goes on where another ends is one with it
        result.drawing.rivers = merge_successive_rivers(result.drawing);
    }
    return result;
}

} // namespace thalweg::studio
