// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/statistics/field_statistics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>

namespace field_statistics_test {

using namespace thalweg;
using solver::Axis;
using solver::Quantity;

namespace {

using test::on_threads;

constexpr float hole = std::numeric_limits<float>::quiet_NaN();

/// Heights in 64ths of a metre around rolling hills, so that steps of 64ths are exact; some cells are holes.
Raster<float> hills(std::int64_t width, std::int64_t height, std::uint64_t seed, int holes_percent) {
    Raster<float> dem(Grid{width, height, 1.0, 0.0, 0.0, ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        auto const words = random_block(seed, static_cast<std::uint64_t>(i));
        Cell const cell = dem.grid().at(i);
        double const z = 100.0 + 20.0 * std::sin(0.21 * static_cast<double>(cell.col) + static_cast<double>(seed)) +
                         15.0 * std::cos(0.3 * static_cast<double>(cell.row)) + 6.0 * unit(words[0]);
        dem[i] =
            static_cast<int>(words[1] % 100) < holes_percent ? hole : static_cast<float>(std::round(64.0 * z) / 64.0);
    }
    return dem;
}

Cell shifted(Cell cell, Axis axis, std::int64_t by) {
    return axis == Axis::rows ? Cell{cell.col + by, cell.row} : Cell{cell.col, cell.row + by};
}

bool has_height(Raster<float> const& dem, Cell cell) {
    return dem.grid().contains(cell) && !std::isnan(dem[cell]);
}

struct Pairs {
    double products = 0.0;
    double squares = 0.0;
    double count = 0.0;
};

/// Every pair of cells at a lag, one by one.
Pairs pairs_at(Raster<float> const& dem, double datum, Axis axis, std::int64_t lag) {
    Pairs sums;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const here = dem.grid().at(i);
        Cell const there = shifted(here, axis, lag);
        if (has_height(dem, here) && has_height(dem, there)) {
            sums.products += (dem[here] - datum) * (dem[there] - datum);
            sums.squares += std::pow(static_cast<double>(dem[here]) - dem[there], 2);
            sums.count += 1.0;
        }
    }
    return sums;
}

thalweg::Run one_thread() {
    thalweg::Run const run = on_threads(1);
    return run;
}

double value_of(Raster<float> const& dem, Quantity quantity) {
    auto const is = solver::field_statistics(dem, one_thread());
    switch (quantity) {
    case Quantity::mean: return is.mean;
    case Quantity::std: return is.std;
    case Quantity::ln_lx: return std::log(is.lx.cells);
    case Quantity::ln_ly: return std::log(is.ly.cells);
    case Quantity::slope_rad: return is.slope_rad;
    case Quantity::dimension: break;
    }
    return is.dimension;
}

/// Every third cell moved up and down by a 64th of a metre.
void expect_derivatives(Raster<float> const& dem) {
    auto const is = solver::field_statistics(dem);
    constexpr float step = 1.0F / 64.0F;
    for (auto const quantity :
         {Quantity::mean, Quantity::std, Quantity::ln_lx, Quantity::ln_ly, Quantity::slope_rad, Quantity::dimension}) {
        Raster<double> const by = solver::derivative(dem, is, quantity);
        double largest = 0.0;
        for (double const d : by.values()) {
            largest = std::max(largest, std::fabs(d));
        }
        // Where it is all but level the slope bends within a step.
        double const tolerance = (quantity == Quantity::slope_rad ? 3e-3 : 1e-4) * largest;
        for (std::int64_t i = 0; i < dem.cells(); i += 3) {
            if (std::isnan(dem[i])) {
                EXPECT_EQ(by[i], 0.0);
                continue;
            }
            Raster<float> up = dem;
            Raster<float> down = dem;
            up[i] += step;
            down[i] -= step;
            double const finite = (value_of(up, quantity) - value_of(down, quantity)) / (2.0 * step);
            ASSERT_NEAR(by[i], finite, tolerance) << "quantity " << static_cast<int>(quantity) << ", cell " << i;
        }
    }
}

} // namespace

TEST(LagSums, AreThoseOfAllPairs) {
    ASSERT_TRUE(rc::check("of rows and columns, with and without holes", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(1, 40);
        auto const height = *rc::gen::inRange<std::int64_t>(1, 40);
        auto const dem = hills(width, height, *rc::gen::inRange<std::uint64_t>(0, 1000), *rc::gen::element(0, 30, 95));
        for (auto const axis : {Axis::rows, Axis::columns}) {
            std::int64_t const lags = (axis == Axis::rows ? width : height) - 1;
            auto const sums = solver::lag_sums(dem, 90.0, axis, lags);
            for (std::int64_t k = 0; k <= lags; ++k) {
                Pairs const pairs = pairs_at(dem, 90.0, axis, k);
                RC_ASSERT(sums.pairs[static_cast<std::size_t>(k)] == pairs.count);
                RC_ASSERT(std::fabs(sums.products[static_cast<std::size_t>(k)] - pairs.products) < 1e-7);
            }
        }
    }));
}

