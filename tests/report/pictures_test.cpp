// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/pictures.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include <thalweg/core/box_means.hpp>

namespace thalweg::report {
namespace {

/// A slope with a hole in the east.
report::Scene slope() {
    report::Scene scene;
    scene.dem.emplace(Grid{60, 40, 30.0, 500000.0, 5000000.0, "EPSG:32631"});
    for (std::int64_t i = 0; i < scene.dem->cells(); ++i) {
        Cell const c = scene.dem->grid().at(i);
        (*scene.dem)[i] =
            c.col < 45 ? static_cast<float>(5 * c.row + 2 * c.col) : std::numeric_limits<float>::quiet_NaN();
    }
    scene.title = "A slope";
    return scene;
}

} // namespace

TEST(Pictures, AMapShowsItsSeaItsLakesAndWhereItIs) {
    report::Scene scene = slope();
    report::Look look;
    look.format = draw::Format::svg;
    look.width_px = 600;
    std::string const dry = report::draw_picture(report::PictureKind::map, scene, look).bytes;
    EXPECT_EQ(report::draw_picture(report::PictureKind::map, scene, look).bytes, dry);
    scene.sea = report::Sea{};
    std::string const with_sea = report::draw_picture(report::PictureKind::map, scene, look).bytes;
    EXPECT_NE(with_sea, dry);
    scene.lakes = Mask(scene.dem->grid());
    EXPECT_EQ(report::draw_picture(report::PictureKind::map, scene, look).bytes, with_sea);
    for (std::int64_t row = 10; row < 20; ++row) {
        scene.lakes[Cell{20, row}] = scene.lakes[Cell{21, row}] = 1;
    }
    EXPECT_NE(report::draw_picture(report::PictureKind::map, scene, look).bytes, with_sea);
    scene = slope();
    Grid grid = scene.dem->grid();
    grid.crs = "EPSG:32632";
    Raster<float> moved(grid);
    std::copy(scene.dem->values().begin(), scene.dem->values().end(), moved.values().begin());
    scene.dem = std::move(moved);
    EXPECT_NE(report::draw_picture(report::PictureKind::map, scene, look).bytes, dry);
}

TEST(Pictures, LandOfMoreColumnsThanPixelsIsShownByItsMeans) {
    Raster<float> plane(Grid{60, 40, 30.0, 500000.0, 5000000.0, ""});
    for (std::int64_t i = 0; i < plane.cells(); ++i) {
        Cell const c = plane.grid().at(i);
        plane[i] = static_cast<float>(5 * c.row + 2 * c.col);
    }
    Mask lakes(plane.grid());
    Overview const all = overview(plane, 60, 1);
    report::ShownLand const whole(plane, all, lakes);
    EXPECT_TRUE(whole.is_whole());
    EXPECT_EQ(&whole.dem(), &plane);
    EXPECT_FALSE(whole.sheet().whole.has_value());

    lakes[Cell{30, 20}] = lakes[Cell{31, 20}] = lakes[Cell{32, 20}] = 1;
    Overview const seen = overview(plane, 40, 1);
    report::ShownLand const coarse(plane, seen, lakes);
    EXPECT_FALSE(coarse.is_whole());
    draw::MapSheet const sheet = coarse.sheet();
    EXPECT_EQ(sheet.dem.width(), 40);
    EXPECT_EQ(sheet.hillshade.width(), 40);
    EXPECT_EQ(std::ranges::count(sheet.lakes->values(), 1), 2);
    ASSERT_TRUE(sheet.whole.has_value());
    EXPECT_EQ(sheet.whole->grid, plane.grid());
    EXPECT_EQ(sheet.whole->low_m, 0.0);
    EXPECT_EQ(sheet.whole->high_m, 5.0 * 39 + 2.0 * 59);
    std::size_t vertices = 0;
    for (auto const& [z, line] : coarse.contours(20.0)) {
        for (Vec2 const p : line) { // means of a plane lie on it
            double const col = (p.x - plane.grid().west) / 30.0 - 0.5;
            double const row = (plane.grid().north - p.y) / 30.0 - 0.5;
            bool const on_rim = col < 2.0 || col > 57.0 || row < 2.0 || row > 37.0;
            EXPECT_NEAR(5.0 * row + 2.0 * col, z, on_rim ? 14.0 : 2.0);
            ++vertices;
        }
    }
    EXPECT_GT(vertices, 20U);
}

} // namespace thalweg::report
