// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/map.hpp>

namespace thalweg::draw {

// The background of a map: hillshade under a hypsometric tint.

/// Colour of a height. share: [0, 1] position between the lowest and the highest.
Colour tint(double share);

/// Colour of cells without heights.
inline constexpr Colour no_data{0.90, 0.90, 0.90};

// The lines of a map. unit: [px] the equivalent of 1 px on a sheet 1400 px wide.

struct LineStyle {
    double width_px = 1.0;
    Colour colour;
};

enum class ContourKind : std::uint8_t { ordinary, index };

/// Every fifth contour is an index contour.
inline constexpr int index_every = 5;
LineStyle contour_style(ContourKind kind, double unit);

/// Rivers are wider and deeper blue with contributing area; without areas, with order.
struct RiverScale {
    int highest_order = 0;        ///< 0: the sheet has no rivers
    double largest_area_m2 = 0.0; ///< 0: no area is known
};

LineStyle style_of_area(double area_m2, RiverScale const& scale, double unit);
LineStyle style_of_order(int order, RiverScale const& scale, double unit);

LineStyle ridge_style(double unit);

// The legend below a map.

struct LegendFacts {
    double px_per_m = 1.0;
    double ground_px = 0.0;              ///< width of the map area
    std::vector<std::string> frame_text; ///< lines under the scale bar
    double low_m = 0.0;                  ///< heights at the ends of the tint; low > high: none
    double high_m = 0.0;
    bool holes = false; ///< some cells have no height
    RiverScale rivers;
    double contour_interval_m = 0.0; ///< 0: none
    bool ridges = false;             ///< the map shows ridges
};

/// Height [px] of the legend in rows of this width: blocks that do not fit go into further rows.
double legend_height(LegendFacts const& facts, double width, double unit);
void draw_legend(Cairo* sheet, LegendFacts const& facts, Vec2 corner, double width, double unit);

} // namespace thalweg::draw
