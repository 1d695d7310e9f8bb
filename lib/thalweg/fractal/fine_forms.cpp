// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/fine_forms.hpp>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace thalweg::fractal {

namespace {

constexpr std::int64_t rows_a_range = 16;

/// The window from -reach to reach, its sum 1.
std::vector<double> window(double cells) {
    auto const reach = static_cast<std::int64_t>(std::ceil(3.0 * cells));
    std::vector<double> weights;
    double sum = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        double const x = static_cast<double>(k) / cells;
        weights.push_back(portable::exp(-0.5 * x * x));
        sum += weights.back();
    }
    for (double& weight : weights) {
        weight /= sum;
    }
    return weights;
}

std::int64_t mirrored(std::int64_t i, std::int64_t side) {
    std::int64_t const around = 2 * side;
    i = ((i % around) + around) % around;
    return i < side ? i : around - 1 - i;
}

/// Means of the one less means of the other: as means are linear, one pass serves both.
Raster<double> difference_of_means(Raster<float> const& land, Raster<float> const& fine, double cells, Run const& run) {
    Indexed<std::int64_t, double> const weights = window(cells);
    auto const reach = static_cast<std::int64_t>(weights.size() / 2);
    Raster<double> along(land.grid());
    Raster<double> out(land.grid());
    parallel_ranges(run, land.height(), rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        run.check();
        Indexed<ColumnIndex, double> off(land.width());
        for (std::int64_t r = begin; r < end; ++r) {
            for (std::int64_t c = 0; c < land.width(); ++c) {
                off[c] = static_cast<double>(land[Cell{c, r}]) - static_cast<double>(fine[Cell{c, r}]);
            }
            for (std::int64_t c = 0; c < land.width(); ++c) {
                double mean = 0.0;
                for (std::int64_t k = -reach; k <= reach; ++k) {
                    mean += weights[k + reach] * off[mirrored(c + k, land.width())];
                }
                along[Cell{c, r}] = mean;
            }
        }
    });
    parallel_ranges(run, land.height(), rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        run.check();
        for (std::int64_t r = begin; r < end; ++r) {
            auto const row = out.row(r);
            for (std::int64_t k = -reach; k <= reach; ++k) {
                double const weight = weights[k + reach];
                auto const other = along.row(mirrored(r + k, land.height()));
                for (std::size_t c = 0; c < row.size(); ++c) {
                    row[c] += weight * other[c];
                }
            }
        }
    });
    return out;
}

} // namespace

Raster<float> with_fine_forms(Raster<float> const& land, Raster<float> const& fine, double cells, Run const& run) {
    require_in("fractal.with_fine_forms", "window", cells, {0.0, 1000.0, false, true}, "cells");
    auto const finite = [](float z) { return std::isfinite(z); };
    if (land.grid() != fine.grid() || !std::all_of(land.values().begin(), land.values().end(), finite) ||
        !std::all_of(fine.values().begin(), fine.values().end(), finite)) {
        throw BadInput(
            fmt::format("fractal.with_fine_forms: DEMs of {} x {} and {} x {} cells, or heights that are not "
                        "finite: give two complete DEMs on one grid",
                        land.width(), land.height(), fine.width(), fine.height()));
    }
    Raster<double> const means = difference_of_means(land, fine, cells, run);
    Raster<float> out(land.grid());
    for (std::int64_t i = 0; i < out.cells(); ++i) {
        out[i] = static_cast<float>(means[i] + static_cast<double>(fine[i]));
    }
    return out;
}

} // namespace thalweg::fractal
