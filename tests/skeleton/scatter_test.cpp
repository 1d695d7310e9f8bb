// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/scatter.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/skeleton/random_fields.hpp>

#include "fields.hpp"

namespace scatter_test {

using namespace thalweg;
using namespace thalweg::skeleton;
using skeleton::attract;
using skeleton::Falloff;
using skeleton::shift_mean;

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

Grid const valley_grid{60, 50, 20.0, 500000.0, 5000000.0, "EPSG:32631"};

/// A river down column 10, and one that runs along row 40 from there.
Valley two_rivers() {
    Valley valley{Raster<float>(valley_grid, std::numeric_limits<float>::quiet_NaN())};
    for (std::int64_t row = 0; row < 50; ++row) {
        valley.z[Cell{10, row}] = 300.0F - 2.0F * static_cast<float>(row);
    }
    for (std::int64_t col = 11; col < 45; ++col) {
        valley.z[Cell{col, 40}] = 220.0F + 5.0F * static_cast<float>(col - 10);
    }
    return valley;
}

/// The river cell nearest to a cell, looked for one after the other, and how far it is.
struct Nearest {
    double cells = std::numeric_limits<double>::infinity();
    double z = 0.0;
};

Nearest nearest_by_search(Valley const& valley, Cell from) {
    Nearest best;
    for (std::int64_t i = 0; i < valley_grid.cells(); ++i) {
        Cell const c = valley_grid.at(i);
        double const away = std::sqrt(
            static_cast<double>((c.col - from.col) * (c.col - from.col) + (c.row - from.row) * (c.row - from.row)));
        if (!std::isnan(valley.z[i]) && away < best.cells) {
            best = {away, static_cast<double>(valley.z[i])};
        }
    }
    return best;
}

/// How far up a point stands between its river and the greatest rise.
double share_of(Valley const& valley, Vec3 const& p, double gain) {
    Nearest const river = nearest_by_search(valley, valley_grid.cell_of({p.x, p.y}));
    return (p.z - river.z) / (gain * river.cells * valley_grid.cell_m);
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
            ScatteredPoints const s = scatter(
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
        ScatteredPoints const s = scatter(ground, {.count = 200, .spacing_cells = spacing});
        EXPECT_EQ(static_cast<std::int64_t>(s.points.points.size()) + s.missing, 200);
        EXPECT_GE(least_distance(s.points.points), spacing * 300.0);
        EXPECT_GT(s.points.points.size(), density < 0.7 ? 175U : 100U) << density;
        EXPECT_TRUE(density < 0.9 || s.missing > 0);
    }
}

TEST(Scatter, HeightsHaveTheAskedMeanAndDeviation) {
    for (HeightLaw const law : {HeightLaw::uniform, HeightLaw::normal}) {
        ScatteredPoints const s = scatter(ground, {.count = 5000, .mean_m = 536.0, .std_m = 131.6, .law = law});
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
    // The reach itself belongs to it.
    auto const away_cells = [&](Vec3 const& p) { return distance({p.x, p.y}, top) / 300.0; };
    auto const last = std::find_if(free.begin() + 1, free.end(), [&](Vec3 const& p) {
        return away_cells(p) * 300.0 == distance({p.x, p.y}, top);
    });
    ASSERT_NE(last, free.end());
    params.falloff = Falloff::literal;
    params.reach_cells = away_cells(*last);
    EXPECT_GT(scatter(ground, params).points.points[static_cast<std::size_t>(last - free.begin())].z, 300.0);
}

TEST(Scatter, ExtremesStandWhereAskedAndNothingPassesThem) {
    Vec3 const highest = at_cell(91, 1, 1038.0);
    Vec3 const lowest = at_cell(129, 26, 276.0);
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        ScatteredPoints const s = scatter(ground, {.seed = seed,
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
    ScatteredPoints const s = scatter({64, 64, 1.0, 0.0, 64.0, ""}, {.count = 16000});
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

TEST(ScatterBetween, RefusesWhatCannotBe) {
    Valley const none{Raster<float>(valley_grid, std::numeric_limits<float>::quiet_NaN())};
    EXPECT_THROW(scatter_between(none, {}), BadInput);
    EXPECT_THROW(scatter_between(two_rivers(), Mask(Grid{3, 3, 20.0, 0.0, 0.0, ""}, 1)), BadInput);
    EXPECT_THROW(scatter_between(two_rivers(), {}, {.count = -1}), BadParameter);
    EXPECT_THROW(scatter_between(two_rivers(), {}, {.spacing_cells = -1.0}), BadParameter);
    EXPECT_THROW(scatter_between(two_rivers(), {}, {.gain = -0.1}), BadParameter);
    EXPECT_THROW(scatter_between(two_rivers(), {}, {.gain = NAN}), BadParameter);
    EXPECT_THROW(scatter_between(two_rivers(), {}, {.count = 4000, .spacing_cells = 3.0}), BadParameter);
}

TEST(ScatterBetween, NothingIsPlacedWhereNothingMayBe) {
    EXPECT_TRUE(scatter_between(two_rivers(), {}, {.count = 0}).points.points.empty());
    ScatteredPoints const s = scatter_between(two_rivers(), Mask(valley_grid, 0), {.count = 5});
    EXPECT_TRUE(s.points.points.empty());
    EXPECT_EQ(s.missing, 5);
}

TEST(ScatterBetween, PointsKeepTheirDistancesAndStandAboveTheNearestRiver) {
    Valley const valley = two_rivers();
    Mask inside = test::raster_of<std::uint8_t>(valley_grid, [&](Cell c) { return c.col < 50 ? 1 : 0; });
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        for (double const spacing : {0.0, 2.5, 4.0}) {
            for (HeightLaw const law : {HeightLaw::uniform, HeightLaw::normal}) {
                ScatteredPoints const s = scatter_between(valley, inside, {seed, 60, spacing, 0.4, 0.0, law});
                EXPECT_EQ(static_cast<std::int64_t>(s.points.points.size()) + s.missing, 60);
                EXPECT_EQ(s.missing, 0);
                EXPECT_EQ(s.points.crs, valley_grid.crs);
                for (std::size_t i = 0; i < s.points.points.size(); ++i) {
                    Vec3 const p = s.points.points[i];
                    Cell const cell = valley_grid.cell_of({p.x, p.y});
                    ASSERT_TRUE(valley_grid.contains(cell));
                    EXPECT_EQ(inside[cell], 1);
                    EXPECT_GE(nearest_by_search(valley, cell).cells, std::max(2.0, spacing));
                    double const share = share_of(valley, p, 0.4);
                    EXPECT_GE(share, -1e-9);
                    EXPECT_LE(share, 1.0 + 1e-9);
                    for (std::size_t j = 0; j < i; ++j) {
                        Vec3 const q = s.points.points[j];
                        EXPECT_GE(distance({p.x, p.y}, {q.x, q.y}), spacing * valley_grid.cell_m);
                    }
                }
            }
        }
    }
}

TEST(ScatterBetween, SharesFollowTheirLaw) {
    for (HeightLaw const law : {HeightLaw::uniform, HeightLaw::normal}) {
        ScatteredPoints const s = scatter_between(two_rivers(), {}, {3, 4000, 0.0, 0.4, 0.0, law});
        double mean = 0.0;
        double square = 0.0;
        for (Vec3 const& p : s.points.points) {
            double const share = share_of(two_rivers(), p, 0.4);
            mean += share / 4000.0;
            square += share * share / 4000.0;
        }
        double const deviation = std::sqrt(square - mean * mean);
        EXPECT_NEAR(mean, 0.5, 0.015);
        EXPECT_NEAR(deviation, law == HeightLaw::uniform ? 1.0 / std::sqrt(12.0) : 1.0 / 6.0, 0.005);
    }
}

TEST(ScatterBetween, WithoutAGainPointsLieAsHighAsTheirRivers) {
    for (Vec3 const& p : scatter_between(two_rivers(), {}, {3, 50, 3.0, 0.0}).points.points) {
        EXPECT_EQ(p.z, nearest_by_search(two_rivers(), valley_grid.cell_of({p.x, p.y})).z);
    }
}

TEST(ScatterBetween, PointsRiseNoMoreBeyondTheFarthestDistance) {
    Valley const valley = two_rivers();
    auto const free = scatter_between(valley, {}, {3, 200, 0.0, 0.4}).points.points;
    auto const bound = scatter_between(valley, {}, {3, 200, 0.0, 0.4, 100.0}).points.points;
    ASSERT_EQ(free.size(), bound.size());
    std::size_t lowered = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
        Nearest const river = nearest_by_search(valley, valley_grid.cell_of({free[i].x, free[i].y}));
        double const away = river.cells * valley_grid.cell_m;
        double const share = (free[i].z - river.z) / (0.4 * away);
        EXPECT_NEAR(bound[i].z, river.z + 0.4 * std::min(away, 100.0) * share, 1e-9);
        lowered += away > 100.0 ? 1 : 0;
    }
    EXPECT_GT(lowered, 50U);
    EXPECT_THROW(scatter_between(valley, {}, {.farthest_m = -1.0}), BadParameter);
}

TEST(ScatterBetween, SaysWhatFoundNoRoom) {
    ScatteredPoints const s = scatter_between(two_rivers(), {}, {3, 400, 2.8});
    EXPECT_GT(s.missing, 0);
    EXPECT_GT(s.points.points.size(), 150U);
    EXPECT_EQ(static_cast<std::int64_t>(s.points.points.size()) + s.missing, 400);
}

TEST(Attract, RefusesACentreOffTheGridAndNoRadius) {
    Raster<float> const dem(frame(5, 4), 10.0F);
    EXPECT_THROW(attract(dem, {{5, 0}, 20.0, 2.0}), BadParameter);
    EXPECT_THROW(attract(dem, {{0, -1}, 20.0, 2.0}), BadParameter);
    EXPECT_THROW(attract(dem, {{0, 0}, 20.0, 0.0}), BadParameter);
    EXPECT_THROW(attract(dem, {{0, 0}, std::nan(""), 1.0}), BadParameter);
}

TEST(Attract, FollowsTheEquation) {
    Raster<float> dem(frame(21, 17), 10.0F);
    dem[Cell{9, 8}] = std::numeric_limits<float>::quiet_NaN();
    for (auto const falloff : {Falloff::continuous, Falloff::literal}) {
        auto const pulled = attract(dem, {{8, 8}, 110.0, 5.0, falloff});
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Cell const cell = dem.grid().at(i);
            double const d = std::hypot(static_cast<double>(cell.col - 8), static_cast<double>(cell.row - 8));
            double const literal = std::exp(-d * d / 25.0);
            double const pull =
                falloff == Falloff::literal ? literal : (literal - std::exp(-1.0)) / (1.0 - std::exp(-1.0));
            if (std::isnan(dem[i])) {
                EXPECT_TRUE(std::isnan(pulled[i]));
            } else {
                EXPECT_NEAR(pulled[i], d <= 5.0 ? 10.0 + pull * 100.0 : 10.0, 1e-5);
            }
        }
        EXPECT_EQ((pulled[Cell{8, 8}]), 110.0F);
        // At the radius itself, (3, 4) away: a step of 100/e as printed, none by default.
        EXPECT_NEAR((pulled[Cell{11, 12}]), falloff == Falloff::literal ? 10.0 + 100.0 * std::exp(-1.0) : 10.0, 1e-5);
    }
}

TEST(ShiftMean, MovesAllHeightsAlike) {
    Raster<float> dem(frame(2, 2), 0.0F);
    dem[1] = 4.0F;
    dem[2] = std::numeric_limits<float>::quiet_NaN();
    dem[3] = 8.0F;
    auto const moved = shift_mean(dem, 100.0);
    EXPECT_EQ(moved[0], 96.0F);
    EXPECT_EQ(moved[1], 100.0F);
    EXPECT_TRUE(std::isnan(moved[2]));
    EXPECT_EQ(moved[3], 104.0F);
    EXPECT_THROW(shift_mean(dem, std::nan("")), BadParameter);
    EXPECT_EQ(shift_mean(Raster<float>{}, 1.0).cells(), 0);
}

} // namespace scatter_test
