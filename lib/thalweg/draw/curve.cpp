// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/curve.hpp>

#include <algorithm>
#include <cmath>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/draw/internal/axes.hpp>
#include <thalweg/draw/internal/canvas.hpp>

namespace thalweg::draw {
namespace {

constexpr Colour curve_colour{0.05, 0.28, 0.58};
constexpr Colour fill{0.30, 0.52, 0.76, 0.14};

void draw_curve(Cairo* sheet, Box box, std::vector<Vec2> const& points, std::string const& name, double unit) {
    Plot plot{box, 0.0, 1.0, 0.0, 0.0};
    for (Vec2 const p : points) {
        plot.x_high = std::max(plot.x_high, p.x);
        plot.y_low = std::min(plot.y_low, p.y);
        plot.y_high = std::max(plot.y_high, p.y);
    }
    settle_scales(plot);
    plot.x_low = 0.0;
    draw_axes(sheet, plot, "distance from the valley [cells]", name, unit);
    if (points.empty()) {
        draw_text(sheet, {box.x + 0.5 * box.width, box.y + 0.5 * box.height}, "no dilation", {unit, faint_ink},
                  Anchor::middle);
        return;
    }
    std::vector<Vec2> line(points.size());
    std::transform(points.begin(), points.end(), line.begin(), [&](Vec2 p) { return plot.at(p.x, p.y); });
    trace_line(sheet, line, 0.0);
    cairo_line_to(sheet, line.back().x, plot.at(0.0, 0.0).y);
    cairo_line_to(sheet, line.front().x, plot.at(0.0, 0.0).y);
    cairo_close_path(sheet);
    set_colour(sheet, fill);
    cairo_fill(sheet);
    trace_line(sheet, line, 0.0);
    set_colour(sheet, curve_colour);
    cairo_set_line_width(sheet, 0.15 * unit);
    cairo_stroke(sheet);
    // Steps are whole numbers: dots while they can be told apart, and always where a line has no length.
    if (box.width > 0.8 * unit * static_cast<double>(line.size()) || line.size() == 1) {
        for (Vec2 const p : line) {
            cairo_new_sub_path(sheet);
            cairo_arc(sheet, p.x, p.y, 0.22 * unit, 0.0, 6.28318530717958648);
        }
        cairo_fill(sheet);
    }
}

} // namespace

Picture curve(std::vector<double> const& increments, CurveParams const& params) {
    require_in("draw.curve", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.curve", "height_px", params.height_px, Range::between(200, 8000), "pixels");
    std::vector<Vec2> steps;
    std::vector<Vec2> sums;
    double sum = 0.0;
    for (std::size_t i = 0; i < increments.size(); ++i) {
        double const x = static_cast<double>(i + 1);
        sum += increments[i];
        if (!std::isfinite(sum)) {
            throw BadInput(fmt::format("draw.curve: the increment at x = {} is {}, not finite; correct its expression",
                                       i + 1, increments[i]));
        }
        if (i == 0) {
            sums.push_back({0.0, 0.0});
        }
        steps.push_back({x, increments[i]});
        sums.push_back({x, sum});
    }
    double const width = params.width_px;
    double const height = params.height_px;
    double const unit = 14.0 * std::max(0.45, std::min(width / 1000.0, height / 560.0));
    double const top = 4.2 * unit;
    bool const abreast = width > 1.1 * height;
    double const left = 6.0 * unit;
    double const below = 4.8 * unit;
    Box const first{left, top, (abreast ? 0.5 * width : width) - left - 1.4 * unit,
                    (abreast ? height - top : 0.5 * (height - top)) - below};
    Box second = first;
    (abreast ? second.x : second.y) += abreast ? 0.5 * width : 0.5 * (height - top);

    return paint(width, height, params.format, [&](Cairo* sheet) {
        TextStyle const title{1.35 * unit, ink, Weight::bold};
        std::string const text = params.increment.empty() ? "Increment" : "Increment: " + params.increment;
        draw_text_within(sheet, {first.x, 2.2 * unit}, text, title, width - first.x - 1.4 * unit);
        draw_curve(sheet, first, steps, "Δh(x) [m]", unit);
        draw_curve(sheet, second, sums, "H(d) [m]", unit);
    });
}

} // namespace thalweg::draw
