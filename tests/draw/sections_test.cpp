// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/diagrams.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/draw/sections.hpp>

#include "pictures.hpp"
#include "small_land.hpp"

namespace sections_test {

using namespace thalweg;
using draw::cut_sections;
using draw::Format;
using draw::HypsometryParams;
using draw::Section;
using draw::SectionsParams;

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

} // namespace

TEST(CutSections, WithoutRiversTheMiddleRowAndColumn) {
    Raster<float> dem({4, 3, 10.0, 100.0, 50.0, ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = static_cast<float>(i);
    }
    std::vector<Section> const cuts = cut_sections(dem, nullptr, nullptr, 5);
    ASSERT_EQ(cuts.size(), 2U);
    EXPECT_EQ(cuts[0].kind, Section::Kind::row);
    EXPECT_EQ(cuts[0].points.front(), (Vec2{0.0, 4.0}));
    EXPECT_EQ(cuts[0].points.back(), (Vec2{40.0, 7.0}));
    EXPECT_EQ(cuts[1].kind, Section::Kind::column);
    EXPECT_EQ(cuts[1].points.front(), (Vec2{0.0, 10.0}));
    EXPECT_EQ(cuts[1].points.back(), (Vec2{30.0, 2.0}));
    EXPECT_EQ(cut_sections(Raster<float>({1, 1, 10.0, 0.0, 0.0, ""}), nullptr, nullptr, 5).size(), 2U);
    EXPECT_THROW(cut_sections(Raster<float>(), nullptr, nullptr, 5), BadInput);
}

// The stem of the small land runs south-east, then south; its sections are square to it, from the upper to the lower.
TEST(CutSections, AcrossTheMainStem) {
    test::SmallLand const land = test::small_land();
    std::vector<Section> const cuts = cut_sections(land.dem, &land.network, &land.orders, 5);
    ASSERT_EQ(cuts.size(), 5U);
    double const length = land.orders.node_dist_out_m[0] > land.orders.node_dist_out_m[1]
                              ? land.orders.node_dist_out_m[0]
                              : land.orders.node_dist_out_m[1];
    for (std::size_t k = 0; k < 5; ++k) {
        EXPECT_NEAR(cuts[k].from_outlet_m, length * (0.9 - 0.2 * static_cast<double>(k)), 1e-9);
        EXPECT_EQ(cuts[k].kind, Section::Kind::river);
        for (std::size_t i = 1; i < cuts[k].points.size(); ++i) {
            EXPECT_LE(cuts[k].points[i].x - cuts[k].points[i - 1].x, 10.0 + 1e-9);
        }
    }
    Section const& lowest = cuts.back(); // flowing south: the left bank is in the east
    EXPECT_NEAR(lowest.begin.y, lowest.end.y, 1e-9);
    EXPECT_GT(lowest.begin.x, lowest.end.x);
    EXPECT_LT(lowest.points.front().x, 0.0);
    EXPECT_GT(lowest.points.back().x, 0.0);
}

TEST(CutSections, HeightsAreBilinearAndHolesAreGaps) {
    Raster<float> dem({3, 3, 10.0, 0.0, 30.0, ""});
    for (std::int64_t i = 0; i < 9; ++i) {
        Cell const c = dem.grid().at(i);
        dem[i] = static_cast<float>(2 * c.col + 10 * c.row);
    }
    EXPECT_DOUBLE_EQ(draw::height_at(dem, {15.0, 15.0}), 12.0);
    EXPECT_DOUBLE_EQ(draw::height_at(dem, {17.5, 10.0}), 0.25 * 2 + 2 + 15.0);
    EXPECT_DOUBLE_EQ(draw::height_at(dem, {0.0, 30.0}), 0.0) << "level beyond the outermost centres";
    EXPECT_TRUE(std::isnan(draw::height_at(dem, {-0.1, 15.0})));
    EXPECT_TRUE(std::isnan(draw::height_at(dem, {15.0, 31.0})));
    dem[Cell{0, 1}] = none;
    EXPECT_TRUE(std::isnan(draw::height_at(dem, {14.0, 15.0})));
    EXPECT_DOUBLE_EQ(draw::height_at(dem, {15.0, 15.0}), 12.0);
    EXPECT_TRUE(std::isnan(cut_sections(dem, nullptr, nullptr, 1)[0].points.front().y));
}

TEST(Sections, OfEveryKindOfLand) {
    test::SmallLand const land = test::small_land();
    std::string const svg = draw::sections(land.dem, &land.network, &land.orders).bytes;
    EXPECT_TRUE(test::is_xml(svg));
    EXPECT_TRUE(svg == draw::sections(land.dem, &land.network, &land.orders).bytes);
    EXPECT_TRUE(test::is_xml(draw::sections(land.dem, nullptr, nullptr).bytes));
    Grid const grid{9, 7, 30.0, 0.0, 0.0, ""};
    Raster<float> dem(grid, 8848.0F);
    EXPECT_TRUE(test::is_xml(draw::sections(dem, nullptr, nullptr).bytes));
    dem[Cell{4, 3}] = none;
    EXPECT_TRUE(test::is_xml(draw::sections(dem, nullptr, nullptr).bytes));
    EXPECT_TRUE(test::is_xml(draw::sections(Raster<float>(grid, none), nullptr, nullptr).bytes));
    EXPECT_TRUE(test::is_xml(draw::sections(Raster<float>({1, 1, 5.0, 0.0, 0.0, ""}), nullptr, nullptr).bytes));
    SectionsParams params;
    params.format = Format::png;
    params.width_px = 500;
    test::Pixels const pixels = test::decode(draw::sections(land.dem, &land.network, &land.orders, params).bytes);
    EXPECT_EQ(pixels.width, 500U);
    EXPECT_GT(test::river_pixels(pixels), 100U) << "marks of the river and the key map";
}

TEST(Sections, RefusesWhatDoesNotFit) {
    test::SmallLand const land = test::small_land();
    EXPECT_THROW(draw::sections(land.dem, &land.network, nullptr), BadInput);
    SectionsParams params;
    params.count = 0;
    EXPECT_THROW(draw::sections(land.dem, nullptr, nullptr, params), BadParameter);
    params.count = 10;
    EXPECT_THROW(draw::sections(land.dem, nullptr, nullptr, params), BadParameter);
}

TEST(Hypsometry, OfNothingOfOneHeightAndOfALand) {
    EXPECT_TRUE(test::is_xml(draw::hypsometry({}, 0.0).bytes));
    EXPECT_TRUE(test::is_xml(draw::hypsometry({{0.5, 3.0}}, 0.5).bytes));
    EXPECT_TRUE(test::is_xml(draw::hypsometry({{1.0, 3.0}, {0.0, 3.0}}, 0.5).bytes));
    HypsometryParams params;
    params.title = "谷 & <valley>";
    EXPECT_TRUE(test::is_xml(draw::hypsometry({{1.0, -3.0}, {0.4, 100.0}, {0.0, 300.0}}, 0.4, params).bytes));
    params.format = Format::png;
    EXPECT_EQ(test::decode(draw::hypsometry({{1.0, -3.0}, {0.0, 300.0}}, 0.4, params).bytes).width, 1000U);
}

TEST(Hypsometry, RefusesWhatIsNoShare) {
    EXPECT_THROW(draw::hypsometry({{1.1, 0.0}}, 0.5), BadInput);
    EXPECT_THROW(draw::hypsometry({{NAN, 0.0}}, 0.5), BadInput);
    EXPECT_THROW(draw::hypsometry({{1.0, NAN}}, 0.5), BadInput);
    EXPECT_THROW(draw::hypsometry({{1.0, 0.0}, {0.0, 1.0}}, 1.5), BadInput);
    HypsometryParams params;
    params.width_px = 9000;
    EXPECT_THROW(draw::hypsometry({}, 0.0, params), BadParameter);
}

} // namespace sections_test
