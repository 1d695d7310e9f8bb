// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/profile.hpp>

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

constexpr Colour tributary{0.42, 0.58, 0.74, 0.75};
constexpr Colour stem{0.05, 0.28, 0.58};

/// One arc: distance from the outlet [m] and height [m], downstream.
struct Reach {
    std::vector<Vec2> points;
    int hack = 1;
};

std::vector<Reach> reaches_of(ElevatedNetwork const& network, NetworkOrders const& orders) {
    std::size_t const arcs = network.plan.arc_count();
    if (network.arc_z.size() != arcs || orders.hack.size() != arcs || orders.arc_basin.size() != arcs ||
        orders.node_dist_out_m.size() != network.plan.node_count()) {
        throw BadInput(fmt::format(
            "draw.profile: heights or orders are not those of the network of {} arcs; set heights and orders again",
            arcs));
    }
    std::vector<Reach> reaches;
    std::size_t number_of_arc = 0;
    for (ArcId arc = 0; arc < network.plan.arc_count(); ++arc) {
        std::size_t const k = number_of_arc++;
        std::vector<Vec2> const& line = network.plan.arc(arc).line;
        std::vector<double> const& z = network.arc_z[k];
        if (z.size() != line.size()) {
            throw BadInput(fmt::format("draw.profile: arc {} has {} vertices and {} heights; set heights again", k + 1,
                                       line.size(), z.size()));
        }
        if (orders.arc_basin[k] < 1 || line.empty()) {
            continue;
        }
        Reach reach{std::vector<Vec2>(line.size()), orders.hack[k]};
        double to_outlet = orders.node_dist_out_m[network.plan.to(arc)];
        for (std::size_t i = line.size(); i-- > 0;) {
            to_outlet += i + 1 < line.size() ? distance(line[i], line[i + 1]) : 0.0;
            if (!std::isfinite(to_outlet) || !std::isfinite(z[i])) {
                throw BadInput(fmt::format("draw.profile: arc {}, vertex {}: place or height is not a number; mend the "
                                           "network",
                                           k + 1, i));
            }
            reach.points[i] = {to_outlet, z[i]};
        }
        reaches.push_back(std::move(reach));
    }
    // Main stems last: they lie on top.
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

} // namespace thalweg::draw
