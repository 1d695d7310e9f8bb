// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/io/files/internal/about.hpp>

namespace thalweg::io {

/// Whether cells of dx x dy, both above 0, count as squares: their sides are equal up to rounding in the file, or
/// differ by less than 0.1 %, and over the whole raster by less than a tenth of a cell.
inline bool are_squares(double dx, double dy, int width, int height) {
    double const off = std::fabs(dx - dy);
    bool const is_rounded = off <= 1e-6 * dx;
    return is_rounded || (off <= 1e-3 * dx && off * std::max(width, height) < 0.1 * std::min(dx, dy));
}

/// \throws BadInput when heights of a grid need more than the machine's memory
void require_memory(Grid const& grid, About const& about);

} // namespace thalweg::io
