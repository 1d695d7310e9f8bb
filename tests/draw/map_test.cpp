// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/map.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include <thalweg/core/box_means.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/draw/internal/map.hpp>

#include "pictures.hpp"
#include "small_land.hpp"

namespace map_test {

using namespace thalweg;
using draw::Format;
using draw::MapParams;
using draw::MapSheet;

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

draw::Picture drawn(Raster<float> const& dem, MapParams const& params = {}) {
    Raster<std::uint8_t> const hillshade = test::shade(dem);
    return draw::map({dem, hillshade, nullptr, nullptr, {}}, params);
}

draw::Picture small_map(MapParams const& params) {
    test::SmallLand const land = test::small_land();
    MapSheet sheet{land.dem, land.hillshade, &land.network, &land.orders, {}};
    sheet.contours.emplace_back(100.0, std::vector<Vec2>{{500000, 4499700}, {500240, 4499800}, {500480, 4499700}});
    return draw::map(sheet, params);
}

} // namespace

TEST(Map, SizesThatAreHardlyMaps) {
    for (auto const& [width, height] :
         {std::pair<std::int64_t, std::int64_t>{1, 1}, {1, 9}, {9, 1}, {2000, 3}, {3, 2000}}) {
        Raster<float> const dem = test::slopes({width, height, 10.0, 0.0, 0.0, ""});
        test::Pixels const pixels = test::decode(drawn(dem).bytes);
        EXPECT_EQ(pixels.width, 1400U) << width << " x " << height;
        EXPECT_GT(pixels.height, 0U) << width << " x " << height;
    }
}

TEST(Map, OneHeightHolesAndNothingAtAll) {
    Grid const grid{20, 20, 30.0, 0.0, 600.0, "EPSG:32631"};
    Raster<float> dem(grid, 12.0F);
    EXPECT_GT(test::decode(drawn(dem).bytes).height, 0U);
    dem[Cell{3, 3}] = none;
    EXPECT_GT(test::decode(drawn(dem).bytes).height, 0U);
    EXPECT_GT(test::decode(drawn(Raster<float>(grid, none)).bytes).height, 0U);
}

TEST(Map, RefusesWhatDoesNotFit) {
    test::SmallLand land = test::small_land();
    Raster<std::uint8_t> const other(Grid{3, 3, 10.0, 0.0, 0.0, ""});
    EXPECT_THROW(draw::map({land.dem, other, nullptr, nullptr, {}}), BadInput);
    EXPECT_THROW(draw::map({land.dem, land.hillshade, &land.network, nullptr, {}}), BadInput);
    for (int const width : {-1, 0, 199, 8001}) {
        MapParams params;
        params.width_px = width;
        EXPECT_THROW(drawn(land.dem, params), BadParameter) << width;
    }
    MapSheet sheet{land.dem, land.hillshade, nullptr, nullptr, {}};
    sheet.spot_heights = {{{500000, 4500000}, NAN}};
    EXPECT_THROW(draw::map(sheet), BadInput);
    sheet.spot_heights = {};
    sheet.lakes = &other;
    EXPECT_THROW(draw::map(sheet), BadInput);
    sheet.lakes = nullptr;
    sheet.contours.emplace_back(1.0, std::vector<Vec2>{{NAN, 0.0}, {1.0, 1.0}});
    EXPECT_THROW(draw::map(sheet), BadInput);
}

TEST(Map, HasItsWidthItsRiversAndItsRelief) {
    test::Pixels const without = test::decode(drawn(test::small_land().dem).bytes);
    test::Pixels const pixels = test::decode(small_map({}).bytes);
    ASSERT_EQ(pixels.width, 1400U);
    EXPECT_GT(test::river_pixels(pixels), test::river_pixels(without) + 2000);
}

TEST(Map, RiversAreAsWideAsTheRootOfWhatTheyDrain) {
    test::SmallLand const land = test::small_land();
    auto const drawn_by = [&land](std::vector<double> areas_m2) {
        return draw::map({land.dem, land.hillshade, &land.network, &land.orders, {}, nullptr, std::move(areas_m2)})
            .bytes;
    };
    std::size_t const arcs = land.network.planform.arc_count();
    std::vector<double> small(arcs, 1e4);
    small.back() = 1e8;
    auto const thin = test::river_pixels(test::decode(drawn_by(small)));
    auto const wide = test::river_pixels(test::decode(drawn_by(std::vector<double>(arcs, 1e8))));
    EXPECT_GT(wide, thin);
    EXPECT_EQ(drawn_by(std::vector<double>(arcs, -1.0)), drawn_by({})); // not known: by Strahler order
    EXPECT_NE(drawn_by(small), drawn_by({}));
    std::vector<double> forged(arcs, std::nan(""));
    forged.front() = std::numeric_limits<double>::infinity();
    EXPECT_EQ(drawn_by(forged), drawn_by({}));
    EXPECT_THROW(drawn_by({1.0}), BadInput);
}

