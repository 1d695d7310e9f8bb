// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/scatter.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace scatter_test {

using namespace thalweg;
using namespace thalweg::skeleton;

namespace {

using test::has;
using test::message_of;

Grid const ground{130, 40, 300.0, 500000.0, 5000000.0, ""};

double least_distance(std::vector<Vec3> const& points) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            least = std::min(least, distance({points[i].x, points[i].y}, {points[j].x, points[j].y}));
        }
    }
    return least;
}

Vec3 at_cell(std::int64_t col, std::int64_t row, double z) {
    Vec2 const p = ground.centre({col, row});
    return {p.x, p.y, z};
}

} // namespace

TEST(Scatter, RefusesWhatCannotBe) {
    EXPECT_THROW(scatter(Grid{}, {}), BadParameter);
    EXPECT_THROW(scatter(ground, {.count = 0}), BadParameter);
    EXPECT_THROW(scatter(ground, {.count = 1, .highest = at_cell(1, 1, 9), .lowest = at_cell(2, 2, -9)}), BadParameter);
    EXPECT_THROW(scatter(ground, {.spacing_cells = -1.0}), BadParameter);
    EXPECT_THROW(scatter(ground, {.std_m = NAN}), BadParameter);
    EXPECT_THROW(scatter(ground, {.highest = Vec3{0.0, 0.0, 9.0}}), BadParameter);
    EXPECT_THROW(scatter(ground, {.highest = at_cell(5, 5, 9), .lowest = at_cell(5, 5, -9)}), BadParameter);
    EXPECT_THROW(scatter(ground, {.mean_m = 10.0, .highest = at_cell(5, 5, 9)}), BadParameter);
    EXPECT_TRUE(has(message_of<BadParameter>([&] { scatter(ground, {.count = 4000, .spacing_cells = 2.0}); }),
                    "density of 3.077"));
}

TEST(Scatter, KeepsTheSpacingAndTheCount) {
    for (double const density : {0.0, 0.1, 0.4, 0.6}) {
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            double const spacing = std::sqrt(density * 130.0 * 40.0 / 200.0);
            Scattered const s = scatter(
                ground, {.seed = seed, .count = 200, .spacing_cells = spacing, .mean_m = 500.0, .std_m = 100.0});
            EXPECT_EQ(s.points.points.size(), 200U);
            EXPECT_EQ(s.missing, 0);
            EXPECT_NEAR(s.density, density, 1e-12);
            EXPECT_GE(least_distance(s.points.points), spacing * 300.0);
            for (Vec3 const& p : s.points.points) {
                EXPECT_TRUE(ground.contains(ground.cell_of({p.x, p.y})));
            }
        }
    }
}

TEST(Scatter, AboveWhatDartsCanDoItSaysWhatIsMissing) {
    for (double const density : {0.64, 0.68, 0.9, 1.1}) {
        double const spacing = std::sqrt(density * 130.0 * 40.0 / 200.0);
        Scattered const s = scatter(ground, {.count = 200, .spacing_cells = spacing});
        EXPECT_EQ(static_cast<std::int64_t>(s.points.points.size()) + s.missing, 200);
        EXPECT_GE(least_distance(s.points.points), spacing * 300.0);
        EXPECT_GT(s.points.points.size(), density < 0.7 ? 175U : 100U) << density;
        EXPECT_TRUE(density < 0.9 || s.missing > 0);
    }
}

TEST(Scatter, HeightsHaveTheAskedMeanAndDeviation) {
    for (HeightLaw const law : {HeightLaw::uniform, HeightLaw::normal}) {
        Scattered const s = scatter(ground, {.count = 5000, .mean_m = 536.0, .std_m = 131.6, .law = law});
        double mean = 0.0;
        double square = 0.0;
        double fourth = 0.0;
        for (Vec3 const& p : s.points.points) {
            mean += p.z / 5000.0;
        }
        for (Vec3 const& p : s.points.points) {
            square += std::pow(p.z - mean, 2) / 5000.0;
            fourth += std::pow(p.z - mean, 4) / 5000.0;
        }
        EXPECT_NEAR(mean, 536.0, 1e-9);
        EXPECT_NEAR(std::sqrt(square), 131.6, 1e-9);
        EXPECT_NEAR(fourth / (square * square), law == HeightLaw::uniform ? 1.8 : 3.0,
                    law == HeightLaw::uniform ? 0.05 : 0.3);
    }
}

