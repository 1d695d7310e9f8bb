// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/internal/wireframe.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/draw/wireframe.hpp>

#include "pictures.hpp"
#include "small_land.hpp"

namespace wireframe_test {

using namespace thalweg;
using draw::Format;
using draw::WireframeParams;

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

std::size_t dark_pixels(test::Pixels const& pixels) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + 2 < pixels.rgb.size(); i += 3) {
        count += pixels.rgb[i] < 128 && pixels.rgb[i + 2] < 128;
    }
    return count;
}

test::Pixels drawn(Raster<float> const& dem, WireframeParams params = {}) {
    params.format = Format::png;
    return test::decode(draw::wireframe({dem}, params).bytes);
}

Raster<float> hill(std::int64_t width, std::int64_t height) {
    Raster<float> dem({width, height, 30.0, 500000.0, 5000000.0, "EPSG:32631"});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        double const x = static_cast<double>(2 * c.col - width) / static_cast<double>(width);
        double const y = static_cast<double>(2 * c.row - height) / static_cast<double>(height);
        dem[i] = static_cast<float>(400.0 / (1.0 + 9.0 * (x * x + y * y)));
    }
    return dem;
}

} // namespace

TEST(Wireframe, SizesThatAreHardlyLand) {
    for (auto const& [width, height] :
         {std::pair<std::int64_t, std::int64_t>{1, 1}, {1, 9}, {9, 1}, {2, 2}, {1, 3000}, {3000, 1}, {130, 40}}) {
        test::Pixels const pixels = drawn(hill(width, height));
        EXPECT_EQ(pixels.width, 1200U) << width << " x " << height;
        EXPECT_GT(dark_pixels(pixels), 200U) << width << " x " << height;
    }
}

TEST(Wireframe, OneHeightHolesAndNothingAtAll) {
    Grid const grid{20, 20, 30.0, 0.0, 600.0, "EPSG:32631"};
    Raster<float> dem(grid, 1234.5F);
    std::size_t const whole = dark_pixels(drawn(dem));
    for (std::int64_t row = 5; row < 15; ++row) {
        for (std::int64_t col = 5; col < 15; ++col) {
            dem[Cell{col, row}] = none;
        }
    }
    std::size_t const holed = dark_pixels(drawn(dem));
    EXPECT_LT(holed, whole);
    EXPECT_GT(2 * holed, whole);
    EXPECT_GT(drawn(Raster<float>(grid, none)).height, 0U);
}

TEST(Wireframe, RefusesWhatDoesNotFit) {
    test::SmallLand const land = test::small_land();
    EXPECT_THROW(draw::wireframe({land.dem, &land.network, nullptr}), BadInput);
    EXPECT_THROW(draw::wireframe({Raster<float>()}), BadInput);
    for (auto const& set : std::vector<void (*)(WireframeParams&)>{
             [](WireframeParams& p) { p.width_px = 100; }, [](WireframeParams& p) { p.elevation_deg = 0.0; },
             [](WireframeParams& p) { p.elevation_deg = 90.0; }, [](WireframeParams& p) { p.azimuth_deg = NAN; },
             [](WireframeParams& p) { p.exaggeration = -1.0; }, [](WireframeParams& p) { p.lines = 1; }}) {
        WireframeParams params;
        set(params);
        EXPECT_THROW(draw::wireframe({land.dem}, params), BadParameter);
    }
}

TEST(Wireframe, EveryFormatAndEveryBearing) {
    Raster<float> const dem = hill(500, 500);
    for (double const azimuth : {0.0, 45.0, 90.0, 180.0, 270.0, 359.99, -30.0, 720.0}) {
        WireframeParams params;
        params.azimuth_deg = azimuth;
        std::string const svg = draw::wireframe({dem}, params).bytes;
        EXPECT_TRUE(test::is_xml(svg)) << azimuth;
        EXPECT_LT(svg.size(), 2000000U) << azimuth;
        EXPECT_EQ(svg.find("nan"), std::string::npos) << azimuth;
    }
    WireframeParams params;
    params.title = "谷 <valley> & \"quotes\"";
    EXPECT_TRUE(test::is_xml(draw::wireframe({dem}, params).bytes));
    EXPECT_TRUE(draw::wireframe({dem}, params).bytes == draw::wireframe({dem}, params).bytes);
    params.format = Format::pdf;
    EXPECT_EQ(draw::wireframe({dem}, params).bytes.substr(0, 5), "%PDF-");
}

TEST(Wireframe, ShowsRiversInBlue) {
    test::SmallLand const land = test::small_land();
    WireframeParams params;
    params.format = Format::png;
    EXPECT_EQ(test::river_pixels(test::decode(draw::wireframe({land.dem}, params).bytes)), 0U);
    EXPECT_GT(test::river_pixels(test::decode(draw::wireframe({land.dem, &land.network, &land.orders}, params).bytes)),
              300U);
}

TEST(Wireframe, LooksUpValley) {
    test::SmallLand const land = test::small_land();
    // The outlet is in the south: one looks north, turned off the lines.
    EXPECT_DOUBLE_EQ(draw::azimuth_up_valley({land.dem, &land.network, &land.orders}), 20.0);
    EXPECT_DOUBLE_EQ(draw::azimuth_up_valley({land.dem}), 30.0);
}

TEST(Fishnet, EveryCellWhereTheseAreFew) {
    Raster<float> const dem = hill(5, 3);
    draw::Fishnet const net = draw::fishnet(dem, 60);
    ASSERT_EQ(net.columns, 5);
    ASSERT_EQ(net.rows, 3);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        EXPECT_EQ(net.height_m[static_cast<std::size_t>(i)], static_cast<double>(dem[i]));
    }
}

TEST(Fishnet, NeverMoreLinesThanAskedAndNearlySquare) {
    for (auto const& [width, height] :
         {std::pair<std::int64_t, std::int64_t>{130, 40}, {61, 60}, {1000, 1000}, {4000, 7}, {2, 900}, {60, 60}}) {
        draw::Fishnet const net = draw::fishnet(hill(width, height), 60);
        EXPECT_LE(net.columns, 60);
        EXPECT_LE(net.rows, 60);
        EXPECT_GE(net.columns, 2);
        EXPECT_GE(net.rows, 2);
        EXPECT_EQ(net.col_at.front(), 0.0);
        EXPECT_EQ(net.col_at.back(), static_cast<double>(width - 1));
        EXPECT_EQ(net.row_at.back(), static_cast<double>(height - 1));
    }
    EXPECT_EQ(draw::fishnet(hill(60, 60), 60).columns, 60);
    EXPECT_EQ(draw::fishnet(hill(130, 40), 60).rows, 19);
}

} // namespace wireframe_test
