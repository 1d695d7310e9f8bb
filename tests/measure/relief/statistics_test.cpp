// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/statistics.hpp>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/error.hpp>

#include "dems.hpp"

namespace statistics_test {

using namespace thalweg;
using measure::statistics;
using measure::Statistics;

namespace {

using test::on_threads;

/// Sums over every pair of cells at a distance.
struct Pairs {
    double products = 0.0;
    double squares = 0.0;
    double rises = 0.0;
    double count = 0.0;
};

Pairs pairs_at(Raster<float> const& dem, double mean, std::int64_t dc, std::int64_t dr) {
    Pairs sums;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const here = dem.grid().at(i);
        Cell const there{here.col + dc, here.row + dr};
        if (dem.grid().contains(there) && !std::isnan(dem[here]) && !std::isnan(dem[there])) {
            double const rise = static_cast<double>(dem[there]) - dem[here];
            sums.products += (dem[here] - mean) * (dem[there] - mean);
            sums.squares += rise * rise;
            sums.rises += std::fabs(rise);
            sums.count += 1.0;
        }
    }
    return sums;
}

/// Slope of the least-squares line.
double slope_of(std::vector<double> const& x, std::vector<double> const& y) {
    auto const n = static_cast<double>(x.size());
    double const mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
    double products = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        products += (x[i] - mean_x) * y[i];
        squares += (x[i] - mean_x) * (x[i] - mean_x);
    }
    return products / squares;
}

solver::CorrelationLength length(Raster<float> const& dem, Statistics const& s, std::int64_t dc, std::int64_t dr) {
    std::int64_t const lags = (dc * dem.width() + dr * dem.height()) / 2;
    double before = 1.0;
    std::vector<double> x;
    std::vector<double> u;
    for (std::int64_t k = 1; k <= lags && s.std > 0.0; ++k) {
        Pairs const pairs = pairs_at(dem, s.mean, k * dc, k * dr);
        double const r = pairs.products / pairs.count / (s.std * s.std);
        if (r <= std::exp(-1.0)) {
            return {static_cast<double>(k - 1) + (before - std::exp(-1.0)) / (before - r), false};
        }
        before = r;
        if (r > 0.0 && r < 1.0) {
            x.push_back(std::log(static_cast<double>(k)));
            u.push_back(std::log(-std::log(r)));
        }
    }
    if (x.size() < 2 || slope_of(x, u) <= 0.0) {
        return {};
    }
    auto const n = static_cast<double>(x.size());
    double const mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
    double const mean_u = std::accumulate(u.begin(), u.end(), 0.0) / n;
    return {std::exp(mean_x - mean_u / slope_of(x, u)), true};
}

double dimension(Raster<float> const& dem, std::vector<std::int64_t> const& lags) {
    std::vector<double> x;
    std::vector<double> y;
    for (std::int64_t const lag : lags) {
        double mean = 0.0;
        double axes = 0.0;
        for (auto const& pairs : {pairs_at(dem, 0.0, lag, 0), pairs_at(dem, 0.0, 0, lag)}) {
            if (pairs.count > 0.0) {
                mean += pairs.squares / pairs.count;
                axes += 1.0;
            }
        }
        if (axes > 0.0) {
            x.push_back(std::log(static_cast<double>(lag)));
            y.push_back(0.5 * std::log(mean / axes));
            if (!(mean > 0.0)) {
                return std::nan("");
            }
        }
    }
    return x.size() < 2 ? std::nan("") : 3.0 - slope_of(x, y);
}

/// The same number to a tolerance, or none in both.
bool alike(double a, double b, double tolerance) {
    return std::isnan(a) || std::isnan(b) ? std::isnan(a) == std::isnan(b)
                                          : std::fabs(a - b) <= tolerance * (1.0 + std::fabs(b));
}