TEST(WeighLags, ManyWeightsAndFewAreTheSumOfTheDefinition) {
    for (int const holes : {0, 30}) {
        Raster<float> const dem = hills(45, 51, 3, holes);
        for (auto const axis : {Axis::rows, Axis::columns}) {
            for (std::size_t const count : {std::size_t{3}, std::size_t{22}}) {
                std::vector<double> weights(count);
                for (std::size_t k = 0; k < count; ++k) {
                    weights[k] = unit(random_word(4, k)) - 0.3;
                }
                auto const sums = solver::weigh_lags(dem, 95.0, axis, weights);
                for (std::int64_t i = 0; i < dem.cells(); ++i) {
                    Cell const here = dem.grid().at(i);
                    double sum = 0.0;
                    for (std::size_t k = 0; k < count && has_height(dem, here); ++k) {
                        for (auto const by : {-static_cast<std::int64_t>(k) - 1, static_cast<std::int64_t>(k) + 1}) {
                            Cell const there = shifted(here, axis, by);
                            sum += has_height(dem, there) ? weights[k] * (dem[there] - 95.0) : 0.0;
                        }
                    }
                    ASSERT_NEAR(sums[i], sum, 1e-10);
                }
            }
        }
    }
}

TEST(CorrelationLength, OfAPlainAndOfTwoCells) {
    Raster<float> const plain(Grid{9, 7, 1.0, 0.0, 0.0, ""}, 4.0F);
    auto const flat = solver::field_statistics(plain);
    EXPECT_TRUE(std::isnan(flat.lx.cells));
    EXPECT_TRUE(std::isnan(flat.dimension));
    EXPECT_EQ(flat.slope_rad, 0.0);
    Raster<float> two(Grid{2, 1, 1.0, 0.0, 0.0, ""}, 4.0F);
    two[1] = 6.0F;
    auto const is = solver::field_statistics(two);
    EXPECT_EQ(is.along_row.r, (std::vector<double>{-1.0}));
    EXPECT_NEAR(is.lx.cells, (1.0 - std::exp(-1.0)) / 2.0, 1e-15); // from 1 to -1 within a cell
    EXPECT_TRUE(std::isnan(is.ly.cells));
    EXPECT_TRUE(std::isnan(is.dimension));
}

TEST(CorrelationLength, CrossingAndFit) {
    solver::Correlogram c{{0.9, 0.5, 0.2, 0.6}, {1, 1, 1, 1}};
    auto const crossed = solver::correlation_length(c);
    EXPECT_FALSE(crossed.extrapolated);
    EXPECT_NEAR(crossed.cells, 2.0 + (0.5 - std::exp(-1.0)) / 0.3, 1e-14);
    // An exact stable law that does not reach 1/e is carried on.
    c = {{}, {}};
    for (int k = 1; k <= 20; ++k) {
        c.r.push_back(std::exp(-std::pow(k / 39.74, 1.22)));
        c.pairs.push_back(1.0);
    }
    EXPECT_TRUE(solver::correlation_length(c).extrapolated);
    EXPECT_NEAR(solver::correlation_length(c).cells, 39.74, 1e-10);
    // One lag fixes no line; rising correlation has no length.
    EXPECT_TRUE(std::isnan(solver::correlation_length({{0.9}, {1}}).cells));
    EXPECT_TRUE(std::isnan(solver::correlation_length({{0.6, 0.9}, {1, 1}}).cells));
    EXPECT_TRUE(std::isnan(solver::correlation_length({}).cells));
}

