// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/map.hpp>

#include <algorithm>
#include <cmath>

#include <cairo.h>
#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/draw/internal/axes.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/legend.hpp>
#include <thalweg/draw/internal/map_lines.hpp>
#include <thalweg/draw/internal/relief.hpp>
#include <thalweg/draw/internal/window.hpp>

namespace thalweg::draw {
namespace {

void demand_finite(std::vector<Vec2> const& line, char const* what, std::size_t number_of_line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (!std::isfinite(line[i].x) || !std::isfinite(line[i].y)) {
            throw BadInput(fmt::format("draw.map: {} {}, vertex {} has no finite coordinates; mend the line", what,
                                       number_of_line, i));
        }
    }
}

void demand_sheet(MapSheet const& sheet, MapParams const& params) {
    require_in("draw.map", "width_px", params.width_px, Range::between(200, 8000), "pixels");
    require_in("draw.map", "contour_interval_m", params.contour_interval_m, Range::at_least(0.0));
    Grid const& grid = sheet.dem.grid();
    if (grid.width < 1 || grid.height < 1) {
        throw BadInput(
            fmt::format("draw.map: the DEM has {} x {} cells; draw one that has some", grid.width, grid.height));
    }
    if (!(grid.cell_m > 0.0) || !std::isfinite(grid.east()) || !std::isfinite(grid.south())) {
        throw BadInput(fmt::format("draw.map: the grid's cell of {} m or its origin ({}, {}) is not usable; mend its "
                                   "georeference",
                                   grid.cell_m, grid.west, grid.north));
    }
    if (sheet.hillshade.width() != grid.width || sheet.hillshade.height() != grid.height) {
        throw BadInput(fmt::format("draw.map: the hillshade has {} x {} cells, the DEM {} x {}; shade this DEM",
                                   sheet.hillshade.width(), sheet.hillshade.height(), grid.width, grid.height));
    }
    for (std::size_t i = 0; i < sheet.contours.size(); ++i) {
        demand_finite(sheet.contours[i].second, "contour", i);
    }
    if (has_ridges(sheet)) {
        for (std::size_t i = 0; i < sheet.ridges->lines.size(); ++i) {
            demand_finite(in_plan(sheet.ridges->lines[i].line), "ridge", i + 1);
        }
    }
    if (sheet.network == nullptr) {
        return;
    }
    std::size_t const arcs = sheet.network->plan.arc_count();
    if (sheet.orders == nullptr || sheet.orders->strahler.size() != arcs) {
        throw BadInput(fmt::format("draw.map: a network of {} arcs comes with {} orders; order this network", arcs,
                                   sheet.orders == nullptr ? 0 : sheet.orders->strahler.size()));
    }
    if (!sheet.areas_m2.empty() && sheet.areas_m2.size() != arcs) {
        throw BadInput(
            fmt::format("draw.map: a network of {} arcs comes with {} areas; measure the areas of this network", arcs,
                        sheet.areas_m2.size()));
    }
    for (ArcId a = 0; a < arcs; ++a) {
        demand_finite(sheet.network->plan.arc(a).line, "arc", a + 1);
    }
}

/// "EPSG:…" as it is; of WKT the name.
std::string name_of_crs(std::string const& crs) {
    std::size_t const open = crs.find('"');
    std::size_t const close = open == std::string::npos ? open : crs.find('"', open + 1);
    return close == std::string::npos ? crs : crs.substr(open + 1, close - open - 1);
}

/// How the sheet is laid out [px].
struct Layout {
    double unit = 1.0; ///< what 1 px is on a sheet 1400 px wide
    double band = 0.0; ///< between the map and its outer frame: the coordinates
    Window window;
    Box ground; ///< of the DEM
    double width = 0.0;
    double height = 0.0;
    LegendFacts legend;
    Vec2 legend_corner;
    double legend_width = 0.0;
};

Layout lay_out(MapSheet const& sheet, MapParams const& params) {
    Grid const& grid = sheet.dem.grid();
    Layout out;
    out.width = params.width_px;
    out.unit = std::max(0.6, out.width / 1400.0);
    out.band = 23.0 * out.unit;
    double const margin = 22.0 * out.unit + out.band;
    double const top = (params.title.empty() ? 22.0 : 66.0) * out.unit + out.band;
    double const room = out.width - 2.0 * margin;
    double const ground_wide = static_cast<double>(grid.width) * grid.cell_m;
    double const ground_tall = static_cast<double>(grid.height) * grid.cell_m;
    out.window.px_per_m = std::min(room / ground_wide, 1.4 * room / ground_tall);
    out.ground.width = ground_wide * out.window.px_per_m;
    out.ground.height = ground_tall * out.window.px_per_m;
    // A frame around a single row or column of cells still has to be seen.
    double const least = std::min(60.0 * out.unit, room);
    Box& frame = out.window.frame;
    frame.width = std::max(out.ground.width, least);
    frame.height = std::floor(std::max(out.ground.height, least) + 0.5);
    frame.x = 0.5 * (out.width - frame.width);
    frame.y = top;
    out.ground.x = frame.x + 0.5 * (frame.width - out.ground.width);
    out.ground.y = frame.y + 0.5 * (frame.height - out.ground.height);
    out.window.west = grid.west - (out.ground.x - frame.x) / out.window.px_per_m;
    out.window.north = grid.north + (out.ground.y - frame.y) / out.window.px_per_m;
    out.legend_corner = {22.0 * out.unit, frame.bottom() + out.band + 20.0 * out.unit};
    out.legend_width = out.width - 44.0 * out.unit;
    out.legend.px_per_m = out.window.px_per_m;
    out.legend.ground_px = out.ground.width;
    out.legend.frame_text = {fmt::format("{} × {} cells of {:.6g} m", grid.width, grid.height, grid.cell_m)};
    if (!grid.crs.empty()) {
        out.legend.frame_text.push_back(name_of_crs(grid.crs));
    }
    out.legend.rivers = river_scale(sheet);
    out.legend.contour_interval_m = params.contour_interval_m;
    out.legend.ridges = has_ridges(sheet);
    return out;
}

/// One side's coordinates in the band, and ticks from the inner frame.
struct Side {
    Vec2 from; ///< [px] on the inner frame where the coordinate is low
    Vec2 to;   ///< where it is high
    Vec2 outward;
};

void draw_side(Cairo* canvas, Side const& side, Ticks const& ticks, double low, double high, double unit) {
    TextStyle const style{12.0 * unit, ink};
    bool const upright = side.outward.x != 0.0; // numbers beside the map read upward
    double const length = distance(side.from, side.to);
    for (double const value : ticks.values) {
        double const share = (value - low) / (high - low);
        Vec2 const at{side.from.x + (side.to.x - side.from.x) * share, side.from.y + (side.to.y - side.from.y) * share};
        draw_line(canvas, at, {at.x + side.outward.x * 5.0 * unit, at.y + side.outward.y * 5.0 * unit}, unit, ink);
        std::string const label = number(value, ticks.decimals);
        double const half = 0.5 * text_width(canvas, label, style);
        if (share * length < half || (1.0 - share) * length < half) {
            continue; // it would stand in the corner
        }
        double const middle = 14.0 * unit;
        double const base = 4.3 * unit; // from the middle of a figure to its base line
        Vec2 const place{at.x + side.outward.x * middle + (upright ? base : 0.0),
                         at.y + side.outward.y * middle + (upright ? 0.0 : base)};
        draw_text(canvas, place, label, style, Anchor::middle, upright ? Vec2{0.0, -1.0} : Vec2{1.0, 0.0});
    }
}

void draw_frame(Cairo* canvas, Layout const& layout) {
    Window const& window = layout.window;
    Box const& frame = window.frame;
    double const unit = layout.unit;
    double const low_x = window.west / 1000.0;
    double const high_x = window.east() / 1000.0;
    double const low_y = window.south() / 1000.0;
    double const high_y = window.north / 1000.0;
    auto const most = [&](double pixels) { return std::clamp(static_cast<int>(pixels / (130.0 * unit)), 1, 10); };
    // One step for both ways: the crosses then stand in squares.
    double const step = std::max(ticks_between(low_x, high_x, most(frame.width)).step,
                                 ticks_between(low_y, high_y, most(frame.height)).step);
    auto const by_step = [&](double low, double high, double pixels) {
        Ticks const own = ticks_between(low, high, most(pixels));
        Ticks shared = ticks_between(low, high, std::max(1, static_cast<int>((high - low) / step + 0.5)));
        return shared.values.size() >= 2 && shared.values.size() <= own.values.size() ? shared : own;
    };
    Ticks const x_ticks = by_step(low_x, high_x, frame.width);
    Ticks const y_ticks = by_step(low_y, high_y, frame.height);

    for (double const x : x_ticks.values) {
        for (double const y : y_ticks.values) {
            Vec2 const at = window.at({1000.0 * x, 1000.0 * y});
            double const arm = 5.0 * unit;
            draw_line(canvas, {at.x - arm, at.y}, {at.x + arm, at.y}, 0.8 * unit, {0.1, 0.1, 0.1, 0.55});
            draw_line(canvas, {at.x, at.y - arm}, {at.x, at.y + arm}, 0.8 * unit, {0.1, 0.1, 0.1, 0.55});
        }
    }
    Box const outer{frame.x - layout.band, frame.y - layout.band, frame.width + 2.0 * layout.band,
                    frame.height + 2.0 * layout.band};
    frame_box(canvas, frame, 1.0 * unit, ink);
    frame_box(canvas, outer, 2.0 * unit, ink);
    draw_side(canvas, {{frame.x, frame.bottom()}, {frame.right(), frame.bottom()}, {0.0, 1.0}}, x_ticks, low_x, high_x,
              unit);
    draw_side(canvas, {{frame.x, frame.y}, {frame.right(), frame.y}, {0.0, -1.0}}, x_ticks, low_x, high_x, unit);
    draw_side(canvas, {{frame.x, frame.bottom()}, {frame.x, frame.y}, {-1.0, 0.0}}, y_ticks, low_y, high_y, unit);
    draw_side(canvas, {{frame.right(), frame.bottom()}, {frame.right(), frame.y}, {1.0, 0.0}}, y_ticks, low_y, high_y,
              unit);
    draw_text(canvas, {outer.x + 0.5 * layout.band, frame.bottom() + 0.68 * layout.band}, "km",
              {10.0 * unit, faint_ink}, Anchor::middle);
}

} // namespace