/// The definition, in the order of the formula and with libm.
Statistics oracle(Raster<float> const& dem) {
    Statistics s;
    long double sum = 0.0L;
    long double slope = 0.0L;
    long double true_slope = 0.0L;
    auto const height = [&](Cell c) { return dem.grid().contains(c) ? static_cast<double>(dem[c]) : std::nan(""); };
    auto const axis = [&](Cell c, std::int64_t dc, std::int64_t dr) {
        double const before = height({c.col - dc, c.row - dr});
        double const after = height({c.col + dc, c.row + dr});
        bool const has_before = !std::isnan(before);
        bool const has_after = !std::isnan(after);
        if (!has_before && !has_after) {
            return 0.0;
        }
        return ((has_after ? after : height(c)) - (has_before ? before : height(c))) / (has_before + has_after);
    };
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        double const z = height(c);
        if (std::isnan(z)) {
            ++s.nodata;
            continue;
        }
        if (s.cells == 0 || z < s.min.z) {
            s.min = {z, c};
        }
        if (s.cells == 0 || z > s.max.z) {
            s.max = {z, c};
        }
        ++s.cells;
        sum += z;
        double const gradient = std::hypot(axis(c, 1, 0), axis(c, 0, 1));
        slope += std::atan(gradient);
        true_slope += std::atan(gradient / dem.grid().cell_m);
    }
    auto const n = static_cast<long double>(s.cells);
    s.mean = static_cast<double>(sum / n);
    s.slope_rad = static_cast<double>(slope / n);
    s.slope_true_deg = static_cast<double>(true_slope / n * 180.0L / 3.14159265358979323846L);
    long double squares = 0.0L;
    for (float const z : dem.values()) {
        if (!std::isnan(z)) {
            squares += (z - sum / n) * (z - sum / n);
        }
    }
    s.std = static_cast<double>(std::sqrt(squares / n));
    auto const moment = [&](int power) {
        long double moments = 0.0L;
        for (float const z : dem.values()) {
            moments += std::isnan(z) ? 0.0L : std::pow((z - sum / n) / std::sqrt(squares / n), power);
        }
        return static_cast<double>(moments / n);
    };
    s.skew = moment(3);
    s.kurtosis = moment(4) - 3.0;
    s.lx = length(dem, s, 1, 0);
    s.ly = length(dem, s, 0, 1);
    s.dimension = dimension(dem, {1, 2, 3, 4, 5});
    s.dimension_dyadic = dimension(dem, {1, 2, 4, 8, 16, 32});
    double axes = 0.0;
    s.roughness_m = 0.0;
    for (auto const& pairs : {pairs_at(dem, 0.0, 1, 0), pairs_at(dem, 0.0, 0, 1)}) {
        if (pairs.count > 0.0) {
            s.roughness_m += pairs.rises / pairs.count;
            axes += 1.0;
        }
    }
    s.roughness_m /= axes;
    return s;
}

} // namespace

TEST(Statistics, RefusesWhatHasNoHeights) {
    EXPECT_THROW(statistics(Raster<float>{}), BadInput);
    EXPECT_THROW(statistics(Raster<float>(frame(3, 2), hole)), BadInput);
    EXPECT_THROW(statistics(dem_of(2, {1, std::numeric_limits<float>::infinity()})), BadInput);
    Grid no_size = frame(2, 1);
    no_size.cell_m = 0.0;
    EXPECT_THROW(statistics(Raster<float>(no_size, 1.0F)), BadInput);
}

TEST(Statistics, OneCell) {
    Statistics const s = statistics(dem_of(1, {7.25F}));
    EXPECT_EQ(s.cells, 1);
    EXPECT_EQ(s.nodata, 0);
    EXPECT_EQ(s.mean, 7.25);
    EXPECT_EQ(s.std, 0.0);
    EXPECT_EQ(s.slope_rad, 0.0);
    EXPECT_EQ(s.min.z, 7.25);
    EXPECT_EQ(s.max.cell, (Cell{0, 0}));
}

