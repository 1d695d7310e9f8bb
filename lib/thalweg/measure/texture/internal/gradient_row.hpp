// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>

namespace thalweg::measure {

/// The unit gradients of a row of a DEM, by central differences, and `beyond` level cells after it.
struct GradientRow {
    explicit GradientRow(std::int64_t width, std::int64_t beyond = 0)
        : x(static_cast<std::size_t>(width + beyond)), y(x.size()), known(x.size()), slopes(x.size()) {}

    void compute(Raster<float> const& dem, std::int64_t row);

    std::vector<float> x; ///< with y a unit vector uphill; 0: level, or no gradient is known
    std::vector<float> y;
    std::vector<std::uint8_t> known;  ///< 1: a gradient is known
    std::vector<std::uint8_t> slopes; ///< 1: and the cell is not level
};

} // namespace thalweg::measure
