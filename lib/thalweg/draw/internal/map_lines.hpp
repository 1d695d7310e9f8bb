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

/// Order [1, highest]: the higher, the wider and the deeper blue.
LineStyle river_style(int order, int highest, double unit);

LineStyle ridge_style(double unit);

/// A line without its heights.
std::vector<Vec2> in_plan(std::vector<Vec3> const& line);

/// Whether the sheet has at least one ridge.
bool has_ridges(MapSheet const& sheet);

/// The highest Strahler order; 0 when the sheet has no rivers.
int highest_order(MapSheet const& sheet);

void draw_contours(Cairo* canvas, MapSheet const& sheet, Window const& window, double interval_m, double unit);
void draw_ridges(Cairo* canvas, MapSheet const& sheet, Window const& window, double unit);
void draw_rivers(Cairo* canvas, MapSheet const& sheet, Window const& window, double unit);
/// Heights on index contours, where these run straight and no other label is near.
void label_contours(Cairo* canvas, MapSheet const& sheet, Window const& window, double interval_m, double unit);

} // namespace thalweg::draw
