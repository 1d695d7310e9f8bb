// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/statistics/field_statistics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include <thalweg/core/indexed.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/solver/statistics/central_difference.hpp>

namespace thalweg::solver {

namespace {

constexpr float hole = std::numeric_limits<float>::quiet_NaN();

float height_at(Raster<float> const& dem, std::int64_t col, std::int64_t row) {
    return dem.grid().contains({col, row}) ? dem[Cell{col, row}] : hole;
}

struct Gradient {
    double x = 0.0;
    double y = 0.0;
};

Gradient gradient_at(Raster<float> const& dem, std::int64_t c, std::int64_t r) {
    float const z = dem[Cell{c, r}];
    return {central_difference(height_at(dem, c - 1, r), z, height_at(dem, c + 1, r)),
            central_difference(height_at(dem, c, r - 1), z, height_at(dem, c, r + 1))};
}

/// Sum of term(z, column) over the cells of a row that have heights; all rows' sums in their order.
template <class Term> double sum_cells(Raster<float> const& dem, Run const& run, Term const& term) {
    return sum_rows(run, dem.height(), [&](std::int64_t r) {
        run.check();
        double sum = 0.0;
        for (std::int64_t c = 0; c < dem.width(); ++c) {
            float const z = dem[Cell{c, r}];
            sum += std::isnan(z) ? 0.0 : term(z, Cell{c, r});
        }
        return sum;
    });
}

/// What a cell's own difference along an axis owes to the height before it, to its own and to that after it.
struct Stencil {
    double before;
    double here;
    double after;
};

Stencil stencil(float before, float after) {
    if (std::isnan(before)) {
        return std::isnan(after) ? Stencil{0.0, 0.0, 0.0} : Stencil{0.0, -1.0, 1.0};
    }
    return std::isnan(after) ? Stencil{-1.0, 1.0, 0.0} : Stencil{-0.5, 0.0, 0.5};
}

using Slopes = Indexed<ColumnIndex, Gradient>; ///< of a row of cells

/// Derivatives of one row's arctan |grad z| by the differences along both axes.
Slopes slope_row(Raster<float> const& dem, std::int64_t r) {
    Slopes row(dem.width());
    for (std::int64_t c = 0; c < dem.width() && r >= 0 && r < dem.height(); ++c) {
        if (!std::isnan(dem[Cell{c, r}])) {
            Gradient const g = gradient_at(dem, c, r);
            double const square = g.x * g.x + g.y * g.y;
            double const weight = square > 0.0 ? 1.0 / ((1.0 + square) * std::sqrt(square)) : 0.0;
            row[c] = {weight * g.x, weight * g.y};
        }
    }
    return row;
}

/// Every cell gathers from itself and its neighbours, so that ranges of rows do not meet.
Raster<double> slope_derivative(Raster<float> const& dem, std::int64_t cells, Run const& run) {
    Raster<double> result(dem.grid());
    double const share = 1.0 / static_cast<double>(cells);
    parallel_ranges(run, dem.height(), 32, [&](std::int64_t begin, std::int64_t end) {
        Slopes north = slope_row(dem, begin - 1);
        Slopes here = slope_row(dem, begin);
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            Slopes south = slope_row(dem, r + 1);
            for (std::int64_t c = 0; c < dem.width(); ++c) {
                float const z = dem[Cell{c, r}];
                if (std::isnan(z)) {
                    continue;
                }
                double sum = stencil(height_at(dem, c - 1, r), height_at(dem, c + 1, r)).here * here[c].x +
                             stencil(height_at(dem, c, r - 1), height_at(dem, c, r + 1)).here * here[c].y;
                if (c > 0) {
                    sum += stencil(height_at(dem, c - 2, r), z).after * here[c - 1].x;
                }
                if (c + 1 < dem.width()) {
                    sum += stencil(z, height_at(dem, c + 2, r)).before * here[c + 1].x;
                }
                sum += stencil(height_at(dem, c, r - 2), z).after * north[c].y +
                       stencil(z, height_at(dem, c, r + 2)).before * south[c].y;
                result[Cell{c, r}] = share * sum;
            }
            north = std::move(here);
            here = std::move(south);
        }
    });
    return result;
}

Raster<double> dimension_derivative(Raster<float> const& dem, FieldStatistics const& is, Run const& run) {
    std::vector<double> const slopes = fractal_dimension_slopes(is.differences);
    Raster<double> result(dem.grid());
    parallel_ranges(run, dem.height(), 8, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            run.check();
            for (std::int64_t c = 0; c < dem.width(); ++c) {
                float const z = dem[Cell{c, r}];
                if (std::isnan(z)) {
                    continue;
                }
                auto const above = [&](std::int64_t col, std::int64_t row) {
                    double const other = height_at(dem, col, row);
                    return std::isnan(other) ? 0.0 : z - other;
                };
                double sum = 0.0;
                for (std::size_t i = 0; i < slopes.size(); ++i) {
                    Difference const& d = is.differences[i];
                    double const axes =
                        (d.pairs_along_row > 0.0 ? 1.0 : 0.0) + (d.pairs_along_column > 0.0 ? 1.0 : 0.0);
                    double along = 0.0;
                    if (d.pairs_along_row > 0.0) {
                        along += (above(c - d.lag, r) + above(c + d.lag, r)) / d.pairs_along_row;
                    }
                    if (d.pairs_along_column > 0.0) {
                        along += (above(c, r - d.lag) + above(c, r + d.lag)) / d.pairs_along_column;
                    }
                    sum += slopes[i] * 2.0 / axes * along;
                }
                result[Cell{c, r}] = sum;
            }
        }
    });
    return result;
}

