// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Stencil::exact of midpoint: a fractional Brownian surface through the coarse cells.
#include <thalweg/fractal/midpoint.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "land.hpp"
#include "ordinary_kriging.hpp"

namespace exact_midpoint_test {

namespace {

using namespace thalweg;
using namespace thalweg::fractal;
using test::on_threads;
using test::same_bits;

MidpointParams exactly(int levels, double hurst, double sigma, std::uint64_t seed = 1) {
    MidpointParams params;
    params.levels = levels;
    params.stencil = Stencil::exact;
    params.hurst = hurst;
    params.sigma = sigma;
    params.seed = seed;
    return params;
}

struct Place {
    double x = 0.0; ///< [coarse cells]
    double y = 0.0;
};

double variogram(Place const& a, Place const& b, double hurst) {
    return std::pow((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y), hurst);
}

struct OracleWeights {
    std::vector<double> weights;
    double variance = 0.0; ///< in units of sigma^2
};

OracleWeights oracle_weights(std::vector<Place> const& data, Place const& here, double hurst) {
    std::size_t const n = data.size();
    OracleWeights out;
    out.weights =
        ordinary_kriging(data, here, [hurst](Place const& a, Place const& b) { return variogram(a, b, hurst); });
    for (std::size_t i = 0; i < n; ++i) {
        out.variance += out.weights[i] * variogram(data[i], here, hurst);
        for (std::size_t k = 0; k < n; ++k) {
            out.variance -= 0.5 * out.weights[i] * out.weights[k] * variogram(data[i], data[k], hurst);
        }
    }
    return out;
}

/// The coarse cells with heights.
struct Data {
    std::vector<Place> places;
    std::vector<double> heights;
};

Data data_of(Raster<float> const& coarse) {
    Data data;
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        if (!std::isnan(coarse[i])) {
            Cell const c = coarse.grid().at(i);
            data.places.push_back({static_cast<double>(c.col), static_cast<double>(c.row)});
            data.heights.push_back(static_cast<double>(coarse[i]));
        }
    }
    return data;
}

Place place_of(Raster<float> const& fine, std::int64_t i, int levels) {
    Cell const c = fine.grid().at(i);
    return {std::ldexp(static_cast<double>(c.col), -levels), std::ldexp(static_cast<double>(c.row), -levels)};
}

TEST(ExactMidpoint, TakesDegenerateLand) {
    Raster<float> const point(test::frame_below(1, 1), 7.0F);
    EXPECT_TRUE(std::ranges::equal(midpoint(point, exactly(5, 0.5, 3.0)).dem.values(), point.values()));
    EXPECT_EQ(midpoint(land::by_chance(6, 1, 3), exactly(3, 0.9, 0.1)).dem.width(), 41);
    EXPECT_EQ(midpoint(land::by_chance(1, 6, 3), exactly(3, 0.05, 0.1)).dem.height(), 41);
    Raster<float> const all_holes(test::frame_below(4, 4), land::nan);
    Raster<float> const nothing = midpoint(all_holes, exactly(2, 0.5, 1.0)).dem;
    for (float const z : nothing.values()) {
        EXPECT_TRUE(std::isnan(z));
    }
    Raster<float> const coarse = land::by_chance(4, 4, 3);
    EXPECT_TRUE(same_bits(midpoint(coarse, exactly(0, 0.5, 1.0)).dem, coarse));
    Raster<float> const high(test::frame_below(3, 3), 1e29F);
    Raster<float> const rough = midpoint(high, exactly(2, 0.95, 1e30)).dem;
    for (float const z : rough.values()) {
        EXPECT_TRUE(std::isfinite(z));
    }
}

TEST(ExactMidpoint, LevelLandStaysLevel) {
    Raster<float> coarse(test::frame_below(6, 5), 8848.86F);
    coarse[7] = land::nan;
    MidpointParams params;
    params.levels = 3;
    params.stencil = Stencil::exact; // sigma is estimated: 0
    DisplacedDem const displaced = midpoint(coarse, params);
    EXPECT_EQ(displaced.sigma, 0.0);
    for (float const z : displaced.dem.values()) {
        EXPECT_TRUE(z == 8848.86F || std::isnan(z));
    }
}

TEST(ExactMidpoint, CoarseCellsKeepTheirBitsAndHolesTheirPlaces) {
    ASSERT_TRUE(rc::check("every 2^levels-th cell; NaN where the stencils leave it", [] {
        int const levels = *rc::gen::inRange(1, 5).as("levels");
        double const hurst = *rc::gen::element(0.05, 0.4, 0.75, 0.76, 0.95).as("H");
        Raster<float> coarse = land::by_chance(7, 5, *rc::gen::arbitrary<std::uint64_t>().as("seed"),
                                               *rc::gen::element(0.0, 0.3, 0.9).as("holes"));
        coarse[3] = -0.0F;
        MidpointParams params = exactly(levels, hurst, *rc::gen::element(0.0, 9.0).as("sigma"));
        Raster<float> const dem = midpoint(coarse, params).dem;
        params.stencil = Stencil::sixteen;
        Raster<float> const by_stencil = midpoint(coarse, params).dem;
        Raster<float> picked = test::raster_of(coarse.grid(), [&](Cell c) {
            return dem[Cell{c.col << levels, c.row << levels}];
        });
        RC_ASSERT(same_bits(picked, coarse));
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            RC_ASSERT(std::isnan(dem[i]) == std::isnan(by_stencil[i]));
        }
    }));
}

