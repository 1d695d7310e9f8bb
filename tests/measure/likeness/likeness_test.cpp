// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/likeness/likeness.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>

#include "dems.hpp"

namespace likeness_test {

using namespace thalweg;
using measure::compare_terrains;
using measure::ComparedTerrains;
using measure::Likeness;

namespace {

constexpr std::int64_t side = 64;

/// Two rivers that run south, in the columns 16 and 48.
flow::Reaches two_rivers() {
    flow::Reaches rivers;
    for (double const x : {16.5, 48.5}) {
        rivers.push_back({{{{x, 63.5}, {x, 0.5}}}, -1, static_cast<std::int64_t>(rivers.size() + 1)});
    }
    return rivers;
}

/// Land that rises from the two rivers, with its divide this many columns east of the middle.
Raster<float> valleys(std::int64_t east, double roughness, std::uint64_t seed) {
    Raster<float> dem = rough_dem(frame(side, side), seed);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        double const x = static_cast<double>(c.col);
        double const divide = 32.0 + static_cast<double>(east);
        double const off = x < divide ? std::fabs(x - 16.0) : std::fabs(x - 48.0);
        dem[i] = static_cast<float>(2.0 * off + 0.5 * static_cast<double>(side - c.row) +
                                    roughness * static_cast<double>(dem[i]));
    }
    return dem;
}

double correlation(std::vector<double> const& x, std::vector<double> const& y) {
    double mean_x = 0.0;
    double mean_y = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / static_cast<double>(x.size());
        mean_y += y[i] / static_cast<double>(x.size());
    }
    double xx = 0.0;
    double yy = 0.0;
    double xy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        yy += (y[i] - mean_y) * (y[i] - mean_y);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return xy / std::sqrt(xx * yy);
}

double slope_at(Raster<float> const& z, std::int64_t col, std::int64_t row) {
    auto const at = [&](std::int64_t x, std::int64_t y) { return static_cast<double>(z[Cell{col + x, row + y}]); };
    double const dx = at(1, -1) + 2.0 * at(1, 0) + at(1, 1) - at(-1, -1) - 2.0 * at(-1, 0) - at(-1, 1);
    double const dy = at(-1, 1) + 2.0 * at(0, 1) + at(1, 1) - at(-1, -1) - 2.0 * at(0, -1) - at(1, -1);
    return std::sqrt(dx * dx + dy * dy) / 8.0;
}

/// The largest distance of two empirical distributions, by counting at every value.
double largest_distance(std::vector<double> const& one, std::vector<double> const& other) {
    auto const below = [](std::vector<double> const& values, double most) {
        return static_cast<double>(std::ranges::count_if(values, [&](double v) { return v <= most; })) /
               static_cast<double>(values.size());
    };
    double most = 0.0;
    for (std::vector<double> const* const values : {&one, &other}) {
        for (double const v : *values) {
            most = std::max(most, std::fabs(below(one, v) - below(other, v)));
        }
    }
    return most;
}

/// Marked cells of one mask with one of the other within three cells, by looking at all pairs.
double share_within_three(Mask const& marked, Mask const& others) {
    double all = 0.0;
    double near = 0.0;
    for (std::int64_t i = 0; i < marked.cells(); ++i) {
        if (marked[i] == 0) {
            continue;
        }
        all += 1.0;
        bool found = false;
        for (std::int64_t j = 0; j < others.cells(); ++j) {
            Cell const a = marked.grid().at(i);
            Cell const b = others.grid().at(j);
            found =
                found || (others[j] != 0 && (a.col - b.col) * (a.col - b.col) + (a.row - b.row) * (a.row - b.row) <= 9);
        }
        near += found ? 1.0 : 0.0;
    }
    return near / all;
}

} // namespace

TEST(Likeness, OfATerrainToItself) {
    Raster<float> const dem = valleys(0, 0.3, 1);
    Raster<float> higher = dem;
    for (float& z : higher.values()) {
        z += 128.0F;
    }
    ComparedTerrains const found = compare_terrains(dem, {dem, higher}, two_rivers());
    EXPECT_EQ(found.cells, (side - 16) * (side - 16));
    ASSERT_EQ(found.terrains.size(), 2U);
    ASSERT_EQ(found.divides.size(), 3U);
    for (Likeness const& like : found.terrains) {
        EXPECT_NEAR(like.correlation, 1.0, 1e-6);
        EXPECT_NEAR(like.correlation_above_river, 1.0, 1e-6);
        EXPECT_EQ(like.same_reach, 1.0);
        EXPECT_EQ(like.divides_found, 1.0);
        EXPECT_EQ(like.divides_right, 1.0);
        EXPECT_LT(like.slopes_difference, 0.01); // a higher terrain has coarser floats
    }
    EXPECT_EQ(found.terrains[0].rmse_m, 0.0);
    EXPECT_NEAR(found.terrains[1].bias_m, 128.0, 1e-4);
    EXPECT_NEAR(found.terrains[1].rmse_m, 128.0, 1e-4);
}

