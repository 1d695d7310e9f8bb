// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/shift_mean.hpp>

#include <cmath>

#include <thalweg/core/run/range.hpp>

namespace thalweg::skeleton {

Raster<float> shift_mean(Raster<float> dem, double mean) {
    require_in("skeleton.shift_mean", "mean height", mean, Range::finite(), "m");
    double above = 0.0;
    std::int64_t cells = 0;
    for (float const z : dem.values()) {
        if (!std::isnan(z)) {
            above += z - mean;
            ++cells;
        }
    }
    double const shift = cells > 0 ? -above / static_cast<double>(cells) : 0.0;
    for (float& z : dem.values()) {
        z = static_cast<float>(z + shift);
    }
    return dem;
}

} // namespace thalweg::skeleton
