// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Deviations named here are those of the estimates over seeds, measured once; tolerances are about four of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/skeleton/internal/normal_row.hpp>
#include <thalweg/skeleton/random_fields.hpp>

#include "fields.hpp"

namespace random_fields_test {

using namespace thalweg;
using skeleton::FieldParams;
using skeleton::grf;
using skeleton::markov3;
using skeleton::separable_ar;

namespace {

using test::on_threads;

bool same(Raster<float> const& a, Raster<float> const& b) {
    return std::equal(a.values().begin(), a.values().end(), b.values().begin(), b.values().end());
}

} // namespace

TEST(RandomFields, RefuseWhatIsOutOfRange) {
    for (auto const make :
         {+[](FieldParams const& p) { return separable_ar(frame(3, 3), p); },
          +[](FieldParams const& p) { return markov3(frame(3, 3), p); },
          +[](FieldParams const& p) {
              return grf(frame(3, 3), {.mean = p.mean, .std = p.std, .covariance = {p.lx_cells, p.ly_cells}}).dem;
          }}) {
        EXPECT_THROW(make({.std = -1.0}), BadParameter);
        EXPECT_THROW(make({.mean = std::nan("")}), BadParameter);
        EXPECT_THROW(make({.lx_cells = 0.0}), BadParameter);
        EXPECT_THROW(make({.ly_cells = 1e300 * 1e300}), BadParameter);
        EXPECT_TRUE(std::isfinite(make({})[0]));
    }
    EXPECT_THROW(grf(frame(3, 3), {.covariance = {.dimension = 3.0}}), BadParameter);
    EXPECT_THROW(grf(frame(3, 3), {.embedding = 0}), BadParameter);
    EXPECT_THROW(grf(frame(100, 100), {.covariance = {1e5, 1e5}}), BadParameter);
    EXPECT_THROW(markov3(frame(3, 3), {.lx_cells = 1e9, .ly_cells = 1e9}), BadParameter);
}

TEST(RandomFields, OfNoCellsAndOfOneRow) {
    EXPECT_EQ(grf(Grid{}).dem.cells(), 0);
    EXPECT_EQ(separable_ar(Grid{}).cells(), 0);
    EXPECT_EQ(markov3(Grid{}).cells(), 0);
    EXPECT_TRUE(std::isfinite(grf(frame(5, 1)).dem[4]));
    EXPECT_TRUE(std::isfinite(grf(frame(1, 5)).dem[4]));
}

TEST(RandomFields, MeanAndDeviationAreAFactorAndATerm) {
    auto const unit = grf(frame(20, 10), {.seed = 4}).dem;
    auto const land = grf(frame(20, 10), {.mean = 536.0, .std = 131.6, .seed = 4}).dem;
    for (std::int64_t i = 0; i < unit.cells(); ++i) {
        ASSERT_NEAR(land[i], 536.0 + 131.6 * unit[i], 1e-4);
    }
    EXPECT_EQ(separable_ar(frame(2, 2), {.mean = 7.0, .std = 0.0})[3], 7.0F);
    EXPECT_EQ(markov3(frame(2, 2), {.mean = 7.0, .std = 0.0})[3], 7.0F);
}

TEST(Grf, HasTheCovarianceAskedFor) {
    for (double const dimension : {2.1, 2.39, 2.5, 2.8}) {
        double variance = 0.0;
        double at_lx = 0.0;
        double at_ly = 0.0;
        constexpr int draws = 8;
        for (std::uint64_t seed = 0; seed < draws; ++seed) {
            auto const field = grf(frame(200, 240), {.covariance = {5.0, 10.0, dimension}, .seed = seed});
            EXPECT_LT(field.negative_share, 1e-6);
            EXPECT_GE(field.torus_width, 800);
            EXPECT_GE(field.torus_height, 960);
            variance += covariance(field.dem, 0, 0) / draws;
            at_lx += covariance(field.dem, 5, 0) / draws;
            at_ly += covariance(field.dem, 0, 10) / draws;
        }
        double const tolerance =
            dimension > 2.7 ? 0.15 : 0.1; // slowly falling correlations leave fewer independent places
        EXPECT_NEAR(variance, 1.0, tolerance) << dimension;
        EXPECT_NEAR(at_lx, std::exp(-1.0), tolerance) << dimension;
        EXPECT_NEAR(at_ly, std::exp(-1.0), tolerance) << dimension;
    }
}

TEST(Grf, SaysWhenTheTorusIsTooSmall) {
    skeleton::GrfParams params{.covariance = {100.0, 100.0, 2.05}, .embedding = 1};
    auto const small = grf(frame(60, 60), params);
    EXPECT_EQ(small.torus_width, 1000); // doubled once from 500
    params.embedding = 4;
    EXPECT_LT(grf(frame(60, 60), params).negative_share, 1e-6);
}

TEST(SeparableAr, IsTheRecursion) {
    Grid const grid = frame(13, 9);
    FieldParams const params{.mean = 3.0, .std = 2.0, .lx_cells = 4.0, .ly_cells = 7.0, .seed = 9};
    auto const field = separable_ar(grid, params);
    double const a = std::exp(-1.0 / 4.0);
    double const b = std::exp(-1.0 / 7.0);
    Raster<double> h(grid);
    for (std::int64_t r = 0; r < grid.height; ++r) {
        std::vector<double> e(static_cast<std::size_t>(grid.width));
        skeleton::normal_row(9, 32, static_cast<std::uint64_t>(r), e);
        for (std::int64_t c = 0; c < grid.width; ++c) {
            double const west = c > 0 ? h[Cell{c - 1, r}] : 0.0;
            double const north = r > 0 ? h[Cell{c, r - 1}] : 0.0;
            double const corner = c > 0 && r > 0 ? h[Cell{c - 1, r - 1}] : 0.0;
            double const fresh = (c > 0 ? 1.0 - a * a : 1.0) * (r > 0 ? 1.0 - b * b : 1.0);
            h[Cell{c, r}] = a * west + b * north - a * b * corner + std::sqrt(fresh) * e[static_cast<std::size_t>(c)];
            ASSERT_NEAR((field[Cell{c, r}]), (3.0 + 2.0 * h[Cell{c, r}]), 1e-6);
        }
    }
}

TEST(SeparableAr, HasExponentialCorrelationFromTheFirstCell) {
    auto const field = separable_ar(frame(1500, 1500), {.lx_cells = 5.0, .ly_cells = 10.0, .seed = 2});
    EXPECT_NEAR(covariance(field, 0, 0), 1.0, 0.05);
    EXPECT_NEAR(covariance(field, 5, 0), std::exp(-1.0), 0.04);
    EXPECT_NEAR(covariance(field, 0, 10), std::exp(-1.0), 0.04);
    EXPECT_NEAR(covariance(field, 5, -10), std::exp(-2.0), 0.03);
    double corner = 0.0;
    for (std::uint64_t seed = 0; seed < 4000; ++seed) {
        float const z = separable_ar(frame(1, 1), {.lx_cells = 50.0, .ly_cells = 50.0, .seed = seed})[0];
        corner += z * z / 4000.0;
    }
    EXPECT_NEAR(corner, 1.0, 0.1);
}

TEST(Markov3, HasTheVarianceAskedForAndTheCorrelationOfTheRecursion) {
    for (auto const& [length, axis, up] : {std::array{5.0, 2.7, 2.0}, std::array{20.0, 5.7, 4.1}}) {
        auto const field = markov3(frame(1600, 1600), {.lx_cells = length, .ly_cells = length, .seed = 1});
        double const variance = covariance(field, 0, 0);
        EXPECT_NEAR(variance, 1.0, 0.02 * std::sqrt(length));
        // Its correlation is geometric along the axes; the lengths are those of the lag-1 correlations.
        auto const cells = [&](std::int64_t dx, std::int64_t dy) {
            return -std::hypot(dx, dy) / std::log(covariance(field, dx, dy) / variance);
        };
        EXPECT_NEAR(cells(1, 0), axis, 0.06 * axis);
        EXPECT_NEAR(cells(0, 1), axis, 0.06 * axis);
        EXPECT_NEAR(cells(3, -3), up, 0.1 * up);
        EXPECT_GT(cells(3, 3), 2.0 * cells(3, -3)); // streaks along one diagonal
    }
}

TEST(RandomFields, TheSeedDecidesAndThreadsDoNot) {
    thalweg::Run const one = on_threads(1);
    thalweg::Run const many = on_threads(5);
    Grid const grid = frame(151, 97);
    FieldParams const params{.seed = 3};
    EXPECT_TRUE(same(separable_ar(grid, params, one), separable_ar(grid, params, many)));
    EXPECT_TRUE(same(markov3(grid, params, one), markov3(grid, params, many)));
    EXPECT_TRUE(same(grf(grid, {.seed = 3}, one).dem, grf(grid, {.seed = 3}, many).dem));
    EXPECT_FALSE(same(grf(grid, {.seed = 4}).dem, grf(grid, {.seed = 3}).dem));
}

} // namespace random_fields_test
