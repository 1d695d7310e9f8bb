// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/statistics/fractal_dimension.hpp>

#include <cmath>
#include <cstddef>
#include <limits>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>

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

/// What the square of each lag weighs in H: the least-squares slope is the sum of weight times ln(square)/2.
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

} // namespace thalweg::solver
