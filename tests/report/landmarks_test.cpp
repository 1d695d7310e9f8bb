// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/landmarks.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

namespace thalweg::report {
namespace {

/// Cones of given heights on a plain.
Raster<float> cones(std::vector<std::pair<Cell, double>> const& tops, std::int64_t width = 160,
                    std::int64_t height = 80) {
    Raster<float> dem(Grid{width, height, 10.0, 1000.0, 2000.0, ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const here = dem.grid().at(i);
        for (auto const& [top, top_m] : tops) {
            double const away =
                std::hypot(static_cast<double>(here.col - top.col), static_cast<double>(here.row - top.row));
            dem[i] = std::max(dem[i], static_cast<float>(top_m - 10.0 * away));
        }
    }
    return dem;
}

} // namespace

TEST(Landmarks, HeightRangeIsThatOfTheNumbers) {
    constexpr float none = std::numeric_limits<float>::infinity();
    for (std::int64_t width = 1; width < 70; ++width) {
        Raster<float> dem(Grid{width, 1, 10.0, 1000.0, 2000.0, ""});
        std::optional<std::pair<double, double>> wanted;
        for (std::int64_t i = 0; i < width; ++i) {
            std::int64_t const drawn = (i * 37 + width * 11) % 101;
            dem[i] = drawn % 3 == 0
                         ? std::numeric_limits<float>::quiet_NaN()
                         : (drawn % 7 == 0 ? (drawn % 2 == 0 ? none : -none) : static_cast<float>(drawn - 50));
            if (std::isfinite(dem[i])) {
                auto const z = static_cast<double>(dem[i]);
                wanted = wanted ? std::pair(std::min(wanted->first, z), std::max(wanted->second, z)) : std::pair(z, z);
            }
        }
        EXPECT_EQ(report::height_range(dem), wanted) << width;
    }
    EXPECT_FALSE(report::height_range(Raster<float>()));
}

TEST(Landmarks, SummitsAreTheMostProminentWithRoomBetweenThem) {
    // The third stands too near to the second, the fourth is not prominent enough.
    Raster<float> dem = cones({{{40, 40}, 200.0}, {{120, 40}, 300.0}, {{126, 40}, 280.0}, {{80, 70}, 8.0}});
    dem[Cell{0, 0}] = std::numeric_limits<float>::quiet_NaN();
    std::vector<report::Summit> const found = report::summits(dem, 10);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].at, dem.grid().centre({120, 40}));
    EXPECT_EQ(found[0].z, 300.0);
    EXPECT_EQ(found[1].at, dem.grid().centre({40, 40}));
    EXPECT_EQ(report::summits(dem, 1).size(), 1U);
    EXPECT_TRUE(report::summits(Raster<float>(dem.grid(), 5.0F), 10).empty());
}

TEST(Landmarks, SummitsOfALargeDemAreItsHighestCells) {
    std::vector<std::pair<Cell, double>> const tops = {{{400, 40}, 200.0}, {{1501, 50}, 300.0}, {{2000, 44}, 250.0}};
    Raster<float> const dem = cones(tops, 2100, 90);
    Overview const seen = report::overview_of(dem, 100);
    EXPECT_EQ(seen.means.width(), 100);
    for (auto const& found : {report::summits(dem, 10), report::summits(dem, seen, 10)}) {
        ASSERT_EQ(found.size(), 3U);
        for (std::size_t k = 0; k < 3; ++k) {
            auto const& [top, height] = tops[(k + 1) % 3];
            EXPECT_EQ(found[k].at, dem.grid().centre(top)) << k;
            EXPECT_EQ(found[k].z, height) << k;
        }
    }
}

TEST(Landmarks, TheSeaIsWhereCellsOfATerrainAreNotLand) {
    make::Terrain terrain;
    EXPECT_FALSE(report::sea_of(terrain).has_value());
    terrain.ground.land = Mask(Grid{3, 3, 1.0, 0.0, 3.0, ""}, 1);
    ASSERT_TRUE(report::sea_of(terrain).has_value());
    EXPECT_FALSE(report::sea_of(terrain)->is_around);
    terrain.ground.land = Mask{};
    terrain.ground.how = make::Equilibrium{};
    EXPECT_FALSE(report::sea_of(terrain).has_value());
    terrain.ground.how = make::Equilibrium{.edge = surface::Edge::coast};
    EXPECT_TRUE(report::sea_of(terrain)->is_around);
}

TEST(Landmarks, ARecipeNamesTheSeaOfTerrainInEquilibrium) {
    recipe::Recipe recipe;
    EXPECT_FALSE(report::sea_of(recipe).has_value());
    recipe.surface.emplace();
    recipe.surface->method = recipe::Method::equilibrium;
    for (auto const& [edge, has_sea, is_around] : {std::tuple{surface::Edge::open, false, false},
                                                   {surface::Edge::mainland, true, false},
                                                   {surface::Edge::coast, true, true}}) {
        recipe.surface->equilibrium.edge = edge;
        EXPECT_EQ(report::sea_of(recipe).has_value(), has_sea);
        EXPECT_EQ(report::sea_of(recipe).value_or(report::Sea{}).is_around, is_around);
    }
    recipe.surface->method = recipe::Method::dilate;
    EXPECT_FALSE(report::sea_of(recipe).has_value());
}

} // namespace thalweg::report
