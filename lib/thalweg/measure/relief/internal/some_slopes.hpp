// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg::measure {

/// Slopes by Horn's formula of some cells of a row; those of a cell without data are NaN.
struct SomeSlopes {
    static constexpr std::size_t at_once = 256;
    std::array<double, at_once> dx; ///< [-] magnitudes
    std::array<double, at_once> dy;
    std::array<double, at_once> tangent;
    std::array<double, at_once> angle; ///< [rad]

    /// Computes count cells from this one of the row; both neighbours of each are on the grid.
    void compute(Raster<float> const& dem, std::int64_t row, std::size_t first, std::size_t count);
};

} // namespace thalweg::measure
