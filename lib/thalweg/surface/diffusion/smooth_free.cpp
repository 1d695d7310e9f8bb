// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/internal/smooth_free.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/solver/grid/poisson.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thalweg::surface {
namespace {

/// Weights of the cells 0 .. radius away.
std::vector<double> weights_of(double sigma_cells) {
    std::vector<double> weights;
    for (int x = 0; x <= std::max(1.0, std::floor(3.0 * sigma_cells)); ++x) {
        weights.push_back(portable::exp(-0.5 * (x / sigma_cells) * (x / sigma_cells)));
    }
    return weights;
}

/// Sum along one line of cells: of values and of the weights that count.
struct Sums {
    Raster<double> value;
    Raster<double> weight;
};

/// Calls add(distance, index of the other cell) for the cells of a line of `count` around place `at`.
template <class Add> void around_on_line(std::int64_t at, std::int64_t count, std::int64_t radius, Add const& add) {
    for (std::int64_t other = std::max<std::int64_t>(0, at - radius); other <= std::min(count - 1, at + radius);
         ++other) {
        add(static_cast<std::size_t>(std::abs(other - at)), other);
    }
}

} // namespace

void smooth_free(Raster<std::uint8_t> const& kind, double sigma_cells, Raster<double>& value, Run const& run) {
    auto const weights = weights_of(sigma_cells);
    auto const radius = static_cast<std::int64_t>(weights.size()) - 1;
    std::int64_t const width = kind.width();
    std::int64_t const height = kind.height();
    Sums along{Raster<double>(kind.grid()), Raster<double>(kind.grid())};
    parallel_ranges(run, height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < width; ++col) {
                double sum = 0.0;
                double weight = 0.0;
                around_on_line(col, width, radius, [&](std::size_t distance, std::int64_t other) {
                    if (kind[{other, row}] != solver::outside_cell) {
                        sum += weights[distance] * value[{other, row}];
                        weight += weights[distance];
                    }
                });
                along.value[{col, row}] = sum;
                along.weight[{col, row}] = weight;
            }
        }
    });
    parallel_ranges(run, height, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            for (std::int64_t col = 0; col < width; ++col) {
                if (kind[{col, row}] == solver::free_cell) {
                    double sum = 0.0;
                    double weight = 0.0;
                    around_on_line(row, height, radius, [&](std::size_t distance, std::int64_t other) {
                        sum += weights[distance] * along.value[{col, other}];
                        weight += weights[distance] * along.weight[{col, other}];
                    });
                    value[{col, row}] = sum / weight;
                }
            }
        }
    });
}

} // namespace thalweg::surface
