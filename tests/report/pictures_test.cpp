// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/report/pictures.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

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

} // namespace thalweg::report
