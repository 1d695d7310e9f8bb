// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/statistics/field_statistics.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sums.hpp>

namespace thalweg::solver {
namespace {

struct PairSums {
    double squares_along_row = 0.0;
    double squares_along_column = 0.0;
    std::int64_t pairs_along_row = 0;
    std::int64_t pairs_along_column = 0;
    PairSums& operator+=(PairSums const& other) {
        squares_along_row += other.squares_along_row;
        squares_along_column += other.squares_along_column;
        pairs_along_row += other.pairs_along_row;
        pairs_along_column += other.pairs_along_column;
        return *this;
    }
};

void add(float a, float b, double& squares, std::int64_t& pairs) {
    double const d = static_cast<double>(b) - a;
    if (!std::isnan(d)) {
        squares += d * d;
        ++pairs;
    }
}

/// Weights of the squares in H: the least-squares slope is the sum of weight times ln(square)/2.
std::vector<double> weights(std::vector<Difference> const& differences) {
    std::vector<double> x;
    double mean = 0.0;
    for (Difference const& d : differences) {
        x.push_back(portable::log(static_cast<double>(d.lag)));
        mean += x.back() / static_cast<double>(differences.size());
    }
    double spread = 0.0;
    for (double& value : x) {
        value -= mean;
        spread += value * value;
    }
    for (double& value : x) {
        value /= spread;
    }
    return x;
}

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

/// Sums term(z, column) over the cells of a row that have heights; adds the rows' sums in order.
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

/// Weights of the previous, own and next height in a cell's difference along an axis.
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

using Slopes = std::vector<Gradient>; ///< of a row of cells

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

/// Every cell gathers from itself and its neighbours, so that ranges of rows do not conflict.
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

/// With r_k = sum of products / (pairs std^2), a length depends on the products, on their mean and on std.
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

constexpr double longest_fine_cells = 12.0;
constexpr double most_fine_share = 0.5;

/// Adds a share of fine forms and lengthens the coarse ones, so that the sum is 1/e at the same distances.
StableCovariance shared(StableCovariance const& plain, double fine_share) {
    StableCovariance mixed = plain;
    double const length = std::sqrt(plain.lx_cells * plain.ly_cells);
    double const exponent = 3.0 - plain.dimension;
    mixed.fine_share = fine_share;
    mixed.fine_cells = std::min(longest_fine_cells, length / 4.0);
    double const fine = fine_share * portable::exp(-portable::pow(length / mixed.fine_cells, 2.0 * exponent));
    double const coarse = (portable::exp(-1.0) - fine) / (1.0 - fine_share);
    double const longer = portable::pow(-portable::log(coarse), -0.5 / exponent);
    mixed.lx_cells *= longer;
    mixed.ly_cells *= longer;
    return mixed;
}

} // namespace

std::vector<Difference> differences(Raster<float> const& dem, std::span<std::int64_t const> lags, Run const& run) {
    std::vector<Difference> result;
    for (std::int64_t const lag : lags) {
        PairSums const sums = sum_rows(run, dem.height(), [&](std::int64_t r) {
            run.check();
            PairSums part;
            auto const row = dem.row(r);
            auto const apart = static_cast<std::size_t>(lag);
            for (std::size_t c = apart; c < row.size(); ++c) {
                add(row[c - apart], row[c], part.squares_along_row, part.pairs_along_row);
            }
            if (r >= lag) {
                auto const north = dem.row(r - lag);
                for (std::size_t c = 0; c < row.size(); ++c) {
                    add(north[c], row[c], part.squares_along_column, part.pairs_along_column);
                }
            }
            return part;
        });
        Difference d{lag, 0.0, static_cast<double>(sums.pairs_along_row), static_cast<double>(sums.pairs_along_column)};
        double axes = 0.0;
        if (sums.pairs_along_row > 0) {
            d.square += sums.squares_along_row / d.pairs_along_row;
            axes += 1.0;
        }
        if (sums.pairs_along_column > 0) {
            d.square += sums.squares_along_column / d.pairs_along_column;
            axes += 1.0;
        }
        if (axes > 0.0) {
            d.square /= axes;
            result.push_back(d);
        }
    }
    return result;
}

double fractal_dimension(std::vector<Difference> const& differences) {
    if (differences.size() < 2) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::vector<double> const weight = weights(differences);
    double h = 0.0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
        if (!(differences[i].square > 0.0)) {
            return std::numeric_limits<double>::quiet_NaN();
        }
        h += weight[i] * 0.5 * portable::log(differences[i].square);
    }
    return 3.0 - h;
}

std::vector<double> fractal_dimension_slopes(std::vector<Difference> const& differences) {
    std::vector<double> slopes = weights(differences);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
        slopes[i] *= -0.5 / differences[i].square;
    }
    return slopes;
}

FieldStatistics field_statistics(Raster<float> const& dem, Run const& run) {
    FieldStatistics is;
    auto const values = dem.values();
    is.cells = std::count_if(values.begin(), values.end(), [](float z) { return !std::isnan(z); });
    auto const n = static_cast<double>(is.cells);
    // A height of the DEM as datum avoids losing digits to an offset.
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

double expected_slope(StableCovariance const& covariance, double std) {
    constexpr int angles = 32;
    constexpr int radii = 64;
    // The central difference is half the difference of heights two cells apart.
    double const x = 0.5 * std * std * (1.0 - covariance(2.0, 0.0));
    double const y = 0.5 * std * std * (1.0 - covariance(0.0, 2.0));
    double sum = 0.0;
    for (int i = 0; i < angles; ++i) {
        double const angle = 0.5 * portable::pi * (i + 0.5) / angles;
        double const c = portable::cos(angle);
        double const s = portable::sin(angle);
        double const scale = std::sqrt(x * c * c + y * s * s);
        for (int j = 0; j < radii; ++j) {
            double const radius = std::sqrt(-2.0 * portable::log((j + 0.5) / radii));
            sum += portable::atan2(scale * radius, 1.0);
        }
    }
    return sum / (angles * radii);
}

StableCovariance with_slope(StableCovariance covariance, double std, double slope_rad) {
    if (expected_slope(covariance, std) >= slope_rad) {
        return covariance;
    }
    double too_little = 0.0;
    double enough = most_fine_share;
    for (int halving = 0; halving < 30; ++halving) {
        double const share = 0.5 * (too_little + enough);
        (expected_slope(shared(covariance, share), std) < slope_rad ? too_little : enough) = share;
    }
    return shared(covariance, enough);
}

} // namespace thalweg::solver
