// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/window.hpp>
#include <thalweg/draw/map.hpp>

/// The lines of a map. Private to this module. unit: [px] what 1 px is on a sheet 1400 px wide.
namespace thalweg::draw {

struct LineStyle {
    double width_px = 1.0;
    Colour colour;
};

enum class ContourKind : std::uint8_t { ordinary, index };

/// Every fifth contour is an index contour.
inline constexpr int index_every = 5;
LineStyle contour_style(ContourKind kind, double unit);

/// Rivers are the wider and the deeper blue, the more land they drain; without areas, the higher their order.
struct RiverScale {
    int highest_order = 0;        ///< 0 when the sheet has no rivers
    double largest_area_m2 = 0.0; ///< 0 when no area is known
};
RiverScale river_scale(MapSheet const& sheet);
LineStyle style_of_area(double area_m2, RiverScale const& scale, double unit);
LineStyle style_of_order(int order, RiverScale const& scale, double unit);

LineStyle ridge_style(double unit);

/// A line without its heights.
std::vector<Vec2> in_plan(std::vector<Vec3> const& line);

/// Whether the sheet has at least one ridge.
bool has_ridges(MapSheet const& sheet);

void draw_contours(Cairo* canvas, MapSheet const& sheet, Window const& window, double interval_m, double unit);
void draw_ridges(Cairo* canvas, MapSheet const& sheet, Window const& window, double unit);
void draw_rivers(Cairo* canvas, MapSheet const& sheet, Window const& window, double unit);
/// Heights on index contours, where these run straight and no other label is near.
void label_contours(Cairo* canvas, MapSheet const& sheet, Window const& window, double interval_m, double unit);

} // namespace thalweg::draw
