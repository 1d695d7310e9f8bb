// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/lines.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <cairo.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/draw/internal/canvas.hpp>

namespace thalweg::draw {
namespace {

constexpr Colour link_colour{0.05, 0.28, 0.58};

struct LinesBox {
    Vec2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vec2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

LinesBox box_of_lines(std::vector<std::vector<Vec2>> const& lines) {
    LinesBox all;
    for (auto const& line : lines) {
        for (Vec2 const p : line) {
            if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
                throw BadInput("draw.lines: a line has a coordinate that is not finite");
            }
            all.low = {std::min(all.low.x, p.x), std::min(all.low.y, p.y)};
            all.high = {std::max(all.high.x, p.x), std::max(all.high.y, p.y)};
        }
    }
    return all;
}

} // namespace

Picture lines(std::vector<std::vector<Vec2>> const& lines, LinesParams const& params) {
    require_in("draw.lines", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.lines", "height_px", params.height_px, Range::between(200, 8000), "pixels");
    double const width = params.width_px;
    double const height = params.height_px;
    double const unit = 0.014 * std::min(width, height);
    double const top = params.title.empty() ? 2.0 * unit : 4.2 * unit;
    Box const box{2.0 * unit, top, width - 4.0 * unit, height - top - 2.0 * unit};
    LinesBox const all = box_of_lines(lines);
    double const span_x = std::max(all.high.x - all.low.x, 1e-9);
    double const span_y = std::max(all.high.y - all.low.y, 1e-9);
    double const scale = std::min(box.width / span_x, box.height / span_y);
    double const left = box.x + 0.5 * (box.width - scale * span_x);
    double const bottom = box.bottom() - 0.5 * (box.height - scale * span_y);
    return paint(width, height, params.format, [&](Cairo* sheet) {
        if (!params.title.empty()) {
            draw_text_within(sheet, {box.x, 2.4 * unit}, params.title, {1.35 * unit, ink, Weight::bold}, box.width);
        }
        set_colour(sheet, link_colour);
        cairo_set_line_width(sheet, std::clamp(0.12 * scale, 0.4, 2.0));
        cairo_set_line_cap(sheet, CAIRO_LINE_CAP_ROUND);
        cairo_set_line_join(sheet, CAIRO_LINE_JOIN_ROUND);
        for (auto const& line : lines) {
            std::vector<Vec2> drawn;
            for (Vec2 const p : line) {
                drawn.push_back({left + scale * (p.x - all.low.x), bottom - scale * (p.y - all.low.y)});
            }
            trace_line(sheet, drawn, 0.0);
            cairo_stroke(sheet);
        }
    });
}

} // namespace thalweg::draw