TEST(Statistics, OneRowAndOneColumn) {
    // Differences 1, 1.5, 2: one-sided at both ends.
    double const slope = (std::atan(1.0) + std::atan(1.5) + std::atan(2.0)) / 3.0;
    EXPECT_NEAR(statistics(dem_of(3, {0, 1, 3})).slope_rad, slope, 1e-15);
    EXPECT_NEAR(statistics(dem_of(1, {0, 1, 3})).slope_rad, slope, 1e-15);
}

TEST(Statistics, APlainHasNoDeviation) {
    Statistics const s = statistics(Raster<float>(frame(37, 23), 0.1F));
    EXPECT_EQ(s.mean, static_cast<double>(0.1F));
    EXPECT_EQ(s.std, 0.0);
    EXPECT_EQ(s.slope_rad, 0.0);
    EXPECT_EQ(s.max.cell, (Cell{0, 0}));
}

TEST(Statistics, SmallDeviationOnAGreatHeight) {
    Raster<float> dem(frame(100, 100), 8000.0F);
    for (std::int64_t i = 0; i < dem.cells(); i += 2) {
        dem[i] = 8000.0009765625F; // 2^-10 above
    }
    EXPECT_EQ(statistics(dem).mean, 8000.0 + 0x1p-11);
    EXPECT_EQ(statistics(dem).std, 0x1p-11);
}

TEST(Statistics, HolesAreLeftOutAndMakeDifferencesOneSided) {
    // The cell between two holes has no neighbour along its row and is level there; its column rises by 4.
    Raster<float> const dem = dem_of(3, {hole, 1, hole, //
                                         hole, 5, hole});
    Statistics const s = statistics(dem);
    EXPECT_EQ(s.cells, 2);
    EXPECT_EQ(s.nodata, 4);
    EXPECT_EQ(s.mean, 3.0);
    EXPECT_EQ(s.std, 2.0);
    EXPECT_NEAR(s.slope_rad, std::atan(4.0), 1e-15);
    EXPECT_EQ(s.min.cell, (Cell{1, 0}));
    EXPECT_EQ(s.max.cell, (Cell{1, 1}));
    EXPECT_EQ(statistics(dem_of(3, {1, hole, 2})).slope_rad, 0.0);
}

TEST(Statistics, SlopeInUnitCellsAndInMetres) {
    Grid grid = frame(6, 5);
    grid.cell_m = 30.0;
    Raster<float> dem = test::raster_of(grid, [&](Cell c) {
        return 3 * c.col + 4 * c.row; // |grad| = 5 m a cell everywhere
    });
    EXPECT_NEAR(statistics(dem).slope_rad, std::atan(5.0), 1e-15);
    EXPECT_NEAR(statistics(dem).slope_true_deg, std::atan(5.0 / 30.0) * 180.0 / 3.14159265358979323846, 1e-13);
}

TEST(Statistics, FollowTheDefinition) {
    ASSERT_TRUE(rc::check("statistics are those of the formulas", [] {
        Raster<float> const dem = *gen_dem(12, 50);
        RC_PRE(std::any_of(dem.values().begin(), dem.values().end(), [](float z) { return !std::isnan(z); }));
        Statistics const s = statistics(dem);
        Statistics const o = oracle(dem);
        RC_ASSERT((s.cells == o.cells && s.nodata == o.nodata));
        RC_ASSERT((s.min.z == o.min.z && s.min.cell == o.min.cell));
        RC_ASSERT((s.max.z == o.max.z && s.max.cell == o.max.cell));
        RC_ASSERT(std::fabs(s.mean - o.mean) <= 1e-12);
        RC_ASSERT(std::fabs(s.std - o.std) <= 1e-12);
        RC_ASSERT(std::fabs(s.slope_rad - o.slope_rad) <= 1e-14);
        RC_ASSERT(std::fabs(s.slope_true_deg - o.slope_true_deg) <= 1e-12);
        RC_ASSERT(alike(s.roughness_m, o.roughness_m, 1e-12));
        RC_ASSERT(alike(s.dimension, o.dimension, 1e-9));
        RC_ASSERT(alike(s.dimension_dyadic, o.dimension_dyadic, 1e-9));
        if (o.std > 0.0) {
            RC_ASSERT(alike(s.skew, o.skew, 1e-10));
            RC_ASSERT(alike(s.kurtosis, o.kurtosis, 1e-10));
        }
        // A lag at which r is all but 1/e, 0 or 1 may fall to either side.
        bool const by_fit = s.lx.extrapolated || s.ly.extrapolated || o.lx.extrapolated || o.ly.extrapolated;
        if (!by_fit) {
            RC_ASSERT(alike(s.lx.cells, o.lx.cells, 1e-9));
            RC_ASSERT(alike(s.ly.cells, o.ly.cells, 1e-9));
        }
    }));
}