TEST(FractalDimension, OfPlanesAndPowers) {
    Raster<float> plane = test::raster_of({20, 10, 1.0, 0.0, 0.0, ""}, [&](Cell c) { return 3 * c.col + c.row; });
    EXPECT_NEAR(solver::fractal_dimension(solver::differences(plane, solver::near_lags)), 2.0, 1e-14);
    std::vector<solver::Difference> power;
    for (std::int64_t const lag : solver::dyadic_lags) {
        power.push_back({lag, std::pow(static_cast<double>(lag), 2 * 0.61), 1.0, 1.0});
    }
    EXPECT_NEAR(solver::fractal_dimension(power), 2.39, 1e-14);
    power[2].square = 0.0;
    EXPECT_TRUE(std::isnan(solver::fractal_dimension(power)));
}

TEST(FractalDimension, DifferencesAreThoseOfAllPairs) {
    for (int const holes : {0, 30}) {
        Raster<float> const dem = hills(25, 4, 8, holes); // no pair of lag 4 or 5 lies in a column
        auto const found = solver::differences(dem, solver::near_lags);
        ASSERT_EQ(found.size(), 5U);
        for (auto const& d : found) {
            Pairs const row = pairs_at(dem, 0.0, Axis::rows, d.lag);
            Pairs const column = pairs_at(dem, 0.0, Axis::columns, d.lag);
            EXPECT_EQ(d.pairs_along_row, row.count);
            EXPECT_EQ(d.pairs_along_column, column.count);
            double const along = row.squares / row.count;
            EXPECT_NEAR(d.square, d.lag < 4 ? (along + column.squares / column.count) / 2.0 : along, 1e-10);
        }
    }
}

TEST(Derivative, IsTheLimitOfFiniteDifferences) {
    auto const crossing = hills(30, 9, 1, 0);
    ASSERT_FALSE(solver::field_statistics(crossing).lx.extrapolated);
    expect_derivatives(crossing);
    auto const fitted = hills(9, 16, 2, 0);
    ASSERT_TRUE(solver::field_statistics(fitted).lx.extrapolated);
    expect_derivatives(fitted);
    expect_derivatives(hills(20, 14, 3, 25)); // one-sided differences beside holes
    expect_derivatives(hills(12, 4, 4, 0));   // lags without pairs
}

TEST(FieldStatistics, SameBitsForAnyNumberOfThreads) {
    Raster<float> const dem = hills(211, 190, 5, 10);
    thalweg::Run run = on_threads(1);
    auto const one = solver::field_statistics(dem, run);
    auto const slope = solver::derivative(dem, one, Quantity::slope_rad, run);
    auto const length = solver::derivative(dem, one, Quantity::ln_ly, run);
    for (int const threads : {2, 5}) {
        run.threads = threads;
        auto const many = solver::field_statistics(dem, run);
        EXPECT_EQ(one.std, many.std);
        EXPECT_EQ(one.along_row.r, many.along_row.r);
        EXPECT_EQ(one.along_column.r, many.along_column.r);
        EXPECT_EQ(one.dimension, many.dimension);
        auto const again = solver::derivative(dem, many, Quantity::slope_rad, run);
        EXPECT_TRUE(std::equal(again.values().begin(), again.values().end(), slope.values().begin()));
        auto const too = solver::derivative(dem, many, Quantity::ln_ly, run);
        EXPECT_TRUE(std::equal(too.values().begin(), too.values().end(), length.values().begin()));
    }
}

} // namespace field_statistics_test
