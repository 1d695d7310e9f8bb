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

namespace scatter_between_test {

using namespace thalweg;
using namespace thalweg::skeleton;

namespace {

Grid const ground{60, 50, 20.0, 500000.0, 5000000.0, "EPSG:32631"};

/// A river down column 10, and one that runs along row 40 from there.
Valley two_rivers() {
    Valley valley{Raster<float>(ground, std::numeric_limits<float>::quiet_NaN())};
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
    for (std::int64_t i = 0; i < ground.cells(); ++i) {
        Cell const c = ground.at(i);
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
    Nearest const river = nearest_by_search(valley, ground.cell_of({p.x, p.y}));
    return (p.z - river.z) / (gain * river.cells * ground.cell_m);
}

} // namespace

TEST(ScatterBetween, RefusesWhatCannotBe) {
    Valley const none{Raster<float>(ground, std::numeric_limits<float>::quiet_NaN())};
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
    Scattered const s = scatter_between(two_rivers(), Mask(ground, 0), {.count = 5});
    EXPECT_TRUE(s.points.points.empty());
    EXPECT_EQ(s.missing, 5);
}

TEST(ScatterBetween, PointsKeepTheirDistancesAndStandAboveTheNearestRiver) {
    Valley const valley = two_rivers();
    Mask inside = test::raster_of<std::uint8_t>(ground, [&](Cell c) { return c.col < 50 ? 1 : 0; });
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        for (double const spacing : {0.0, 2.5, 4.0}) {
            for (HeightLaw const law : {HeightLaw::uniform, HeightLaw::normal}) {
                Scattered const s = scatter_between(valley, inside, {seed, 60, spacing, 0.4, 0.0, law});
                EXPECT_EQ(static_cast<std::int64_t>(s.points.points.size()) + s.missing, 60);
                EXPECT_EQ(s.missing, 0);
                EXPECT_EQ(s.points.crs, ground.crs);
                for (std::size_t i = 0; i < s.points.points.size(); ++i) {
                    Vec3 const p = s.points.points[i];
                    Cell const cell = ground.cell_of({p.x, p.y});
                    ASSERT_TRUE(ground.contains(cell));
                    EXPECT_EQ(inside[cell], 1);
                    EXPECT_GE(nearest_by_search(valley, cell).cells, std::max(2.0, spacing));
                    double const share = share_of(valley, p, 0.4);
                    EXPECT_GE(share, -1e-9);
                    EXPECT_LE(share, 1.0 + 1e-9);
                    for (std::size_t j = 0; j < i; ++j) {
                        Vec3 const q = s.points.points[j];
                        EXPECT_GE(distance({p.x, p.y}, {q.x, q.y}), spacing * ground.cell_m);
                    }
                }
            }
        }
    }
}

TEST(ScatterBetween, SharesFollowTheirLaw) {
    for (HeightLaw const law : {HeightLaw::uniform, HeightLaw::normal}) {
        Scattered const s = scatter_between(two_rivers(), {}, {3, 4000, 0.0, 0.4, 0.0, law});
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
        EXPECT_EQ(p.z, nearest_by_search(two_rivers(), ground.cell_of({p.x, p.y})).z);
    }
}

TEST(ScatterBetween, PointsRiseNoMoreBeyondTheFarthestDistance) {
    Valley const valley = two_rivers();
    auto const free = scatter_between(valley, {}, {3, 200, 0.0, 0.4}).points.points;
    auto const bound = scatter_between(valley, {}, {3, 200, 0.0, 0.4, 100.0}).points.points;
    ASSERT_EQ(free.size(), bound.size());
    std::size_t lowered = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
        Nearest const river = nearest_by_search(valley, ground.cell_of({free[i].x, free[i].y}));
        double const away = river.cells * ground.cell_m;
        double const share = (free[i].z - river.z) / (0.4 * away);
        EXPECT_NEAR(bound[i].z, river.z + 0.4 * std::min(away, 100.0) * share, 1e-9);
        lowered += away > 100.0 ? 1 : 0;
    }
    EXPECT_GT(lowered, 50U);
    EXPECT_THROW(scatter_between(valley, {}, {.farthest_m = -1.0}), BadParameter);
}

TEST(ScatterBetween, SaysWhatFoundNoRoom) {
    Scattered const s = scatter_between(two_rivers(), {}, {3, 400, 2.8});
    EXPECT_GT(s.missing, 0);
    EXPECT_GT(s.points.points.size(), 150U);
    EXPECT_EQ(static_cast<std::int64_t>(s.points.points.size()) + s.missing, 400);
}

} // namespace scatter_between_test
