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

constexpr Colour tributary{0.42, 0.58, 0.74, 0.75};
constexpr Colour stem{0.05, 0.28, 0.58};

/// One arc: distance from the outlet [m] and height [m], downstream.
using Reach = std::vector<Vec2>;

/// The mouth of a tributary on the main stem.
struct Confluence {
    Vec2 at; ///< as in a Reach
    int order = 1;
};

/// The main stem and what flows into it.
struct Course {
    Reach stem; ///< from the outlet up; empty: none
    std::vector<Reach> tributaries;
    std::vector<Confluence> confluences;
};

void require_profile(ElevatedNetwork const& network, NetworkOrders const& orders) {
    std::size_t const arcs = network.planform.arc_count();
    refuse_if<BadInput>(
        network.arc_z.size() != arcs || orders.hack.size() != arcs || orders.arc_basin.size() != arcs ||
            orders.strahler.size() != arcs || orders.node_dist_out_m.size() != network.planform.node_count() ||
            std::any_of(orders.main_stem.begin(), orders.main_stem.end(), [arcs](ArcId arc) { return arc >= arcs; }),
        "draw.profile", "heights or orders are not those of the network of {} arcs; set heights and orders again",
        arcs);
}

Reach reach_of(ElevatedNetwork const& network, NetworkOrders const& orders, ArcId arc) {
    std::vector<Vec2> const& line = network.planform.arc(arc).line;
    std::vector<double> const& z = network.arc_z[arc];
    refuse_if<BadInput>(z.size() != line.size(), "draw.profile",
                        "arc {} has {} vertices and {} heights; set heights again", arc + 1, line.size(), z.size());
    if (orders.arc_basin[arc] < 1) { // it reaches no outlet
        return {};
    }
    Reach reach(line.size());
    double to_outlet = orders.node_dist_out_m[network.planform.to(arc)];
    for (std::size_t i = line.size(); i-- > 0;) {
        to_outlet += i + 1 < line.size() ? distance(line[i], line[i + 1]) : 0.0;
        refuse_if<BadInput>(!std::isfinite(to_outlet) || !std::isfinite(z[i]), "draw.profile",
                            "arc {}, vertex {}: place or height is not a number; mend the network", arc + 1, i);
        reach[i] = {to_outlet, z[i]};
    }
    return reach;
}

/// The main stem of all basins, the streams of its basin and their mouths on it.
Course course_of(ElevatedNetwork const& network, NetworkOrders const& orders) {
    require_profile(network, orders);
    Course course;
    std::vector<Reach> reaches;
    for (ArcId arc = 0; arc < network.planform.arc_count(); ++arc) {
        reaches.push_back(reach_of(network, orders, arc)); // all of them, to find what is wrong
    }
    if (orders.main_stem.empty()) {
        return course;
    }
    std::vector<bool> on_stem(reaches.size());
    for (auto arc = orders.main_stem.rbegin(); arc != orders.main_stem.rend(); ++arc) {
        on_stem[*arc] = true;
        course.stem.insert(course.stem.end(), reaches[*arc].rbegin(), reaches[*arc].rend());
    }
    for (ArcId arc = 0; arc < reaches.size(); ++arc) {
        if (!on_stem[arc] && !reaches[arc].empty() &&
            orders.arc_basin[arc] == orders.arc_basin[orders.main_stem.back()]) {
            course.tributaries.push_back(reaches[arc]);
        }
    }
    for (ArcId const arc : orders.main_stem) {
        int highest = 0;
        for (ArcId const other : network.planform.in(network.planform.to(arc))) {
            highest = on_stem[other] ? highest : std::max(highest, orders.strahler[other]);
        }
        if (highest > 0 && !reaches[arc].empty()) {
            course.confluences.push_back({reaches[arc].back(), highest});
        }
    }
    std::stable_sort(course.confluences.begin(), course.confluences.end(),
                     [](Confluence const& a, Confluence const& b) { return a.order > b.order; });
    return course;
}

Plot scales_of(Course const& course, Box box) {
    if (course.stem.empty()) {
        return {box, 0.0, 1.0, 0.0, 1.0};
    }
    Plot plot{box, 0.0, course.stem.front().x, course.stem.front().y, course.stem.front().y};
    auto const widen = [&plot](Reach const& reach) {
        for (Vec2 const p : reach) {
            plot.x_high = std::max(plot.x_high, p.x);
            plot.y_low = std::min(plot.y_low, p.y);
            plot.y_high = std::max(plot.y_high, p.y);
        }
    };
    widen(course.stem);
    std::for_each(course.tributaries.begin(), course.tributaries.end(), widen);
    settle_scales(plot);
    plot.x_low = 0.0;
    return plot;
}

std::vector<Vec2> on_plot(Reach const& reach, Plot const& plot) {
    std::vector<Vec2> line(reach.size());
    std::transform(reach.begin(), reach.end(), line.begin(), [&](Vec2 p) { return plot.at(p.x, p.y); });
    return line;
}