TEST(Likeness, OfADivideThatLiesElsewhere) {
    Raster<float> const dem = valleys(0, 0.0, 1);
    Raster<float> const near = valleys(2, 0.0, 1);
    Raster<float> const far = valleys(6, 0.0, 1);
    ComparedTerrains const found = compare_terrains(dem, {near, far}, two_rivers());
    EXPECT_EQ(found.terrains[0].divides_found, 1.0);
    EXPECT_EQ(found.terrains[1].divides_found, 0.0);
    EXPECT_EQ(found.terrains[1].divides_right, 0.0);
    EXPECT_NEAR(found.terrains[1].same_reach, 1.0 - 5.0 / 48.0, 0.01); // five columns of 48 drain to the other river
    EXPECT_GT(found.terrains[0].same_reach, found.terrains[1].same_reach);
}

TEST(Likeness, IsWhatSlowCountingFinds) {
    Raster<float> const dem = valleys(0, 2.0, 1);
    Raster<float> const other = valleys(3, 3.0, 2);
    for (int const threads : {1, 4}) {
        ComparedTerrains const found = compare_terrains(dem, {other}, two_rivers(), test::on_threads(threads));
        std::vector<double> a;
        std::vector<double> b;
        std::vector<double> above_a;
        std::vector<double> above_b;
        std::vector<double> slopes_a;
        std::vector<double> slopes_b;
        for (std::int64_t row = 8; row < side - 8; ++row) {
            for (std::int64_t col = 8; col < side - 8; ++col) {
                Cell const c{col, row};
                a.push_back(static_cast<double>(dem[c]));
                b.push_back(static_cast<double>(other[c]));
                Cell const river{col <= 32 ? 16 : 48, row}; // of two as near the one with the lower index
                if (std::abs(col - river.col) > 3) {
                    above_a.push_back(a.back() - static_cast<double>(dem[river]));
                    above_b.push_back(b.back() - static_cast<double>(other[river]));
                }
                slopes_a.push_back(slope_at(dem, col, row));
                slopes_b.push_back(slope_at(other, col, row));
            }
        }
        Likeness const& like = found.terrains[0];
        EXPECT_NEAR(like.correlation, correlation(a, b), 1e-9);
        EXPECT_NEAR(like.correlation_above_river, correlation(above_a, above_b), 1e-9);
        EXPECT_NEAR(like.slopes_difference, largest_distance(slopes_a, slopes_b), 0.003);
        EXPECT_EQ(like.divides_found, share_within_three(found.divides[0], found.divides[1]));
        EXPECT_EQ(like.divides_right, share_within_three(found.divides[1], found.divides[0]));
    }
}

TEST(Likeness, CellsWithoutDataCountNowhere) {
    Raster<float> dem = valleys(0, 0.5, 1);
    Raster<float> other = valleys(0, 0.5, 2);
    for (std::int64_t row = 20; row < 30; ++row) {
        for (std::int64_t col = 20; col < 30; ++col) {
            dem[Cell{col, row}] = hole;
            other[Cell{col, row}] = 1e6F;
        }
    }
    ComparedTerrains const found = compare_terrains(dem, {other}, two_rivers());
    EXPECT_EQ(found.cells, (side - 16) * (side - 16) - 100);
    EXPECT_GT(found.terrains[0].correlation, 0.9);
    EXPECT_LT(found.terrains[0].rmse_m, 2.0);
}

TEST(Likeness, RefusesWhatCannotBeCompared) {
    Raster<float> const dem = valleys(0, 0.0, 1);
    Raster<float> const small(frame(10, 10));
    EXPECT_THROW(compare_terrains(dem, {small}, two_rivers()), BadInput);
    EXPECT_THROW(compare_terrains(dem, {dem}, {}), BadInput);
    ComparedTerrains const none = compare_terrains(small, {small}, {{{{{2.5, 9.5}, {2.5, 0.5}}}, -1, 1}});
    EXPECT_EQ(none.cells, 0);
    EXPECT_TRUE(std::isnan(none.terrains[0].correlation));
}

} // namespace likeness_test
