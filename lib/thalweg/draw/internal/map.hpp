// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/map.hpp>

namespace thalweg::draw {

// The background of a map: hillshade under a hypsometric tint.

/// Heights of a DEM.
struct HeightRange {
    double low_m = 0.0; ///< low > high: none
    double high_m = 0.0;
    std::int64_t holes = 0; ///< cells without a height
};

HeightRange height_range(Raster<float> const& dem);

/// \return the heights of the whole DEM, and the holes of what the sheet shows of it
HeightRange height_range(MapSheet const& sheet);

struct Label; // labels.hpp

struct Relief {
    std::vector<std::uint32_t> pixels; ///< premultiplied ARGB, row-major from the north-west
    int width = 0;                     ///< [px]
    int height = 0;                    ///< [px]
    double cells_a_pixel = 1.0;        ///< side of a pixel [cells]; the last pixels may extend beyond the grid
};

/// where: position of the grid on the sheet. px_per_cell: scale.
void draw_relief(Cairo* sheet, Relief const& relief, Box where, double px_per_cell);

Colour mix(Colour a, Colour b, double share);
std::uint32_t packed(double red, double green, double blue, double alpha);

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

ContourKind kind_of_contour(double height_m, double interval_m);

/// Closed lines; areas between an outer and an inner one are water (even-odd rule).
using Shores = std::vector<std::vector<Vec2>>;

/// Lines of a map in their places [px], without the vertices that nobody sees: those less than 0.2 px from the others'
/// line.
struct LinesOnSheet {
    std::vector<std::vector<Vec2>> rivers;   ///< by arc
    std::vector<std::vector<Vec2>> contours; ///< as the sheet's; empty: the shore
    Shores sea;
    Shores lakes;
};

/// \return rivers and contours of a sheet
LinesOnSheet lines_on_sheet(MapSheet const& sheet, Window const& window);

/// The shores of a mask in their places.
Shores shores_on_sheet(Mask const& water, Window const& window);

/// A small triangle around a place.
void draw_summit(Cairo* sheet, Vec2 at, double half_height);

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

RiverScale river_scale(MapSheet const& sheet);
bool has_ridges(MapSheet const& sheet);
/// \return the grid of the DEM that the sheet shows or has means of
Grid const& whole_grid(MapSheet const& sheet);

/// \param labels in whose rooms contours have gaps
void draw_contours(Cairo* canvas, MapSheet const& sheet, LinesOnSheet const& lines, Window const& window,
                   double interval_m, double unit, std::vector<Label> const& labels);
void draw_ridges(Cairo* canvas, MapSheet const& sheet, Window const& window, double unit);
void draw_rivers(Cairo* canvas, MapSheet const& sheet, LinesOnSheet const& lines, Window const& window, double unit);

// The legend below a map.

struct LegendFacts {
    double px_per_m = 1.0;
    double ground_px = 0.0; ///< width of the map area
    double low_m = 0.0;     ///< heights at the ends of the tint; low > high: none
    double high_m = 0.0;
    bool holes = false; ///< some cells have no height, and are not the sea
    bool sea = false;
    bool lakes = false;
    bool summits = false; ///< some have their heights
    RiverScale rivers;
    double contour_interval_m = 0.0; ///< 0: none
    bool ridges = false;             ///< the map shows ridges
};

/// Height [px] of the legend in rows of this width: blocks that do not fit go into further rows.
double legend_height(LegendFacts const& facts, double width, double unit);
void draw_legend(Cairo* sheet, LegendFacts const& facts, Vec2 corner, double width, double unit);

} // namespace thalweg::draw