/// Ticks below the main stem, or above it near the axis, longer for higher orders, with the orders where there is room.
void draw_confluences(Cairo* sheet, Course const& course, Plot const& plot, double unit) {
    TextStyle const small{0.85 * unit, stem, Weight::normal, 0.15 * unit};
    std::vector<double> taken;
    for (Confluence const& confluence : course.confluences) {
        Vec2 const at = plot.at(confluence.at.x, confluence.at.y);
        double const length = unit * (0.4 + 0.3 * confluence.order);
        bool const below = at.y + length + 1.4 * unit < plot.box.bottom();
        Vec2 const end{at.x, at.y + (below ? length : -length)};
        draw_line(sheet, at, end, unit * (0.04 + 0.03 * confluence.order), stem);
        bool const free = std::none_of(taken.begin(), taken.end(),
                                       [&](double other) { return std::fabs(other - at.x) < 0.85 * unit; });
        if (free) {
            draw_text(sheet, {end.x, end.y + (below ? 0.9 : -0.3) * unit}, fmt::format("{}", confluence.order), small,
                      Anchor::middle);
            taken.push_back(at.x);
        }
    }
}

/// Draws the key from its right end.
/// \return width [px]
double draw_key_of_profile(Cairo* sheet, Vec2 right, double unit) {
    TextStyle const small{unit, faint_ink};
    double x = right.x;
    for (char const* const name : {"confluences by order", "tributaries", "main stem"}) {
        draw_text(sheet, {x, right.y}, name, small, Anchor::end);
        x -= text_width(sheet, name, small) + 0.6 * unit;
        bool const is_tick = name[0] == 'c';
        bool const is_stem = name[0] == 'm';
        Vec2 const end{x, right.y - (is_tick ? 0.8 : 0.35) * unit};
        Vec2 const begin = is_tick ? Vec2{x, right.y + 0.1 * unit} : Vec2{x - 2.2 * unit, end.y};
        draw_line(sheet, begin, end,
                  unit * (is_stem   ? 0.19
                          : is_tick ? 0.1
                                    : 0.08),
                  is_tick || is_stem ? stem : tributary);
        x = begin.x - 1.4 * unit;
    }
    return right.x - x;
}

constexpr Colour line_colour{0.45, 0.28, 0.14};
constexpr Colour ground_colour{0.72, 0.56, 0.38, 0.22};

void require_curve(std::vector<Vec2> const& curve, double integral) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!(curve[i].x >= 0.0 && curve[i].x <= 1.0) || !std::isfinite(curve[i].y)) {
            throw BadInput("draw.hypsometry",
                           fmt::format("point {} is ({}, {}): a share of the area in [0, 1] and a height are required",
                                       i + 1, curve[i].x, curve[i].y));
        }
    }
    refuse_if<BadInput>(!curve.empty() && !std::isnan(integral) && !(integral >= 0.0 && integral <= 1.0),
                        "draw.hypsometry", "the integral is {}, must lie in [0, 1]", integral);
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
            throw BadInput(
                "draw.curve",
                fmt::format("the increment at x = {} is {}, not finite; correct its expression", i + 1, increments[i]));
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

Picture profile(ElevatedNetwork const& network, NetworkOrders const& orders, ProfileParams const& params) {
    require_in("draw.profile", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.profile", "height_px", params.height_px, Range::between(200, 8000), "pixels");
    Course const course = course_of(network, orders);
    double const width = params.width_px;
    double const height = params.height_px;
    double const unit = 14.0 * std::max(0.5, std::min(width / 1000.0, height / 560.0));
    double const top = params.title.empty() ? 4.2 * unit : 5.8 * unit;
    Box const box{6.0 * unit, top, width - 8.0 * unit, height - top - 4.6 * unit};

    return paint(width, height, params.format, [&](Cairo* sheet) {
        Plot const plot = scales_of(course, box);
        bool const in_km = plot.x_high >= 2000.0;
        Plot axes = plot;
        axes.x_high = in_km ? plot.x_high / 1000.0 : plot.x_high;
        Vec2 const words{box.x, box.y - 2.0 * unit};
        draw_text_within(sheet, {words.x, 2.2 * unit}, params.title, {1.35 * unit, ink, Weight::bold}, box.width);
        double const key = course.stem.empty() ? 0.0 : draw_key_of_profile(sheet, {box.right(), words.y}, unit);
        draw_text_within(sheet, words, "Long profile: main stem, from the outlet up to its farthest source",
                         {1.05 * unit, ink}, box.width - key);
        draw_axes(sheet, axes, in_km ? "distance from the outlet [km]" : "distance from the outlet [m]", "height [m]",
                  unit);
        if (course.stem.empty()) {
            draw_text(sheet, {box.x + 0.5 * box.width, box.y + 0.5 * box.height}, "no streams", {unit, faint_ink},
                      Anchor::middle);
            return;
        }
        cairo_set_line_cap(sheet, CAIRO_LINE_CAP_ROUND);
        set_colour(sheet, tributary);
        cairo_set_line_width(sheet, 0.08 * unit);
        for (Reach const& reach : course.tributaries) {
            trace_line(sheet, on_plot(reach, plot), 0.0);
            cairo_stroke(sheet);
        }
        draw_ground(sheet, on_plot(course.stem, plot), box.bottom(), fill, stem, 0.19 * unit);
        cairo_set_line_cap(sheet, CAIRO_LINE_CAP_BUTT);
        draw_confluences(sheet, course, plot, unit);
    });
}

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
        draw_ground(sheet, line, plot.box.bottom(), ground_colour, line_colour, 0.17 * unit);
        if (has_integral) {
            draw_mean(sheet, plot, low, high, integral, unit);
        }
    });
}

} // namespace thalweg::draw
