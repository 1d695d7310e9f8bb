// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/diagrams.hpp>

#include <algorithm>
#include <cmath>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
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
    draw_ground(sheet, line, plot.at(0.0, 0.0).y, fill, curve_colour, 0.15 * unit);
    // Steps are whole numbers: dots are drawn while they are distinguishable, and always for a line of length 0.
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

namespace {

constexpr Colour tributary{0.42, 0.58, 0.74, 0.75};
constexpr Colour stem{0.05, 0.28, 0.58};

/// One arc: distance from the outlet [m] and height [m], downstream.
struct Reach {
    std::vector<Vec2> points;
    int hack = 1;
};

std::vector<Reach> reaches_of(ElevatedNetwork const& network, NetworkOrders const& orders) {
    std::size_t const arcs = network.planform.arc_count();
    refuse_if<BadInput>(
        network.arc_z.size() != arcs || orders.hack.size() != arcs || orders.arc_basin.size() != arcs ||
            orders.node_dist_out_m.size() != network.planform.node_count(),
        "draw.profile: heights or orders are not those of the network of {} arcs; set heights and orders again", arcs);
    std::vector<Reach> reaches;
    std::size_t number_of_arc = 0;
    for (ArcId arc = 0; arc < network.planform.arc_count(); ++arc) {
        std::size_t const k = number_of_arc++;
        std::vector<Vec2> const& line = network.planform.arc(arc).line;
        std::vector<double> const& z = network.arc_z[k];
        refuse_if<BadInput>(z.size() != line.size(),
                            "draw.profile: arc {} has {} vertices and {} heights; set heights again", k + 1,
                            line.size(), z.size());
        if (orders.arc_basin[k] < 1 || line.empty()) {
            continue;
        }
        Reach reach{std::vector<Vec2>(line.size()), orders.hack[k]};
        double to_outlet = orders.node_dist_out_m[network.planform.to(arc)];
        for (std::size_t i = line.size(); i-- > 0;) {
            to_outlet += i + 1 < line.size() ? distance(line[i], line[i + 1]) : 0.0;
            refuse_if<BadInput>(!std::isfinite(to_outlet) || !std::isfinite(z[i]),
                                "draw.profile: arc {}, vertex {}: place or height is not a number; mend the network",
                                k + 1, i);
            reach.points[i] = {to_outlet, z[i]};
        }
        reaches.push_back(std::move(reach));
    }
    // Main stems last, on top of the others.
    std::stable_sort(reaches.begin(), reaches.end(), [](Reach const& a, Reach const& b) { return a.hack > b.hack; });
    return reaches;
}

Plot scales_of(std::vector<Reach> const& reaches, Box box) {
    if (reaches.empty()) {
        return {box, 0.0, 1.0, 0.0, 1.0};
    }
    Vec2 const first = reaches.front().points.front();
    Plot plot{box, 0.0, first.x, first.y, first.y};
    for (Reach const& reach : reaches) {
        for (Vec2 const p : reach.points) {
            plot.x_high = std::max(plot.x_high, p.x);
            plot.y_low = std::min(plot.y_low, p.y);
            plot.y_high = std::max(plot.y_high, p.y);
        }
    }
    settle_scales(plot);
    plot.x_low = 0.0;
    return plot;
}

} // namespace

Picture profile(ElevatedNetwork const& network, NetworkOrders const& orders, ProfileParams const& params) {
    require_in("draw.profile", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.profile", "height_px", params.height_px, Range::between(200, 8000), "pixels");
    std::vector<Reach> const reaches = reaches_of(network, orders);
    double const width = params.width_px;
    double const height = params.height_px;
    double const unit = 14.0 * std::max(0.5, std::min(width / 1000.0, height / 560.0));
    Box const box{6.0 * unit, 4.2 * unit, width - 8.0 * unit, height - 8.8 * unit};

    return paint(width, height, params.format, [&](Cairo* sheet) {
        Plot plot = scales_of(reaches, box);
        bool const in_km = plot.x_high >= 2000.0;
        Plot axes = plot;
        axes.x_high = in_km ? plot.x_high / 1000.0 : plot.x_high;
        TextStyle const title{1.35 * unit, ink, Weight::bold};
        TextStyle const small{unit, faint_ink};
        double legend_width = reaches.empty() ? 0.0 : unit;
        for (char const* name : {"main stem", "tributaries"}) {
            legend_width += reaches.empty() ? 0.0 : text_width(sheet, name, small) + 4.2 * unit;
        }
        draw_text_within(sheet, {box.x, 2.2 * unit},
                         params.title.empty() ? "Long profiles" : params.title + ": long profiles", title,
                         box.width - legend_width);
        draw_axes(sheet, axes, in_km ? "distance from the outlet [km]" : "distance from the outlet [m]", "height [m]",
                  unit);
        if (reaches.empty()) {
            draw_text(sheet, {box.x + 0.5 * box.width, box.y + 0.5 * box.height}, "no streams", {unit, faint_ink},
                      Anchor::middle);
            return;
        }
        cairo_set_line_cap(sheet, CAIRO_LINE_CAP_ROUND);
        for (Reach const& reach : reaches) {
            std::vector<Vec2> line(reach.points.size());
            std::transform(reach.points.begin(), reach.points.end(), line.begin(),
                           [&](Vec2 p) { return plot.at(p.x, p.y); });
            trace_line(sheet, line, 0.0);
            set_colour(sheet, reach.hack == 1 ? stem : tributary);
            cairo_set_line_width(sheet, unit * (reach.hack == 1 ? 0.19 : reach.hack == 2 ? 0.09 : 0.06));
            cairo_stroke(sheet);
        }
        cairo_set_line_cap(sheet, CAIRO_LINE_CAP_BUTT);
        double x = box.right();
        for (bool const main : {false, true}) {
            std::string const name = main ? "main stem" : "tributaries";
            draw_text(sheet, {x, 2.2 * unit}, name, small, Anchor::end);
            x -= text_width(sheet, name, small) + 0.6 * unit;
            draw_line(sheet, {x - 2.2 * unit, 1.85 * unit}, {x, 1.85 * unit}, unit * (main ? 0.19 : 0.08),
                      main ? stem : tributary);
            x -= 3.6 * unit;
        }
    });
}

namespace {

constexpr Colour line_colour{0.45, 0.28, 0.14};
constexpr Colour ground{0.72, 0.56, 0.38, 0.22};

void require_curve(std::vector<Vec2> const& curve, double integral) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!(curve[i].x >= 0.0 && curve[i].x <= 1.0) || !std::isfinite(curve[i].y)) {
            throw BadInput(fmt::format(
                "draw.hypsometry: point {} is ({}, {}): a share of the area in [0, 1] and a height are required", i + 1,
                curve[i].x, curve[i].y));
        }
    }
    refuse_if<BadInput>(!curve.empty() && !std::isnan(integral) && !(integral >= 0.0 && integral <= 1.0),
                        "draw.hypsometry: the integral is {}, must lie in [0, 1]", integral);
}

/// A dashed line at the mean height: the integral is its position between the lowest and the highest.
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
    require_curve(curve, integral);
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
        std::vector<Vec2> line(curve.size());
        std::transform(curve.begin(), curve.end(), line.begin(), [&](Vec2 p) { return plot.at(100.0 * p.x, p.y); });
        draw_ground(sheet, line, plot.box.bottom(), ground, line_colour, 0.17 * unit);
        if (has_integral) {
            draw_mean(sheet, plot, low, high, integral, unit);
        }
    });
}

} // namespace thalweg::draw