TEST(Scatter, TheDeviationAsPrinted) {
    ScatterParams params{.count = 5000, .mean_m = 536.0, .std_m = 131.6, .deviation = Deviation::printed};
    auto const deviation = [](std::vector<Vec3> const& points, double mean) {
        double square = 0.0;
        for (Vec3 const& p : points) {
            square += (p.z - mean) * (p.z - mean) / static_cast<double>(points.size());
        }
        return std::sqrt(square);
    };
    auto const uniform = scatter(ground, params).points.points;
    EXPECT_NEAR(deviation(uniform, 536.0), 0.578 * 131.6, 2.0); // 1 / sqrt 3 in the mean
    for (Vec3 const& p : uniform) {
        EXPECT_LE(std::fabs(p.z - 536.0), 131.6);
    }
    params.law = HeightLaw::normal;
    EXPECT_NEAR(deviation(scatter(ground, params).points.points, 536.0), 131.6, 4.0);
}

TEST(Scatter, ThePullEndsAtTheReachWithoutAStepWhereItIsContinuous) {
    ScatterParams params{.count = 3000, .mean_m = 0.0, .std_m = 1.0, .highest = at_cell(60, 20, 1000.0)};
    auto const free = scatter(ground, params).points.points;
    params.reach_cells = 15.0;
    auto const literal = scatter(ground, params).points.points;
    params.falloff = Falloff::continuous;
    auto const continuous = scatter(ground, params).points.points;
    Vec2 const top = ground.centre({60, 20});
    double near_reach = 0.0;
    std::int64_t within = 0;
    for (std::size_t i = 1; i < free.size(); ++i) {
        double const share = distance({free[i].x, free[i].y}, top) / (15.0 * 300.0);
        double const w = std::exp(-share * share);
        double const pull = share <= 1.0 ? (w - std::exp(-1.0)) / (1.0 - std::exp(-1.0)) : 0.0;
        EXPECT_NEAR(continuous[i].z, free[i].z + pull * (1000.0 - free[i].z), 2e-6);
        EXPECT_NEAR(literal[i].z, free[i].z + (share <= 1.0 ? w : 0.0) * (1000.0 - free[i].z), 2e-6);
        near_reach = share > 0.97 && share <= 1.0 ? std::max(near_reach, continuous[i].z) : near_reach;
        within += share <= 1.0 ? 1 : 0;
    }
    EXPECT_GT(within, 200);
    EXPECT_LT(near_reach, 50.0); // 368 m and more as printed
}

TEST(Scatter, ExtremesStandWhereAskedAndNothingPassesThem) {
    Vec3 const highest = at_cell(91, 1, 1038.0);
    Vec3 const lowest = at_cell(129, 26, 276.0);
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        Scattered const s = scatter(ground, {.seed = seed,
                                             .count = 300,
                                             .spacing_cells = 3.0,
                                             .mean_m = 536.0,
                                             .std_m = 300.0,
                                             .highest = highest,
                                             .lowest = lowest,
                                             .reach_cells = 6.0});
        auto const& p = s.points.points;
        EXPECT_EQ(p[0], highest);
        EXPECT_EQ(p[1], lowest);
        for (std::size_t i = 2; i < p.size(); ++i) {
            EXPECT_LT(p[i].z, highest.z);
            EXPECT_GT(p[i].z, lowest.z);
        }
        EXPECT_GE(least_distance(p), 3.0 * 300.0);
    }
}

TEST(Scatter, PlacesAreUniform) {
    // 16 tiles of equal size: chi squared with 15 degrees of freedom stays below 37.7 in 999 of 1000.
    Scattered const s = scatter({64, 64, 1.0, 0.0, 64.0, ""}, {.count = 16000});
    std::array<double, 16> tiles{};
    for (Vec3 const& p : s.points.points) {
        ++tiles[static_cast<std::size_t>(std::floor(p.x / 16.0) + 4.0 * std::floor(p.y / 16.0))];
    }
    double chi = 0.0;
    for (double const n : tiles) {
        chi += (n - 1000.0) * (n - 1000.0) / 1000.0;
    }
    EXPECT_LT(chi, 37.7);
    EXPECT_EQ(scatter(ground, {.seed = 3}).points.points, scatter(ground, {.seed = 3}).points.points);
    EXPECT_NE(scatter(ground, {.seed = 3}).points.points, scatter(ground, {.seed = 4}).points.points);
}

} // namespace scatter_test
