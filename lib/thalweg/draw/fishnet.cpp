// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/fishnet.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::draw {
namespace {

/// The columns and rows that hold heights; all of them where none does.
struct Extent {
    std::int64_t west = 0;
    std::int64_t east = 0;
    std::int64_t north = 0;
    std::int64_t south = 0;
};

Extent extent_of(Raster<float> const& dem) {
    Extent box{dem.width(), -1, dem.height(), -1};
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        for (std::int64_t col = 0; col < dem.width(); ++col) {
            if (std::isfinite(dem[Cell{col, row}])) {
                box = {std::min(box.west, col), std::max(box.east, col), std::min(box.north, row), row};
            }
        }
    }
    return box.east < 0 ? Extent{0, dem.width() - 1, 0, dem.height() - 1} : box;
}

/// Where the lines across one direction lie [cells].
std::vector<double> spread(std::int64_t first, std::int64_t last, double apart) {
    auto const start = static_cast<double>(first);
    if (first == last) {
        return {start - 0.5, start + 0.5};
    }
    double const span = static_cast<double>(last - first);
    auto const meshes = static_cast<std::int64_t>(std::max(1.0, std::floor(span / apart + 0.5)));
    std::vector<double> at(static_cast<std::size_t>(meshes + 1));
    for (std::size_t k = 0; k < at.size(); ++k) {
        at[k] = start + span * static_cast<double>(k) / static_cast<double>(meshes);
    }
    return at;
}

/// Mean of the cells around a place; NaN where fewer than half of them have a height.
double mean_around(Raster<float> const& dem, double col, double row, double reach) {
    auto const clamped = [](double v, std::int64_t cells) {
        return std::clamp(static_cast<std::int64_t>(std::floor(v + 0.5)), std::int64_t{0}, cells - 1);
    };
    std::int64_t const west = clamped(col - reach, dem.width());
    std::int64_t const east = clamped(col + reach, dem.width());
    std::int64_t const north = clamped(row - reach, dem.height());
    std::int64_t const south = clamped(row + reach, dem.height());
    double sum = 0.0;
    std::int64_t known = 0;
    for (std::int64_t r = north; r <= south; ++r) {
        for (std::int64_t c = west; c <= east; ++c) {
            float const z = dem[Cell{c, r}];
            if (std::isfinite(z)) {
                sum += static_cast<double>(z);
                ++known;
            }
        }
    }
    return 2 * known >= (south - north + 1) * (east - west + 1) ? sum / static_cast<double>(known)
                                                                : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

Fishnet fishnet(Raster<float> const& dem, std::int64_t most_lines) {
    Extent const box = extent_of(dem);
    double const longer = static_cast<double>(std::max(box.east - box.west, box.south - box.north));
    double const apart = std::max(1.0, longer / static_cast<double>(most_lines - 1));
    Fishnet net;
    net.col_at = spread(box.west, box.east, apart);
    net.row_at = spread(box.north, box.south, apart);
    net.columns = net.col_at.count();
    net.rows = net.row_at.count();
    net.low_m = std::numeric_limits<double>::infinity();
    net.high_m = -net.low_m;
    // A third of a mesh each way: less, and single cells make the net restless; more, and valleys fill up.
    double const reach = apart > 1.0 ? apart / 3.0 : 0.0;
    for (double const row : net.row_at) {
        for (double const col : net.col_at) {
            double const z = mean_around(dem, col, row, reach);
            net.height_m.push_back(z);
            if (std::isfinite(z)) {
                net.low_m = std::min(net.low_m, z);
                net.high_m = std::max(net.high_m, z);
            }
        }
    }
    return net;
}

} // namespace thalweg::draw