TEST(ExactMidpoint, ASmallerOneIsPartOfALargerOneBitForBit) {
    ASSERT_TRUE(rc::check("crops", [] {
        Raster<float> const coarse = land::by_chance(6, 9, 5, *rc::gen::element(0.0, 0.2));
        MidpointParams params = exactly(3, *rc::gen::element(0.3, 0.8), 2.0);
        Raster<float> const large = midpoint(coarse, params).dem;
        params.width = *rc::gen::inRange<std::int64_t>(1, large.width() + 1).as("width");
        params.height = *rc::gen::inRange<std::int64_t>(1, large.height() + 1).as("height");
        Raster<float> const small = midpoint(coarse, params).dem;
        for (std::int64_t i = 0; i < small.cells(); ++i) {
            RC_ASSERT(std::bit_cast<std::uint32_t>(small[i]) ==
                      std::bit_cast<std::uint32_t>(large[small.grid().at(i)]));
        }
    }));
}

TEST(ExactMidpoint, IsTheSameOnAnyThreadsAndOtherForAnotherSeed) {
    Raster<float> const coarse = land::by_chance(21, 14, 8, 0.03);
    for (double const hurst : {0.4, 0.9}) {
        Raster<float> const one = midpoint(coarse, exactly(4, hurst, 0.3), on_threads(1)).dem;
        EXPECT_TRUE(same_bits(one, midpoint(coarse, exactly(4, hurst, 0.3), on_threads(2)).dem));
        EXPECT_FALSE(same_bits(one, midpoint(coarse, exactly(4, hurst, 0.3, 2)).dem));
    }
}

TEST(ExactMidpoint, RefusesWhatItCannotUse) {
    Raster<float> coarse(test::frame_below(2001, 1), 1.0F);
    std::string const many = land::refusal(coarse, exactly(1, 0.5, 1.0));
    EXPECT_TRUE(test::has(many, "2001 coarse cells have heights (detail.stencil = \"exact\" takes up to 2000)"));
    coarse[1000] = land::nan; // holes do not count
    EXPECT_EQ(land::refusal(coarse, exactly(1, 0.5, 0.0)), "");
    Raster<float> const few = land::by_chance(4, 3, 1);
    MidpointParams params = exactly(2, 0.5, 1.0);
    params.noise = Noise::uniform;
    EXPECT_TRUE(test::has(land::refusal(few, params), "normal noise"));
    params = exactly(2, 0.5, 1.0);
    params.adaptation = Adaptation::local;
    EXPECT_TRUE(test::has(land::refusal(few, params), "global adaptation"));
    params = exactly(15, 0.5, 1.0);
    params.width = 3; // of a part too the whole is made
    params.height = 3;
    EXPECT_TRUE(test::has(land::refusal(few, params), "more than 2^31 cells"));
    EXPECT_TRUE(test::has(land::refusal(few, exactly(2, 0.99, 1.0)), "H is 0.99"));
}

TEST(ExactMidpoint, WithoutSigmaIsTheKrigedSurface) {
    for (double const hurst : {0.05, 0.5, 0.76, 0.95}) {
        for (double const holes : {0.0, 0.3}) {
            constexpr int levels = 2;
            Raster<float> const coarse = land::by_chance(7, 5, 4, holes);
            Data const data = data_of(coarse);
            Raster<float> const dem = midpoint(coarse, exactly(levels, hurst, 0.0)).dem;
            for (std::int64_t i = 0; i < dem.cells(); ++i) {
                if (std::isnan(dem[i])) {
                    continue;
                }
                OracleWeights const oracle = oracle_weights(data.places, place_of(dem, i, levels), hurst);
                double z = 0.0;
                for (std::size_t k = 0; k < data.heights.size(); ++k) {
                    z += oracle.weights[k] * data.heights[k];
                }
                EXPECT_NEAR(static_cast<double>(dem[i]), z, 1e-6) << hurst << ": " << i;
            }
        }
    }
}

