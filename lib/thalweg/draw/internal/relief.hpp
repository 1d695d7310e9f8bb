// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/draw/internal/canvas.hpp>

/// The ground of a map: hillshade under a hypsometric tint. Private to this module.
namespace thalweg::draw {

/// Colour of a height. share: [0, 1] of the way from the lowest to the highest.
Colour tint(double share);

/// Where there are no heights.
inline constexpr Colour no_data{0.90, 0.90, 0.90};

struct Relief {
    std::vector<std::uint32_t> pixels; ///< premultiplied ARGB, row-major from the north-west
    int width = 0;                     ///< [px]
    int height = 0;                    ///< [px]
    double cells_a_pixel = 1.0;        ///< side of a pixel [cells]; the last ones may reach beyond the grid
    double low_m = 0.0;                ///< heights at the ends of the tint; low > high where there are none
    double high_m = 0.0;
    std::int64_t holes = 0; ///< cells without a height
};

/// Takes: heights, and their hillshade [1, 255] (0 = none) on the same grid.
/// Gives: one pixel a cell, or one for the mean colour of every k × k cells, with the largest k that leaves most_wide
/// or more pixels in a row; more where the picture could not be held otherwise (30 000 pixels a side).
Relief tinted_relief(Raster<float> const& dem, Raster<std::uint8_t> const& hillshade, double most_wide);

/// where: the grid's place on the sheet. px_per_cell: its scale.
void draw_relief(Cairo* sheet, Relief const& relief, Box where, double px_per_cell);

} // namespace thalweg::draw
