// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/fractal/midpoint.hpp>

namespace land {

using namespace thalweg;

inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Heights at random between -1 and 1, and holes in a share of the cells.
inline Raster<float> by_chance(std::int64_t width, std::int64_t height, std::uint64_t seed, double holes = 0.0) {
    Raster<float> z(test::frame_below(width, height));
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        auto const place = static_cast<std::uint64_t>(i);
        bool const hole = unit(random_word(seed, 1, place)) < holes;
        z[i] = hole ? nan : static_cast<float>(2.0 * unit(random_word(seed, 2, place)) - 1.0);
    }
    return z;
}

/// A normal number by the sum of the logarithms' way, with libm: tests need no bits.
inline double normal(std::uint64_t seed, std::uint64_t place) {
    auto const words = random_block(seed, 9, place);
    return std::sqrt(-2.0 * std::log(1.0 - unit(words[0]))) * std::cos(2.0 * std::acos(-1.0) * unit(words[1]));
}

/// Fractional Brownian motion on n x n points, 0 in the north-western one, by Cholesky's decomposition.
inline Raster<float> exact_fbm(std::int64_t n, double hurst, double sigma, std::uint64_t seed) {
    Raster<float> z(test::frame_below(n, n));
    auto const points = static_cast<std::size_t>(n * n - 1);
    auto const distance = [&](std::size_t a, std::size_t b) {
        Cell const p = z.grid().at(static_cast<std::int64_t>(a));
        Cell const q = z.grid().at(static_cast<std::int64_t>(b));
        return std::pow(std::hypot(static_cast<double>(p.col - q.col), static_cast<double>(p.row - q.row)),
                        2.0 * hurst);
    };
    std::vector<std::vector<double>> root(points, std::vector<double>(points));
    for (std::size_t i = 0; i < points; ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
            double sum = 0.5 * (distance(i + 1, 0) + distance(k + 1, 0) - distance(i + 1, k + 1));
            for (std::size_t m = 0; m < k; ++m) {
                sum -= root[i][m] * root[k][m];
            }
            root[i][k] = i == k ? std::sqrt(sum) : sum / root[k][k];
        }
        double height = 0.0;
        for (std::size_t k = 0; k <= i; ++k) {
            height += root[i][k] * normal(seed, k);
        }
        z[static_cast<std::int64_t>(i) + 1] = static_cast<float>(sigma * height);
    }
    return z;
}

/// Mean squared difference at a lag, of columns and rows.
inline double differences(Raster<float> const& dem, std::int64_t lag) {
    double sum = 0.0;
    double count = 0.0;
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::int64_t col = 0; col + lag < dem.width(); ++col) {
            auto const east = static_cast<double>(dem[Cell{col + lag, row}]) - static_cast<double>(dem[Cell{col, row}]);
            auto const south =
                static_cast<double>(dem[Cell{row, col + lag}]) - static_cast<double>(dem[Cell{row, col}]);
            sum += east * east + south * south;
            count += 2.0;
        }
    }
    return sum / count;
}

/// Why midpoint displacement refuses heights or parameters; "": it does not.
inline std::string refusal(Raster<float> const& coarse, fractal::MidpointParams const& params) {
    return test::message_of<BadParameter>([&] { fractal::midpoint(coarse, params); });
}

} // namespace land