TEST(Map, OrdersAndAreasHaveTheSameWidths) {
    draw::RiverScale const scale{.highest_order = 4, .largest_area_m2 = 9e6};
    EXPECT_EQ(draw::style_of_order(1, scale, 1.0).width_px, draw::style_of_area(0.0, scale, 1.0).width_px);
    EXPECT_EQ(draw::style_of_order(4, scale, 1.0).width_px, draw::style_of_area(9e6, scale, 1.0).width_px);
}

TEST(Map, MeansOfADemAreDrawnInItsPlace) {
    test::SmallLand const land = test::small_land();
    MapSheet const sheet{land.dem, land.hillshade, &land.network, &land.orders, {}};
    test::Pixels const whole = test::decode(draw::map(sheet).bytes);
    Raster<float> const means = box_means(land.dem, 29);
    Raster<std::uint8_t> const shade = test::shade(means);
    draw::HeightRange const heights = draw::height_range(land.dem);
    MapSheet coarse{means, shade, &land.network, &land.orders, {}};
    coarse.whole = draw::WholeDem{land.dem.grid(), heights.low_m, heights.high_m};
    test::Pixels const pixels = test::decode(draw::map(coarse).bytes);
    ASSERT_EQ(pixels.rgb.size(), whole.rgb.size());
    double difference = 0.0;
    std::size_t differing = 0; // outside of the land: legend and facts are those of the whole
    for (std::size_t i = 0; i < pixels.rgb.size(); ++i) {
        difference += std::abs(static_cast<int>(pixels.rgb[i]) - static_cast<int>(whole.rgb[i]));
        bool const is_below = i / 3 / pixels.width > 90 + 1310;
        differing += is_below && pixels.rgb[i] != whole.rgb[i] ? 1 : 0;
    }
    EXPECT_LT(difference / static_cast<double>(pixels.rgb.size()), 2.0);
    EXPECT_EQ(differing, 0U);
}

TEST(Map, TellsHowManyColumnsItShows) {
    Grid const square{5000, 5000, 10.0, 0.0, 0.0, ""};
    EXPECT_EQ(draw::columns_of_map(square), 1310);
    MapParams scalable;
    scalable.format = Format::svg;
    EXPECT_EQ(draw::columns_of_map(square, scalable), 2620);
    EXPECT_EQ(draw::columns_of_map({5000, 50000, 10.0, 0.0, 0.0, ""}), 184); // 1.4 times as tall as wide at most
    EXPECT_EQ(draw::columns_of_ground({2049, 2049, 10.0, 0.0, 0.0, ""}), 2049);
}

TEST(Map, RidgesAreBrownLinesAndNoneLeaveNoTrace) {
    test::SmallLand const land = test::small_land();
    MapSheet sheet{land.dem, land.hillshade, &land.network, &land.orders, {}};
    std::string const without = draw::map(sheet).bytes;
    RidgeLines ridges;
    sheet.ridges = &ridges;
    EXPECT_TRUE(draw::map(sheet).bytes == without);

    ridges.lines.push_back({{{500020, 4499540, 9.0}, {500020, 4499900, 8.0}, {500035, 4499960, 7.0}}, 1, 2});
    test::Pixels const plain = test::decode(without);
    test::Pixels const pixels = test::decode(draw::map(sheet).bytes);
    ASSERT_EQ(pixels.width, plain.width);
    std::size_t on_the_map = 0; // brown where it was not
    std::size_t in_the_legend = 0;
    for (std::size_t y = 0; y < std::min(pixels.height, plain.height); ++y) {
        for (std::size_t x = 0; x < pixels.width; ++x) {
            bool const darker = pixels.at(x, y, 2) + 40 < plain.at(x, y, 2);
            bool const brown = pixels.at(x, y, 0) > pixels.at(x, y, 2) + 15;
            (y < plain.height * 4 / 5 ? on_the_map : in_the_legend) += darker && brown ? 1 : 0;
        }
    }
    EXPECT_GT(on_the_map, 500U);
    EXPECT_TRUE(in_the_legend > 20U || pixels.height > plain.height);

    ridges.lines[0].line[1].x = NAN;
    EXPECT_THROW(draw::map(sheet), BadInput);
}

namespace {

bool is_water(test::Pixels const& pixels, std::size_t x, std::size_t y) {
    return pixels.at(x, y, 2) > pixels.at(x, y, 0) + 20 && pixels.at(x, y, 2) > 200;
}

} // namespace

