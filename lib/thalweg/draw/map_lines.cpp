// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/map_lines.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <cairo.h>

#include <thalweg/draw/internal/axes.hpp>

namespace thalweg::draw {
namespace {

ContourKind kind_of_contour(double height_m, double interval_m) {
    if (interval_m <= 0.0) {
        return ContourKind::ordinary;
    }
    double const steps = height_m / (index_every * interval_m);
    return std::fabs(steps - std::floor(steps + 0.5)) < 1e-6 ? ContourKind::index : ContourKind::ordinary;
}

std::vector<Vec2> on_sheet(std::vector<Vec2> const& line, Window const& window) {
    std::vector<Vec2> out(line.size());
    std::transform(line.begin(), line.end(), out.begin(), [&](Vec2 p) { return window.at(p); });
    return out;
}

/// A stretch of a line that is straight enough to carry a label.
struct Seat {
    Vec2 from;
    Vec2 to;
    Vec2 middle() const { return {0.5 * (from.x + to.x), 0.5 * (from.y + to.y)}; }
};

/// Point at a distance along a line. along: [px] of every vertex from the first.
Vec2 point_at(std::vector<Vec2> const& line, std::vector<double> const& along, double where) {
    auto const k = static_cast<std::size_t>(std::upper_bound(along.begin(), along.end(), where) - along.begin());
    if (k == 0 || k == line.size()) {
        return k == 0 ? line.front() : line.back();
    }
    double const step = along[k] - along[k - 1];
    double const share = step > 0.0 ? (where - along[k - 1]) / step : 0.0;
    return {line[k - 1].x + (line[k].x - line[k - 1].x) * share, line[k - 1].y + (line[k].y - line[k - 1].y) * share};
}

std::vector<Seat> seats_on(std::vector<Vec2> const& line, double room, double apart) {
    std::vector<double> along(line.size(), 0.0);
    for (std::size_t i = 1; i < line.size(); ++i) {
        along[i] = along[i - 1] + distance(line[i - 1], line[i]);
    }
    std::vector<Seat> seats;
    double const step = std::max(0.25 * room, along.back() / 4000.0);
    for (double where = 0.5 * room; where + 1.5 * room < along.back(); where += step) {
        Seat const seat{point_at(line, along, where), point_at(line, along, where + room)};
        Vec2 const halfway = point_at(line, along, where + 0.5 * room);
        if (distance(seat.from, seat.to) > 0.97 * room && distance(seat.middle(), halfway) < 0.06 * room) {
            seats.push_back(seat);
            where += apart;
        }
    }
    return seats;
}

/// Channels are as wide as the square root of the discharge (Leopold and Maddock 1953), which grows with the area.
constexpr double width_exponent = 0.5;

/// An area, 0 where it is not known.
double known(double area_m2) {
    return std::isfinite(area_m2) && area_m2 > 0.0 ? area_m2 : 0.0;
}

/// share: [0, 1] of the largest.
LineStyle river_style(double share, RiverScale const& scale, double unit) {
    double const widest = std::min(0.9 * (scale.highest_order - 1), 4.2);
    auto const blend = [share](double small, double large) { return small + (large - small) * share; };
    return {std::max(1.0, (1.2 + widest * share) * unit), {blend(0.25, 0.07), blend(0.50, 0.31), blend(0.80, 0.64)}};
}

} // namespace

LineStyle contour_style(ContourKind kind, double unit) {
    return kind == ContourKind::index ? LineStyle{1.25 * unit, {0.47, 0.29, 0.15, 0.75}}
                                      : LineStyle{0.65 * unit, {0.50, 0.33, 0.19, 0.55}};
}

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

LineStyle style_of_area(double area_m2, RiverScale const& scale, double unit) {
    return river_style(std::pow(known(area_m2) / scale.largest_area_m2, width_exponent), scale, unit);
}

LineStyle style_of_order(int order, RiverScale const& scale, double unit) {
    return river_style(static_cast<double>(order - 1) / std::max(1, scale.highest_order - 1), scale, unit);
}

LineStyle ridge_style(double unit) {
    return {std::max(0.8, 1.1 * unit), {0.37, 0.20, 0.08, 0.85}};
}

std::vector<Vec2> in_plan(std::vector<Vec3> const& line) {
    std::vector<Vec2> plan(line.size());
    std::transform(line.begin(), line.end(), plan.begin(), [](Vec3 const& p) { return Vec2{p.x, p.y}; });
    return plan;
}

bool has_ridges(MapSheet const& sheet) {
    return sheet.ridges != nullptr && !sheet.ridges->lines.empty();
}

void draw_contours(Cairo* canvas, MapSheet const& sheet, Window const& window, double interval_m, double unit) {
    for (ContourKind const kind : {ContourKind::ordinary, ContourKind::index}) {
        LineStyle const style = contour_style(kind, unit);
        set_colour(canvas, style.colour);
        cairo_set_line_width(canvas, style.width_px);
        for (auto const& [height_m, line] : sheet.contours) {
            if (kind_of_contour(height_m, interval_m) == kind) {
                trace_line(canvas, on_sheet(line, window), 0.0);
                cairo_stroke(canvas);
            }
        }
    }
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

void draw_rivers(Cairo* canvas, MapSheet const& sheet, Window const& window, double unit) {
    RiverScale const scale = river_scale(sheet);
    if (scale.highest_order == 0) {
        return;
    }
    std::vector<std::pair<double, ArcId>> arcs; // wide ones lie above
    for (ArcId a = 0; a < sheet.network->plan.arc_count(); ++a) {
        arcs.emplace_back(scale.largest_area_m2 > 0.0 ? known(sheet.areas_m2[a]) : sheet.orders->strahler[a], a);
    }
    std::stable_sort(arcs.begin(), arcs.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
    double const corner_px = 0.75 * sheet.dem.grid().cell_m * window.px_per_m;
    cairo_set_line_cap(canvas, CAIRO_LINE_CAP_ROUND);
    for (auto const& [size, a] : arcs) {
        LineStyle const style = scale.largest_area_m2 > 0.0 ? style_of_area(size, scale, unit)
                                                            : style_of_order(static_cast<int>(size), scale, unit);
        trace_line(canvas, on_sheet(sheet.network->plan.arc(a).line, window), corner_px);
        set_colour(canvas, style.colour);
        cairo_set_line_width(canvas, style.width_px);
        cairo_stroke(canvas);
    }
    cairo_set_line_cap(canvas, CAIRO_LINE_CAP_BUTT);
}

void label_contours(Cairo* canvas, MapSheet const& sheet, Window const& window, double interval_m, double unit) {
    LineStyle const line_style = contour_style(ContourKind::index, unit);
    TextStyle const style{11.0 * unit, line_style.colour, Weight::normal, 2.0 * unit};
    int const decimals = interval_m > 0.0 ? decimals_of(round_down(interval_m)) : 0;
    Box const& frame = window.frame;
    std::vector<Vec2> taken;
    for (auto const& [height_m, line] : sheet.contours) {
        if (line.size() < 2 || kind_of_contour(height_m, interval_m) != ContourKind::index) {
            continue;
        }
        std::string const label = number(height_m, decimals);
        double const room = text_width(canvas, label, style) + 6.0 * unit;
        for (Seat seat : seats_on(on_sheet(line, window), room, 500.0 * unit)) {
            Vec2 const at = seat.middle();
            bool const inside = at.x - room > frame.x && at.x + room < frame.right() && at.y - room > frame.y &&
                                at.y + room < frame.bottom();
            bool const free = std::none_of(taken.begin(), taken.end(),
                                           [&](Vec2 other) { return distance(other, at) < 130.0 * unit; });
            if (!inside || !free) {
                continue;
            }
            if (seat.to.x < seat.from.x) {
                std::swap(seat.from, seat.to);
            }
            // The base line lies below the contour, so that the figures sit astride it.
            double const length = distance(seat.from, seat.to);
            double const drop = 0.36 * style.size / length;
            draw_text(canvas, {at.x - (seat.to.y - seat.from.y) * drop, at.y + (seat.to.x - seat.from.x) * drop}, label,
                      style, Anchor::middle, seat.to - seat.from);
            taken.push_back(at);
        }
    }
}

} // namespace thalweg::draw