TEST(ExactMidpoint, OverManySeedsHasTheKrigedMeanAndVariance) {
    constexpr int runs = 4000;
    constexpr int levels = 2;
    constexpr double sigma = 3.0;
    Raster<float> coarse = land::by_chance(3, 4, 2);
    coarse[4] = land::nan;
    Data const data = data_of(coarse);
    for (double const hurst : {0.3, 0.85}) {
        std::vector<double> sum(9 * 13, 0.0);
        std::vector<double> squares(9 * 13, 0.0);
        Raster<float> dem;
        for (std::uint64_t seed = 1; seed <= runs; ++seed) {
            dem = midpoint(coarse, exactly(levels, hurst, sigma, seed), on_threads(1)).dem;
            ASSERT_EQ(dem.cells(), 9 * 13);
            for (std::size_t i = 0; i < sum.size(); ++i) {
                auto const z = static_cast<double>(dem[static_cast<std::int64_t>(i)]);
                sum[i] += z / runs;
                squares[i] += z * z / runs;
            }
        }
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (std::isnan(dem[i])) {
                continue;
            }
            OracleWeights const oracle = oracle_weights(data.places, place_of(dem, i, levels), hurst);
            double mean = 0.0;
            for (std::size_t k = 0; k < data.heights.size(); ++k) {
                mean += oracle.weights[k] * data.heights[k];
            }
            double const variance = sigma * sigma * std::max(oracle.variance, 0.0);
            auto const at = static_cast<std::size_t>(i);
            EXPECT_NEAR(sum[at], mean, 5.0 * std::sqrt(variance / runs) + 1e-5) << hurst << ": " << i;
            EXPECT_NEAR(squares[at] - sum[at] * sum[at], variance, 5.0 * variance * std::sqrt(2.0 / runs) + 1e-5)
                << hurst << ": " << i;
        }
    }
}

TEST(ExactMidpoint, SolvesForAsManyCellsAsItTakes) {
    for (auto const& [width, height] : {std::pair{50, 40}, std::pair{1000, 2}}) {
        Raster<float> const coarse = land::by_chance(width, height, 9);
        Raster<float> const dem = midpoint(coarse, exactly(1, 0.95, 0.0)).dem;
        // Next to a coarse cell the surface is smooth: its bits are set, not found, but it is no spike.
        double highest = 0.0;
        for (float const z : dem.values()) {
            highest = std::max(highest, std::fabs(static_cast<double>(z)));
        }
        EXPECT_LT(highest, 2.0) << width;
    }
}

// ---- The statistics of the surface.

class ExactMidpointOfExactLand : public testing::TestWithParam<double> {};

TEST_P(ExactMidpointOfExactLand, HasTheDimension) {
    double const hurst = GetParam();
    constexpr int runs = 8;
    constexpr int levels = 7; // 5 x 5 to 513 x 513
    double dimension = 0.0;
    double first = 0.0;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        double const sigma = std::pow(2.0, levels * hurst); // so that it is 1 between cells of the result
        Raster<float> const coarse = land::exact_fbm(5, hurst, sigma, seed);
        Raster<float> const dem = midpoint(coarse, exactly(levels, hurst, sigma, seed)).dem;
        ASSERT_EQ(dem.width(), 513);
        for (std::int64_t i = 0; i < coarse.cells(); ++i) {
            Cell const c = coarse.grid().at(i);
            ASSERT_EQ((dem[Cell{c.col << levels, c.row << levels}]), coarse[i]);
        }
        std::array<double, 4> y{};
        for (std::size_t k = 0; k < 4; ++k) {
            y[k] = 0.5 * std::log(land::differences(dem, std::int64_t{1} << k));
        }
        // Least squares over 1, 2, 4, 8: weights -3, -1, 1, 3 of equal steps.
        double const slope = (3.0 * (y[3] - y[0]) + (y[2] - y[1])) / (10.0 * std::log(2.0));
        dimension += (3.0 - slope) / runs;
        first += std::exp(2.0 * y[0]) / runs;
    }
    RecordProperty("dimension", std::to_string(dimension));
    std::printf("H %.1f: D %.3f, V(1)/sigma^2 %.3f\n", hurst, dimension, first);
    EXPECT_NEAR(dimension, 3.0 - hurst, 0.05);
    if (hurst <= 0.7) {
        EXPECT_GT(first, 0.9);
        EXPECT_LT(first, 1.1);
    }
}

INSTANTIATE_TEST_SUITE_P(Hurst, ExactMidpointOfExactLand, testing::Values(0.3, 0.5, 0.7, 0.9));

} // namespace

} // namespace exact_midpoint_test
