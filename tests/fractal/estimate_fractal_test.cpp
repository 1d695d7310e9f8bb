// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/estimate_fractal.hpp>

#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "land.hpp"

namespace estimate_fractal_test {

namespace {

using namespace thalweg;
using namespace thalweg::fractal;
using test::on_threads;

Raster<float> plane(std::int64_t width, std::int64_t height, float east, float south) {
    return test::raster_of(test::frame_below(width, height), [&](Cell c) {
        return east * static_cast<float>(c.col) + south * static_cast<float>(c.row);
    });
}

TEST(EstimateFractal, FlatOrEmptyLandHasNoSigma) {
    for (Raster<float> const& z :
         {Raster<float>(), plane(1, 1, 1, 1), plane(9, 7, 0, 0), Raster<float>(test::frame_below(5, 5), land::nan)}) {
        Fractal const fractal = estimate_fractal(z);
        EXPECT_EQ(fractal.sigma, 0.0);
        EXPECT_EQ(fractal.hurst, 0.5);
        EXPECT_EQ(fractal.lags, 0);
    }
}

TEST(EstimateFractal, OneLagGivesSigmaOnly) {
    Fractal const fractal = estimate_fractal(plane(2, 1, 3, 0));
    EXPECT_EQ(fractal.lags, 1);
    EXPECT_EQ(fractal.hurst, 0.5);
    EXPECT_NEAR(fractal.sigma, 3.0, 1e-12);
}

// S(k) of a line of slope 1: k^2, so H would be 1; it is clamped and sigma is fitted again.
TEST(EstimateFractal, SlopesAreClamped) {
    Fractal const line = estimate_fractal(plane(40, 1, 1, 0));
    EXPECT_EQ(line.hurst, greatest_hurst);
    EXPECT_NEAR(std::log(line.sigma), 0.05 * (std::log(2.0) + std::log(3.0) + std::log(4.0)) / 4.0, 1e-12);
    EXPECT_EQ(estimate_fractal(plane(1, 40, 0, 1)).sigma, line.sigma);
    Fractal const land = estimate_fractal(plane(40, 30, 3, 4)); // rows 9 k^2, columns 16 k^2: 12.5 k^2
    EXPECT_NEAR(land.sigma, std::sqrt(12.5) * line.sigma, 1e-9);
    EXPECT_EQ(estimate_fractal(land::by_chance(200, 200, 1)).hurst, least_hurst);
}

TEST(EstimateFractal, SigmaIsFittedAtAnHThatIsHeld) {
    Fractal const fractal = estimate_fractal(plane(40, 1, 1, 0), {Differences::squares, 0.5});
    EXPECT_EQ(fractal.hurst, 0.5);
    EXPECT_NEAR(std::log(fractal.sigma), 0.5 * (std::log(2.0) + std::log(3.0) + std::log(4.0)) / 4.0, 1e-12);
}

TEST(EstimateFractal, FindsHAndSigmaOfExactLand) {
    for (double const hurst : {0.3, 0.5, 0.7}) {
        for (Differences const differences : {Differences::squares, Differences::absolute}) {
            double sum = 0.0;
            double log_sigma = 0.0;
            for (std::uint64_t seed = 0; seed < 12; ++seed) {
                Fractal const fractal = estimate_fractal(land::exact_fbm(20, hurst, 7.0, seed), {differences, {}});
                EXPECT_EQ(fractal.lags, 4);
                sum += fractal.hurst / 12.0;
                log_sigma += std::log(fractal.sigma / 7.0) / 12.0;
            }
            EXPECT_NEAR(sum, hurst, 0.04);
            EXPECT_NEAR(log_sigma, 0.0, 0.04);
        }
    }
}

TEST(EstimateFractal, LeavesHolesOut) {
    Raster<float> z = plane(40, 30, 3, 4);
    Fractal const whole = estimate_fractal(z);
    z[{7, 7}] = land::nan;
    z[{0, 0}] = land::nan;
    Fractal const holed = estimate_fractal(z);
    EXPECT_NEAR(holed.sigma, whole.sigma, 1e-9);
    EXPECT_LT(holed.pairs, whole.pairs);
}

TEST(EstimateFractal, AWindowIsTheRasterCutOut) {
    Raster<float> const z = land::by_chance(20, 20, 3, 0.1);
    Raster<float> cut = test::raster_of(test::frame_below(7, 5), [&](Cell c) { return z[Cell{c.col + 4, c.row + 9}]; });
    Fractal const a = estimate_fractal(z, CellWindow{4, 9, 7, 5});
    Fractal const b = estimate_fractal(cut);
    EXPECT_EQ(a.hurst, b.hurst);
    EXPECT_EQ(a.sigma, b.sigma);
    EXPECT_EQ(a.pairs, b.pairs);
}

TEST(EstimateFractal, IsTheSameOnAnyThreads) {
    Raster<float> const z = land::by_chance(211, 173, 4, 0.05);
    thalweg::Run const one = on_threads(1);
    thalweg::Run const two = on_threads(2);
    EXPECT_EQ(estimate_fractal(z, {}, one).sigma, estimate_fractal(z, {}, two).sigma);
}

TEST(EstimateFractal, RefusesWhatItCannotUse) {
    Raster<float> z = plane(5, 5, 1, 1);
    EXPECT_THROW(estimate_fractal(z, {Differences::squares, 1.0}), BadParameter);
    z[7] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(estimate_fractal(z), BadInput);
}

} // namespace

} // namespace estimate_fractal_test