TEST(Statistics, LengthsFollowTheDefinitionAlsoWhereTheyAreExtrapolated) {
    for (int const holes : {0, 1}) {
        Raster<float> dem(frame(60, 24));
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            auto const c = static_cast<double>(i % 60);
            auto const r = static_cast<double>(i / 60);
            dem[i] = static_cast<float>(500.0 + 100.0 * std::sin(c / 9.0) + 90.0 * std::sin(r / 20.0) +
                                        9.0 * std::sin(c * r));
            if (holes == 1 && (i * 7919) % 11 < 3) {
                dem[i] = hole;
            }
        }
        Statistics const s = statistics(dem);
        Statistics const o = oracle(dem);
        EXPECT_FALSE(s.lx.extrapolated);
        EXPECT_TRUE(s.ly.extrapolated);
        EXPECT_TRUE(o.ly.extrapolated);
        EXPECT_NEAR(s.lx.cells, o.lx.cells, 1e-9);
        EXPECT_NEAR(s.ly.cells, o.ly.cells, 1e-9);
    }
}

TEST(Statistics, WhatAPlainDoesNotTellIsNotANumber) {
    Statistics const s = statistics(Raster<float>(frame(9, 9), 3.0F));
    for (double const figure : {s.skew, s.kurtosis, s.lx.cells, s.ly.cells, s.dimension, s.dimension_dyadic}) {
        EXPECT_TRUE(std::isnan(figure));
    }
    EXPECT_EQ(s.roughness_m, 0.0);
    EXPECT_TRUE(std::isnan(statistics(dem_of(1, {3.0F})).roughness_m));
}

TEST(Statistics, SameBitsForAnyNumberOfThreads) {
    Raster<float> const dem = rough_dem(frame(301, 257), 5);
    thalweg::Run const one = on_threads(1);
    Statistics const a = statistics(dem, one);
    for (int const threads : {2, 5}) {
        thalweg::Run const many = on_threads(threads);
        Statistics const b = statistics(dem, many);
        EXPECT_EQ(a.mean, b.mean);
        EXPECT_EQ(a.std, b.std);
        EXPECT_EQ(a.slope_rad, b.slope_rad);
        EXPECT_EQ(a.slope_true_deg, b.slope_true_deg);
        EXPECT_EQ(a.max.cell, b.max.cell);
        EXPECT_EQ(a.skew, b.skew);
        EXPECT_EQ(a.kurtosis, b.kurtosis);
        EXPECT_EQ(a.roughness_m, b.roughness_m);
        EXPECT_EQ(a.lx.cells, b.lx.cells);
        EXPECT_EQ(a.ly.cells, b.ly.cells);
        EXPECT_EQ(a.dimension, b.dimension);
    }
}

TEST(Statistics, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    EXPECT_THROW(statistics(rough_dem(frame(8, 8), 1), run), Cancelled);
}

TEST(CompensatedSum, KeepsWhatRoundingDrops) {
    CompensatedSum sum;
    for (double const v : {1.0, 1e100, 1.0, -1e100}) {
        sum.add(v);
    }
    EXPECT_EQ(sum.value(), 2.0);
}

} // namespace statistics_test