/// With r_k = sum of products / (pairs std^2) a length answers to products, to the mean they count from and to std.
Raster<double> length_derivative(Raster<float> const& dem, FieldStatistics const& is, Axis axis, Run const& run) {
    Correlogram const& correlogram = axis == Axis::rows ? is.along_row : is.along_column;
    std::vector<double> const slopes = correlation_length_slopes(correlogram);
    double const variance = is.std * is.std;
    std::vector<double> weights(slopes.size());
    double by_variance = 0.0;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
        if (slopes[i] != 0.0) {
            weights[i] = slopes[i] / (correlogram.pairs[i] * variance);
            by_variance += slopes[i] * correlogram.r[i];
        }
    }
    Raster<double> result = weigh_lags(dem, is.mean, axis, weights, run);
    auto const n = static_cast<double>(is.cells);
    double const mean = sum_cells(dem, run, [&](float, Cell cell) { return result[cell]; }) / n;
    double const pull = by_variance * 2.0 / (n * variance);
    parallel_ranges(run, dem.cells(), 65536, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            result[i] = std::isnan(dem[i]) ? 0.0 : result[i] - mean - pull * (dem[i] - is.mean);
        }
    });
    return result;
}

} // namespace

FieldStatistics field_statistics(Raster<float> const& dem, Run const& run) {
    FieldStatistics is;
    auto const values = dem.values();
    is.cells = std::count_if(values.begin(), values.end(), [](float z) { return !std::isnan(z); });
    auto const n = static_cast<double>(is.cells);
    // A height of the DEM as datum: no digits go into an offset.
    double const datum = *std::find_if(values.begin(), values.end(), [](float z) { return !std::isnan(z); });
    is.mean = datum + sum_cells(dem, run, [&](float z, Cell) { return z - datum; }) / n;
    is.std = std::sqrt(sum_cells(dem, run, [&](float z, Cell) { return (z - is.mean) * (z - is.mean); }) / n);
    is.slope_rad = sum_cells(dem, run,
                             [&](float, Cell cell) {
                                 Gradient const g = gradient_at(dem, cell.col, cell.row);
                                 return portable::atan2(std::sqrt(g.x * g.x + g.y * g.y), 1.0);
                             }) /
                   n;
    is.along_row = correlogram(dem, is.mean, is.std, Axis::rows, run);
    is.along_column = correlogram(dem, is.mean, is.std, Axis::columns, run);
    is.lx = correlation_length(is.along_row);
    is.ly = correlation_length(is.along_column);
    is.differences = differences(dem, near_lags, run);
    is.dimension = fractal_dimension(is.differences);
    return is;
}

Raster<double> derivative(Raster<float> const& dem, FieldStatistics const& is, Quantity quantity, Run const& run) {
    switch (quantity) {
    case Quantity::ln_lx: return length_derivative(dem, is, Axis::rows, run);
    case Quantity::ln_ly: return length_derivative(dem, is, Axis::columns, run);
    case Quantity::slope_rad: return slope_derivative(dem, is.cells, run);
    case Quantity::dimension: return dimension_derivative(dem, is, run);
    case Quantity::mean:
    case Quantity::std: break;
    }
    Raster<double> result(dem.grid());
    auto const n = static_cast<double>(is.cells);
    parallel_ranges(run, dem.cells(), 65536, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (!std::isnan(dem[i])) {
                result[i] = quantity == Quantity::mean ? 1.0 / n : (dem[i] - is.mean) / (n * is.std);
            }
        }
    });
    return result;
}

} // namespace thalweg::solver