// The eastern half has no heights: sea where the sheet says so, else grey. In the western half lies a lake.
TEST(Map, SeaAndLakesAreWater) {
    Grid const grid{40, 40, 10.0, 0.0, 400.0, ""};
    Raster<float> dem = test::slopes(grid);
    Mask lakes(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const c = grid.at(i);
        dem[i] = c.col < 20 ? dem[i] : none;
        lakes[i] = c.col >= 5 && c.col < 12 && c.row >= 10 && c.row < 30 ? 1 : 0;
    }
    Raster<std::uint8_t> const hillshade = test::shade(dem);
    MapSheet sheet{dem, hillshade, nullptr, nullptr, {}};
    test::Pixels const dry = test::decode(draw::map(sheet).bytes);
    std::size_t const middle = dry.height / 2;
    EXPECT_FALSE(is_water(dry, 1050, middle));
    EXPECT_EQ(dry.at(1050, middle, 0), dry.at(1050, middle, 2)); // grey
    EXPECT_FALSE(is_water(dry, 330, middle));
    sheet.lakes = &lakes;
    for (bool const is_around : {false, true}) {
        sheet.sea = draw::Sea{is_around};
        test::Pixels const wet = test::decode(draw::map(sheet).bytes);
        EXPECT_EQ(wet.height, dry.height);
        EXPECT_TRUE(is_water(wet, 330, middle));
        EXPECT_FALSE(is_water(wet, 580, middle)); // between lake and sea
        for (std::size_t const x : {720U, 800U, 1050U, 1350U}) {
            EXPECT_TRUE(is_water(wet, x, middle)) << x;
        }
        EXPECT_GT(wet.at(720, middle, 0), wet.at(1300, middle, 0)); // paler at the shore
    }
}

TEST(Map, ASeaWithoutHolesOrLandIsDrawn) {
    Grid const grid{9, 7, 30.0, 0.0, 210.0, ""};
    for (float const z : {12.0F, none}) {
        Raster<float> const dem(grid, z);
        Raster<std::uint8_t> const hillshade = test::shade(dem);
        MapSheet sheet{dem, hillshade, nullptr, nullptr, {}};
        sheet.sea = draw::Sea{true};
        EXPECT_GT(test::decode(draw::map(sheet).bytes).height, 0U);
    }
}

TEST(Map, EveryFormatIsWhatItSays) {
    MapParams params;
    params.format = Format::svg;
    params.title = "谷 <valley> & \"quotes\"";
    std::string const svg = small_map(params).bytes;
    EXPECT_TRUE(test::is_xml(svg));
    EXPECT_LT(svg.size(), 2000000U);
    params.format = Format::pdf;
    EXPECT_EQ(small_map(params).bytes.substr(0, 5), "%PDF-");
    params.format = Format::png;
    EXPECT_EQ(small_map(params).bytes.substr(1, 3), "PNG");
}

TEST(Map, SameBytesForTheSameSheet) {
    for (Format const format : {Format::png, Format::svg, Format::pdf}) {
        MapParams params;
        params.format = format;
        EXPECT_TRUE(small_map(params).bytes == small_map(params).bytes);
    }
}

TEST(Map, LongTitlesStayOnTheSheet) {
    MapParams params;
    params.width_px = 400;
    for (int k = 0; k < 60; ++k) {
        params.title += "a valley of 谷 ";
    }
    test::Pixels const pixels = test::decode(small_map(params).bytes);
    ASSERT_EQ(pixels.width, 400U);
    for (std::size_t y = 0; y < 25; ++y) { // beside the title the sheet stays white
        for (std::size_t x = 396; x < 400; ++x) {
            EXPECT_EQ(pixels.at(x, y, 0), 255);
        }
    }
}

// Where no font has a letter all letters are the same box.
TEST(Map, CjkTitlesAreLetters) {
    auto const titled = [](std::string const& title) {
        MapParams params;
        params.width_px = 400;
        params.title = title;
        return test::decode(small_map(params).bytes);
    };
    test::Pixels const valley = titled("谷");
    test::Pixels const mountain = titled("山");
    test::Pixels const replaced = titled("\uFFFD");
    test::Pixels const boxed = titled("\U0010FFFD"); // no font has it
    auto const ink = [](test::Pixels const& pixels) {
        std::size_t count = 0;
        for (std::size_t y = 0; y < 25; ++y) {
            for (std::size_t x = 0; x < 60; ++x) {
                count += pixels.at(x, y, 0) < 128;
            }
        }
        return count;
    };
    EXPECT_GT(ink(valley), 20U);
    EXPECT_GT(ink(mountain), 20U);
    EXPECT_TRUE(valley.rgb != mountain.rgb) << "is Noto Sans CJK installed (scripts/packages)?";
    EXPECT_TRUE(valley.rgb != boxed.rgb);
    EXPECT_TRUE(valley.rgb != replaced.rgb);
}

