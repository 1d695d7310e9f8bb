// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/hypsometry.hpp>

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

constexpr Colour line_colour{0.45, 0.28, 0.14};
constexpr Colour ground{0.72, 0.56, 0.38, 0.22};

void demand_curve(std::vector<Vec2> const& curve, double integral) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!(curve[i].x >= 0.0 && curve[i].x <= 1.0) || !std::isfinite(curve[i].y)) {
            throw BadInput(fmt::format(
                "draw.hypsometry: point {} is ({}, {}): a share of the area in [0, 1] and a height are required", i + 1,
                curve[i].x, curve[i].y));
        }
    }
    if (!curve.empty() && !std::isnan(integral) && !(integral >= 0.0 && integral <= 1.0)) {
        throw BadInput(fmt::format("draw.hypsometry: the integral is {}, must lie in [0, 1]", integral));
    }
}

/// Fills the ground below the curve and draws the curve.
void draw_ground(Cairo* sheet, Plot const& plot, std::vector<Vec2> const& curve, double unit) {
    std::vector<Vec2> line(curve.size());
    std::transform(curve.begin(), curve.end(), line.begin(), [&](Vec2 p) { return plot.at(100.0 * p.x, p.y); });
    trace_line(sheet, line, 0.0);
    cairo_line_to(sheet, line.back().x, plot.box.bottom());
    cairo_line_to(sheet, line.front().x, plot.box.bottom());
    cairo_close_path(sheet);
    set_colour(sheet, ground);
    cairo_fill(sheet);
    trace_line(sheet, line, 0.0);
    set_colour(sheet, line_colour);
    cairo_set_line_width(sheet, 0.17 * unit);
    cairo_stroke(sheet);
}

/// A dashed line at the mean height: the integral is where that lies between the lowest and the highest.
void draw_mean(Cairo* sheet, Plot const& plot, double low, double high, double integral, double unit) {
    double const mean = low + integral * (high - low);
    Vec2 const right = plot.at(100.0, mean);
    double const dash = 0.5 * unit;
    cairo_set_dash(sheet, &dash, 1, 0.0);
    draw_line(sheet, plot.at(0.0, mean), right, 0.08 * unit, faint_ink);
    cairo_set_dash(sheet, nullptr, 0, 0.0);
    double const range = high - low;
    int const decimals = range > 0.0 && range < 10.0 ? 2 : range < 100.0 ? 1 : 0;
    TextStyle const small{unit, faint_ink, Weight::normal, 0.2 * unit};
    draw_text(sheet, {right.x - 0.6 * unit, right.y - 0.5 * unit}, "mean " + number(mean, decimals) + " m", small,
              Anchor::end);
}

} // namespace

Picture hypsometry(std::vector<Vec2> const& curve, double integral, HypsometryParams const& params) {
    require_in("draw.hypsometry", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.hypsometry", "height_px", params.height_px, Range::between(200, 8000), "pixels");
    demand_curve(curve, integral);
    double const width = params.width_px;
    double const height = params.height_px;
    double const unit = 14.0 * std::max(0.5, std::min(width / 1000.0, height / 640.0));
    Plot plot{{6.5 * unit, 4.4 * unit, width - 8.5 * unit, height - 9.0 * unit}, 0.0, 100.0, 0.0, 0.0};
    double low = 0.0;
    double high = 0.0;
    if (!curve.empty()) {
        auto const [lowest, highest] =
            std::minmax_element(curve.begin(), curve.end(), [](Vec2 a, Vec2 b) { return a.y < b.y; });
        low = lowest->y;
        high = highest->y;
    }
    plot.y_low = low;
    plot.y_high = high;
    settle_scales(plot);

    return paint(width, height, params.format, [&](Cairo* sheet) {
        bool const has_integral = !curve.empty() && !std::isnan(integral);
        std::string words = params.title.empty() ? "Hypsometric curve" : params.title + ": hypsometric curve";
        if (has_integral) {
            words += fmt::format(", integral {:.3f}", integral);
        }
        draw_text_within(sheet, {plot.box.x, 2.4 * unit}, words, {1.35 * unit, ink, Weight::bold}, plot.box.width);
        draw_axes(sheet, plot, "share of the area above [%]", "height [m]", unit);
        if (curve.empty()) {
            draw_text(sheet, {plot.box.x + 0.5 * plot.box.width, plot.box.y + 0.5 * plot.box.height}, "no heights",
                      {unit, faint_ink}, Anchor::middle);
            return;
        }
        draw_ground(sheet, plot, curve, unit);
        if (has_integral) {
            draw_mean(sheet, plot, low, high, integral, unit);
        }
    });
}

} // namespace thalweg::draw
