// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/map.hpp>

#include <thalweg/core/error.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "pictures.hpp"
#include "small_land.hpp"

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
    sheet.contours.emplace_back(1.0, std::vector<Vec2>{{NAN, 0.0}, {1.0, 1.0}});
    EXPECT_THROW(draw::map(sheet), BadInput);
}

TEST(Map, HasItsWidthItsRiversAndItsRelief) {
    test::Pixels const without = test::decode(drawn(test::small_land().dem).bytes);
    test::Pixels const pixels = test::decode(small_map({}).bytes);
    ASSERT_EQ(pixels.width, 1400U);
    EXPECT_GT(test::river_pixels(pixels), test::river_pixels(without) + 2000);
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

// A picture, a sixteenth of its size in each direction: fonts may differ by machine, the map may not.
TEST(Map, GoldenPicture) {
    MapParams params;
    params.width_px = 640;
    params.contour_interval_m = 50.0;
    test::Pixels const pixels = test::decode(small_map(params).bytes);
    constexpr std::size_t block = 16;
    std::vector<int> means;
    for (std::size_t y = 0; y + block <= pixels.height; y += block) {
        for (std::size_t x = 0; x + block <= pixels.width; x += block) {
            for (std::size_t band = 0; band < 3; ++band) {
                int sum = 0;
                for (std::size_t k = 0; k < block * block; ++k) {
                    sum += pixels.at(x + k % block, y + k / block, band);
                }
                means.push_back(sum / static_cast<int>(block * block));
            }
        }
    }
    std::string const path = THALWEG_SOURCE_DIR "/tests/data/map_small.txt";
    if (char const* const renew = std::getenv("THALWEG_RENEW"); renew != nullptr && *renew == '1') {
        std::ofstream out(path);
        for (std::size_t i = 0; i < means.size(); ++i) {
            out << means[i] << (i % (3 * (pixels.width / block)) + 1 == 3 * (pixels.width / block) ? '\n' : ' ');
        }
    }
    std::ifstream in(path);
    std::vector<int> golden;
    for (int value = 0; in >> value;) {
        golden.push_back(value);
    }
    ASSERT_EQ(golden.size(), means.size()) << "THALWEG_RENEW=1 writes " << path;
    double off = 0.0;
    for (std::size_t i = 0; i < means.size(); ++i) {
        off += std::abs(means[i] - golden[i]);
        EXPECT_LE(std::abs(means[i] - golden[i]), 40) << "block " << i / 3;
    }
    EXPECT_LE(off / static_cast<double>(means.size()), 1.5);
}