// A small map as it was approved by eye. Versions of Cairo and of the fonts differ a little at the edges of lines.
TEST(Map, GoldenPicture) {
    MapParams params;
    params.width_px = 480;
    params.contour_interval_m = 50.0;
    params.title = "Two rivers";
    std::string const drawn_now = small_map(params).bytes;
    std::string const path = THALWEG_SOURCE_DIR "/tests/data/map_small.png";
    if (char const* const renew = std::getenv("THALWEG_RENEW"); renew != nullptr && *renew == '1') {
        std::ofstream(path, std::ios::binary) << drawn_now;
    }
    std::ifstream in(path, std::ios::binary);
    std::ostringstream golden_bytes;
    golden_bytes << in.rdbuf();
    test::Pixels const golden = test::decode(golden_bytes.str());
    test::Pixels const pixels = test::decode(drawn_now);
    ASSERT_EQ(golden.width, pixels.width) << "THALWEG_RENEW=1 writes " << path;
    ASSERT_EQ(golden.height, pixels.height);
    double off = 0.0;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < pixels.rgb.size(); ++i) {
        int const by = std::abs(pixels.rgb[i] - golden.rgb[i]);
        off += by;
        differing += by > 40;
    }
    auto const values = static_cast<double>(pixels.rgb.size());
    EXPECT_LE(off / values, 1.5) << "mean difference of a channel, of 255";
    EXPECT_LE(static_cast<double>(differing) / values, 0.01) << "share of channels that differ by more than 40";
}

TEST(Ground, IsTheMapAloneFromCellCentreToCellCentre) {
    test::SmallLand const land = test::small_land();
    MapSheet const sheet{land.dem, land.hillshade, &land.network, &land.orders, {}};
    draw::Picture const picture = draw::ground(sheet, {.width_px = 470});
    test::Pixels const pixels = test::decode(picture.bytes);
    EXPECT_EQ(pixels.width, 470U);
    EXPECT_EQ(pixels.height, 470U);
    EXPECT_GT(test::river_pixels(pixels), 470U);
    EXPECT_EQ(draw::ground(sheet, {.width_px = 470}).bytes, picture.bytes);
    // the river's mouth: 500235 m lies 23 cells of 10 px from the centre of the first
    unsigned char const blue = pixels.at(230, 400, 2);
    EXPECT_GT(blue, pixels.at(230, 400, 0) + 60);
    EXPECT_LT(pixels.at(250, 400, 2), pixels.at(250, 400, 0) + 60);

    MapSheet const bare{land.dem, land.hillshade, nullptr, nullptr, {}};
    test::Pixels const flat = test::decode(draw::ground(bare, {.width_px = 470, .shading = 0.0}).bytes);
    test::Pixels const shaded = test::decode(draw::ground(bare, {.width_px = 470, .shading = 1.0}).bytes);
    EXPECT_EQ(test::river_pixels(flat), 0U);
    auto const contrast = [](test::Pixels const& p) { return std::abs(p.at(50, 300, 0) - p.at(420, 300, 0)); };
    EXPECT_LT(contrast(flat), contrast(shaded));
}

TEST(Ground, HolesSeaAndBadSheets) {
    test::SmallLand land = test::small_land();
    for (std::int64_t row = 30; row < 48; ++row) {
        for (float& z : land.dem.row(row)) {
            z = none;
        }
    }
    MapSheet sheet{land.dem, land.hillshade, nullptr, nullptr, {}};
    test::Pixels const grey = test::decode(draw::ground(sheet, {.width_px = 300}).bytes);
    EXPECT_EQ(grey.at(150, 280, 0), grey.at(150, 280, 2));
    sheet.sea = draw::Sea{};
    test::Pixels const sea = test::decode(draw::ground(sheet, {.width_px = 300}).bytes);
    EXPECT_GT(sea.at(150, 280, 2), sea.at(150, 280, 0));
    EXPECT_NE(test::message_of<BadParameter>([&] { draw::ground(sheet, {.width_px = 100}); }), "");
    EXPECT_NE(test::message_of<BadParameter>([&] { draw::ground(sheet, {.shading = 1.5}); }), "");
    for (auto const& [width, height] : {std::pair<std::int64_t, std::int64_t>{1, 9}, {9, 1}, {200, 3}}) {
        Raster<float> const strip = test::slopes({width, height, 10.0, 0.0, 0.0, ""});
        Raster<std::uint8_t> const shade = test::shade(strip);
        EXPECT_NE(test::message_of<BadInput>([&] { draw::ground({strip, shade, nullptr, nullptr, {}}); }), "");
    }
}

} // namespace map_test
