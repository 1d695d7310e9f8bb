// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/estimate_fractal.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>

namespace thalweg::fractal {
namespace {

constexpr int lags = 4;

struct Sum {
    double total = 0.0;
    std::int64_t pairs = 0;
};

/// Differences along rows and along columns, by lag - 1.
struct Sums {
    std::array<Sum, lags> along_rows;
    std::array<Sum, lags> along_cols;
};

void add(Sum& sum, float from, float to, Differences differences) {
    double const step = static_cast<double>(to) - static_cast<double>(from);
    if (!std::isnan(step)) {
        sum.total += differences == Differences::squares ? step * step : std::fabs(step);
        ++sum.pairs;
    }
}

void add(std::array<Sum, lags>& to, std::array<Sum, lags> const& from) {
    for (std::size_t k = 0; k < lags; ++k) {
        to[k].total += from[k].total;
        to[k].pairs += from[k].pairs;
    }
}

/// Sums over pairs whose northern or western cell lies in one row of the window.
Sums sums_of_row(Raster<float> const& dem, CellWindow const& window, std::int64_t row, Differences differences) {
    Sums sums;
    std::int64_t const end_col = window.col + window.width;
    float const* const here = dem.row(row).data();
    for (std::int64_t lag = 1; lag <= lags; ++lag) {
        auto const k = static_cast<std::size_t>(lag - 1);
        for (std::int64_t col = window.col; col + lag < end_col; ++col) {
            add(sums.along_rows[k], here[col], here[col + lag], differences);
        }
        if (row + lag < window.row + window.height) {
            float const* const south = dem.row(row + lag).data();
            for (std::int64_t col = window.col; col < end_col; ++col) {
                add(sums.along_cols[k], here[col], south[col], differences);
            }
        }
    }
    return sums;
}

/// ln of the root mean square difference at one lag; empty: no pairs, or all differences are 0.
std::optional<double> log_difference(Sum const& rows, Sum const& cols, Differences differences) {
    double mean = 0.0;
    double directions = 0.0;
    for (Sum const& sum : {rows, cols}) {
        if (sum.pairs > 0) {
            mean += sum.total / static_cast<double>(sum.pairs);
            directions += 1.0;
        }
    }
    if (!(mean > 0.0)) {
        return {};
    }
    mean /= directions;
    return differences == Differences::squares ? 0.5 * portable::log(mean)
                                               : portable::log(mean * std::sqrt(0.5 * portable::pi));
}

Fractal fit(Sums const& sums, EstimateParams const& params) {
    Fractal fractal;
    std::array<double, lags> x{};
    std::array<double, lags> y{};
    std::size_t n = 0;
    for (std::size_t k = 0; k < lags; ++k) {
        fractal.pairs += sums.along_rows[k].pairs + sums.along_cols[k].pairs;
        if (auto const value = log_difference(sums.along_rows[k], sums.along_cols[k], params.differences)) {
            x[n] = portable::log(static_cast<double>(k + 1));
            y[n++] = *value;
        }
    }
    fractal.lags = static_cast<int>(n);
    fractal.hurst = params.hurst.value_or(0.5);
    if (n == 0) {
        return fractal;
    }
    double mean_x = 0.0;
    double mean_y = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        mean_x += x[k] / static_cast<double>(n);
        mean_y += y[k] / static_cast<double>(n);
    }
    if (n > 1 && !params.hurst) {
        double xy = 0.0;
        double xx = 0.0;
        for (std::size_t k = 0; k < n; ++k) {
            xy += (x[k] - mean_x) * (y[k] - mean_y);
            xx += (x[k] - mean_x) * (x[k] - mean_x);
        }
        fractal.hurst = std::clamp(xy / xx, least_hurst, greatest_hurst);
    }
    fractal.sigma = portable::exp(mean_y - fractal.hurst * mean_x);
    return fractal;
}

void check_hurst(EstimateParams const& params) {
    if (params.hurst) {
        require_in("fractal.estimate_fractal", "H", *params.hurst, Range::between(least_hurst, greatest_hurst));
    }
}

} // namespace

Fractal estimate_fractal(Raster<float> const& dem, EstimateParams const& params, Run const& run) {
    check_hurst(params);
    CellWindow const all{0, 0, dem.width(), dem.height()};
    std::vector<Sums> rows(dem.height());
    parallel_ranges(run, dem.height(), 32, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t row = first; row < last; ++row) {
            run.check();
            for (float const z : dem.row(row)) {
                refuse_if<BadInput>(std::isinf(z), "fractal.estimate_fractal",
                                    "a height in row {} is infinite; make it finite, or NaN where nothing is known",
                                    row);
            }
            rows[row] = sums_of_row(dem, all, row, params.differences);
        }
    });
    Sums sums;
    for (Sums const& row : rows) { // in row order, for any number of threads
        add(sums.along_rows, row.along_rows);
        add(sums.along_cols, row.along_cols);
    }
    return fit(sums, params);
}

Fractal estimate_fractal(Raster<float> const& dem, CellWindow const& window, EstimateParams const& params) {
    check_hurst(params);
    bool const is_inside = window.col >= 0 && window.row >= 0 && window.width >= 0 && window.height >= 0 &&
                           window.col <= dem.width() && window.width <= dem.width() - window.col &&
                           window.row <= dem.height() && window.height <= dem.height() - window.row;
    refuse_if<BadInput>(!is_inside, "fractal.estimate_fractal",
                        "the window of {} x {} cells from column {}, row {} leaves the raster of {} x {}", window.width,
                        window.height, window.col, window.row, dem.width(), dem.height());
    Sums sums;
    for (std::int64_t row = window.row; row < window.row + window.height; ++row) {
        Sums const one = sums_of_row(dem, window, row, params.differences);
        add(sums.along_rows, one.along_rows);
        add(sums.along_cols, one.along_cols);
    }
    return fit(sums, params);
}

} // namespace thalweg::fractal
