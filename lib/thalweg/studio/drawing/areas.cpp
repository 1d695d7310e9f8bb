// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <thalweg/geometry/polylines.hpp>
#include <thalweg/studio/internal/drawing_steps.hpp>
#include <thalweg/studio/internal/drawn_lines.hpp>

namespace thalweg::studio {
namespace {

void require_level(std::optional<double> level_m) {
    if (level_m) {
        require_height(*level_m, "a lake's level");
    }
}

} // namespace

void apply_step(DrawResult& result, DrawLake const& step) {
    result.name = "a lake";
    Drawing& drawing = result.drawing;
    DrawnLine ring = ring_from_stroke(drawing.grid, step.points);
    bool const has_river = std::ranges::any_of(drawing.rivers, [&](DrawnRiver const& river) {
        return std::ranges::any_of(resample_line(river.line, drawing.grid.cell_m),
                                   [&](Vec2 p) { return geometry::contains(ring, p); });
    });
    if (!has_river) {
        result.said.emplace_back("no river runs through this lake: it holds water only where one does");
    }
    require_level(step.level_m);
    drawing.lakes.push_back({{std::move(ring)}, step.level_m});
}

void apply_step(DrawResult& result, SetLevel const& step) {
    line_of_part(result.drawing, {Part::Kind::lake, step.lake}, 0);
    require_level(step.level_m);
    result.drawing.lakes[step.lake].level_m = step.level_m;
    result.name = step.level_m ? fmt::format("lake level {} m", *step.level_m) : "lake level by the terrain";
}

void apply_step(DrawResult& result, DrawMask const& step) {
    result.name = "a mask";
    result.drawing.masks.push_back(ring_from_stroke(result.drawing.grid, step.points));
}

} // namespace thalweg::studio
