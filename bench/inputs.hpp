// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/fractal/midpoint.hpp>

/// What several benchmarks, instruction counts and other programs' kernels are given.
namespace inputs {

using namespace thalweg;

/// Relief of waves that halve in length and height: valleys of every size, and a rough ground that makes depressions.
inline Raster<float> relief(std::int64_t side) {
    Raster<float> dem(Grid{side, side, 10.0, 0.0, 10.0 * static_cast<double>(side), ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        double z = 0.0;
        std::uint64_t octave = 0;
        for (std::int64_t wave = side / 2; wave > 0; wave /= 2, ++octave) {
            // Value noise: bilinear between the chances of lattice points.
            auto const corner = [&](std::int64_t col, std::int64_t row) {
                return unit(random_word(1, octave, static_cast<std::uint64_t>(col), static_cast<std::uint64_t>(row)));
            };
            std::int64_t const col = c.col / wave;
            std::int64_t const row = c.row / wave;
            double const u = static_cast<double>(c.col % wave) / static_cast<double>(wave);
            double const v = static_cast<double>(c.row % wave) / static_cast<double>(wave);
            z += static_cast<double>(wave) * ((corner(col, row) * (1 - u) + corner(col + 1, row) * u) * (1 - v) +
                                              (corner(col, row + 1) * (1 - u) + corner(col + 1, row + 1) * u) * v);
        }
        dem[i] = static_cast<float>(z);
    }
    return dem;
}

/// Smooth mountains by midpoint displacement of 33 x 33 heights.
/// \param levels the side is 32 cells times 2^levels
inline Raster<float> mountains(int levels) {
    std::int64_t const side = std::int64_t{32} << levels;
    Raster<float> coarse(Grid{33, 33, 10.0 * static_cast<double>(side / 32), 0.0, 0.0, ""});
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        coarse[i] = static_cast<float>(1000.0 * unit(random_word(3, static_cast<std::uint64_t>(i))));
    }
    fractal::MidpointParams params;
    params.levels = levels;
    params.width = params.height = side;
    params.hurst = 0.9;
    return fractal::midpoint(coarse, params).dem;
}

} // namespace inputs
