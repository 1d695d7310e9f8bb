// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <cairo.h>

#include <thalweg/draw/internal/labels.hpp>
#include <thalweg/draw/internal/map.hpp>
#include <thalweg/draw/internal/water.hpp>
#include <thalweg/geometry/polylines.hpp>

namespace thalweg::draw {
namespace {

/// Channel width grows with the square root of discharge (Leopold and Maddock 1953), which grows with area.
constexpr double width_exponent = 0.5;

/// The area; 0: unknown.
double known(double area_m2) {
    return std::isfinite(area_m2) && area_m2 > 0.0 ? area_m2 : 0.0;
}

/// share: [0, 1] of the largest.
LineStyle river_style(double share, RiverScale const& scale, double unit) {
    double const widest = std::min(0.9 * (scale.highest_order - 1), 4.2);
    auto const blend = [share](double small, double large) { return small + (large - small) * share; };
    return {std::max(1.0, (1.2 + widest * share) * unit), {blend(0.25, 0.07), blend(0.50, 0.31), blend(0.80, 0.64)}};
}

std::vector<Vec2> on_sheet(std::vector<Vec2> const& line, Window const& window) {
    constexpr double unseen_px = 0.2;
    std::vector<Vec2> out;
    for (Vec2 const p : line) {
        Vec2 const at = near_sheet(window.at(p));
        if (out.empty() || distance(out.back(), at) >= unseen_px) {
            out.push_back(at);
        }
    }
    if (line.size() > 1) { // the end is always kept
        out.resize(std::max<std::size_t>(2, out.size()));
        out.back() = near_sheet(window.at(line.back()));
    }
    return geometry::simplify(out, unseen_px);
}

} // namespace

RiverScale river_scale(MapSheet const& sheet) {
    RiverScale scale;
    if (sheet.orders != nullptr && !sheet.orders->strahler.empty()) {
        scale.highest_order = *std::max_element(sheet.orders->strahler.begin(), sheet.orders->strahler.end());
    }
    for (double const area : sheet.areas_m2) {
        scale.largest_area_m2 = std::max(scale.largest_area_m2, known(area));
    }
    return scale;
}

bool has_ridges(MapSheet const& sheet) {
    return sheet.ridges != nullptr && !sheet.ridges->lines.empty();
}

Grid const& whole_grid(MapSheet const& sheet) {
    return sheet.whole ? sheet.whole->grid : sheet.dem.grid();
}

ContourKind kind_of_contour(double height_m, double interval_m) {
    if (interval_m <= 0.0) {
        return ContourKind::ordinary;
    }
    double const steps = height_m / (index_every * interval_m);
    return std::fabs(steps - std::floor(steps + 0.5)) < 1e-6 ? ContourKind::index : ContourKind::ordinary;
}

Shores shores_on_sheet(Mask const& water, Window const& window) {
    Shores out = shores(water);
    for (std::vector<Vec2>& shore : out) {
        shore = on_sheet(shore, window);
    }
    return out;
}

LinesOnSheet lines_on_sheet(MapSheet const& sheet, Window const& window) {
    LinesOnSheet out;
    for (ArcId a = 0; sheet.network != nullptr && a < sheet.network->planform.arc_count(); ++a) {
        out.rivers.push_back(on_sheet(sheet.network->planform.arc(a).line, window));
    }
    for (auto const& [height_m, line] : sheet.contours) {
        bool const is_shore = sheet.sea && height_m <= 0.0;
        out.contours.push_back(is_shore ? std::vector<Vec2>{} : on_sheet(line, window));
    }
    return out;
}

LineStyle contour_style(ContourKind kind, double unit) {
    return kind == ContourKind::index ? LineStyle{0.9 * unit, {0.45, 0.27, 0.13, 0.60}}
                                      : LineStyle{0.5 * unit, {0.45, 0.27, 0.13, 0.38}};
}

LineStyle style_of_area(double area_m2, RiverScale const& scale, double unit) {
    return river_style(std::pow(known(area_m2) / scale.largest_area_m2, width_exponent), scale, unit);
}

LineStyle style_of_order(int order, RiverScale const& scale, double unit) {
    return river_style(static_cast<double>(order - 1) / std::max(1, scale.highest_order - 1), scale, unit);
}

LineStyle ridge_style(double unit) {
    return {std::max(0.8, 1.1 * unit), {0.37, 0.20, 0.08, 0.85}};
}

void draw_contours(Cairo* canvas, MapSheet const& sheet, LinesOnSheet const& lines, Window const& window,
                   double interval_m, double unit, std::vector<Label> const& labels) {
    cairo_save(canvas);
    cairo_set_fill_rule(canvas, CAIRO_FILL_RULE_EVEN_ODD);
    cairo_rectangle(canvas, window.frame.x, window.frame.y, window.frame.width, window.frame.height);
    for (Label const& label : labels) {
        for (Vec2 const corner : label.room.corners()) {
            cairo_line_to(canvas, corner.x, corner.y);
        }
        cairo_close_path(canvas);
        cairo_new_sub_path(canvas);
    }
    cairo_clip(canvas);
    for (ContourKind const kind : {ContourKind::ordinary, ContourKind::index}) {
        LineStyle const style = contour_style(kind, unit);
        set_colour(canvas, style.colour);
        cairo_set_line_width(canvas, style.width_px);
        for (std::size_t c = 0; c < lines.contours.size(); ++c) {
            if (!lines.contours[c].empty() && kind_of_contour(sheet.contours[c].first, interval_m) == kind) {
                trace_line(canvas, lines.contours[c], 0.0);
                cairo_stroke(canvas);
            }
        }
    }
    cairo_restore(canvas);
}

void draw_ridges(Cairo* canvas, MapSheet const& sheet, Window const& window, double unit) {
    if (!has_ridges(sheet)) {
        return;
    }
    LineStyle const style = ridge_style(unit);
    set_colour(canvas, style.colour);
    cairo_set_line_width(canvas, style.width_px);
    for (RidgeLine const& ridge : sheet.ridges->lines) {
        trace_line(canvas, on_sheet(in_plan(ridge.line), window), 0.0);
        cairo_stroke(canvas);
    }
}

void draw_rivers(Cairo* canvas, MapSheet const& sheet, LinesOnSheet const& lines, Window const& window, double unit) {
    RiverScale const scale = river_scale(sheet);
    if (scale.highest_order == 0) {
        return;
    }
    std::vector<std::pair<double, ArcId>> arcs; // wide ones on top
    for (ArcId a = 0; a < sheet.network->planform.arc_count(); ++a) {
        arcs.emplace_back(scale.largest_area_m2 > 0.0 ? known(sheet.areas_m2[a]) : sheet.orders->strahler[a], a);
    }
    std::stable_sort(arcs.begin(), arcs.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
    // Curves within half a pixel look like corners, and large maps would have one for each of many vertices.
    double const bend_px = 0.75 * whole_grid(sheet).cell_m * window.px_per_m;
    double const corner_px = bend_px < 0.5 ? 0.0 : bend_px;
    cairo_set_line_cap(canvas, CAIRO_LINE_CAP_ROUND);
    for (auto const& [size, a] : arcs) {
        LineStyle const style = scale.largest_area_m2 > 0.0 ? style_of_area(size, scale, unit)
                                                            : style_of_order(static_cast<int>(size), scale, unit);
        trace_line(canvas, lines.rivers[a], corner_px);
        set_colour(canvas, style.colour);
        cairo_set_line_width(canvas, style.width_px);
        cairo_stroke(canvas);
    }
    cairo_set_line_cap(canvas, CAIRO_LINE_CAP_BUTT);
}

} // namespace thalweg::draw
