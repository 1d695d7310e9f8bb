// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/map_lines.hpp>

/// What stands below a map. Private to this module.
namespace thalweg::draw {

struct LegendFacts {
    double px_per_m = 1.0;
    double ground_px = 0.0;              ///< width of the ground shown
    std::vector<std::string> frame_text; ///< lines under the scale bar
    double low_m = 0.0;                  ///< heights at the ends of the tint; low > high where there are none
    double high_m = 0.0;
    bool holes = false; ///< some cells have no height
    RiverScale rivers;
    double contour_interval_m = 0.0; ///< 0 for none
    bool ridges = false;             ///< some are drawn
};

/// Height [px] that the legend takes in a row of so many pixels: blocks that do not fit go into further rows.
double legend_height(LegendFacts const& facts, double width, double unit);
void draw_legend(Cairo* sheet, LegendFacts const& facts, Vec2 corner, double width, double unit);

} // namespace thalweg::draw