Picture map(MapSheet const& sheet, MapParams const& params) {
    demand_sheet(sheet, params);
    Layout layout = lay_out(sheet, params);
    double const density = params.format == Format::png ? 1.0 : 2.0; // what can be scaled will be
    Relief const relief = tinted_relief(sheet.dem, sheet.hillshade, density * layout.ground.width);
    layout.legend.low_m = relief.low_m;
    layout.legend.high_m = relief.high_m;
    layout.legend.holes = relief.holes > 0;
    double const unit = layout.unit;
    layout.height = std::ceil(layout.legend_corner.y + legend_height(layout.legend, layout.legend_width, unit));

    return paint(layout.width, layout.height, params.format, [&](Cairo* canvas) {
        Box const& frame = layout.window.frame;
        fill_box(canvas, frame, no_data);
        cairo_save(canvas);
        cairo_rectangle(canvas, frame.x, frame.y, frame.width, frame.height);
        cairo_clip(canvas);
        draw_relief(canvas, relief, layout.ground, sheet.dem.grid().cell_m * layout.window.px_per_m);
        draw_contours(canvas, sheet, layout.window, params.contour_interval_m, unit);
        draw_ridges(canvas, sheet, layout.window, unit);
        draw_rivers(canvas, sheet, layout.window, unit);
        label_contours(canvas, sheet, layout.window, params.contour_interval_m, unit);
        cairo_restore(canvas);
        draw_frame(canvas, layout);
        TextStyle const title{26.0 * unit, ink, Weight::bold};
        draw_text_within(canvas, {22.0 * unit, 46.0 * unit}, params.title, title, layout.width - 44.0 * unit);
        draw_legend(canvas, layout.legend, layout.legend_corner, layout.legend_width, unit);
    });
}

} // namespace thalweg::draw
