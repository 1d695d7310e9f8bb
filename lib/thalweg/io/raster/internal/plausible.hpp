// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

/// What is believed of a raster. Private to this module.
namespace thalweg::io {

/// No landscape is so high; a damaged DEFLATE tile reads without an error and gives such numbers.
inline constexpr double implausible_height = 1e30;

/// Whether cells of dx x dy, both above 0, count as squares: their sides are equal but for the rounding of who wrote
/// them, or differ by less than 0.1 %, and over the whole raster by less than a tenth of a cell.
inline bool are_squares(double dx, double dy, int width, int height) {
    double const off = std::fabs(dx - dy);
    bool const is_rounded = off <= 1e-6 * dx;
    return is_rounded || (off <= 1e-3 * dx && off * std::max(width, height) < 0.1 * std::min(dx, dy));
}

} // namespace thalweg::io
