// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/internal/heights_of.hpp>

#include <thalweg/solver/grid/poisson.hpp>

#include <limits>

namespace thalweg::surface {

Raster<float> heights_of(Raster<double> const& value, Raster<std::uint8_t> const& kind, Raster<float> const& z) {
    Raster<float> heights(z.grid(), std::numeric_limits<float>::quiet_NaN());
    for (std::int64_t i = 0; i < heights.cells(); ++i) {
        if (kind[i] == solver::fixed_cell) {
            heights[i] = z[i];
        } else if (kind[i] == solver::free_cell) {
            heights[i] = static_cast<float>(value[i]);
        }
    }
    return heights;
}

} // namespace thalweg::surface
