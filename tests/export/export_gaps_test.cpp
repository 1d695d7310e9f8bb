// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/export/internal/export_gaps.hpp>

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace export_gaps_test {

using namespace thalweg;
using namespace thalweg::report;
using namespace thalweg::exports;

namespace {

RiverSpline river(std::vector<Vec3> line) {
    RiverSpline out{3, 7, 2, std::move(line), {}, {}};
    for (std::size_t i = 0; i < out.line.size(); ++i) {
        out.discharge_m3s.push_back(static_cast<double>(i));
        out.width_m.push_back(10.0 * static_cast<double>(i));
    }
    return out;
}

/// 6 x 4 cells of 10 m; the first column has no data.
Scene beside_a_rim() {
    Scene scene;
    scene.dem = test::raster_of(test::frame(6, 4, 10.0), [](Cell c) {
        return c.col == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(c.col - 3);
    });
    return scene;
}

} // namespace

TEST(RiversInside, AreCutAtTheBorderAndKeepTheirNumbers) {
    Grid const grid{10, 10, 1.0, 0.0, 10.0, ""};
    ExportResult made;
    std::vector<RiverSpline> const parts =
        rivers_inside({river({{-2, 5, 40}, {2, 5, 36}, {12, 5, 26}, {12, 3, 24}, {8, 3, 20}}),
                       river({{20, 1, 1}, {30, 1, 0}}), river({{1, 1, 5}, {9, 9, 4}})},
                      grid, made);
    ASSERT_EQ(made.findings.size(), 1U);
    EXPECT_TRUE(test::has(made.findings[0].text, "5 of 9 points of rivers"));
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_EQ(parts[0].line, (std::vector<Vec3>{{0, 5, 38}, {2, 5, 36}, {10, 5, 28}}));
    EXPECT_EQ(parts[0].discharge_m3s, (std::vector<double>{0.5, 1.0, 1.8}));
    EXPECT_EQ(parts[0].width_m, (std::vector<double>{5.0, 10.0, 18.0}));
    EXPECT_EQ(parts[0].arc, 3);
    EXPECT_EQ(parts[1].line, (std::vector<Vec3>{{10, 3, 22}, {8, 3, 20}}));
    EXPECT_EQ(parts[1].ds_arc, 7);
    EXPECT_EQ(parts[2].line, (std::vector<Vec3>{{1, 1, 5}, {9, 9, 4}}));
}

TEST(ExportGaps, TheSceneIsCutAndItsSeaIsWater) {
    Scene scene = beside_a_rim();
    ExportParams params;
    params.sea_level_m = 0.0;
    ExportResult made;
    close_gaps_of(scene, params, made, {});
    EXPECT_EQ(scene.dem->width(), 5);
    EXPECT_EQ(scene.dem->grid().west, beside_a_rim().dem->grid().west + 10.0);
    EXPECT_TRUE(made.gaps.is_cut);
    EXPECT_EQ(made.gaps.rim_cells, 4);
    for (std::int64_t i = 0; i < scene.dem->cells(); ++i) {
        EXPECT_EQ(scene.lakes[i] != 0, (*scene.dem)[i] <= 0.0F);
    }
    ASSERT_TRUE(scene.sea);
    EXPECT_EQ(scene.sea->level_m, 0.0);
}

TEST(ExportGaps, AFolderWithASeaKeepsIt) {
    Scene scene = beside_a_rim();
    scene.sea = Sea{1.0, true};
    ExportParams params;
    ExportResult made;
    close_gaps_of(scene, params, made, {});
    EXPECT_EQ(scene.dem->width(), 6);
    EXPECT_TRUE(made.findings.empty());
    params.rim = "nearest";
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { close_gaps_of(scene, params, made, {}); }), "sea at 1 m",
                          "leave out --rim"));
}

} // namespace export_gaps_test
