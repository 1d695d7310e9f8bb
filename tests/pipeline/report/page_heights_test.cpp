// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/report/internal/page.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <pipeline/page_decoder.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace page_heights_test {

using namespace thalweg;
using pipeline::page_cells;
using pipeline::page_heights;
using pipeline::PageHeights;

namespace {

using test::has;
using test::message_of;

/// Decodes the page's heights and holds each to the mean of its square.
void hold_to_means(Raster<float> const& dem) {
    auto const page = page_heights(dem);
    ASSERT_TRUE(page.has_value());
    std::int64_t const k = page->cells;
    ASSERT_EQ(page->width, (dem.width() + k - 1) / k);
    ASSERT_EQ(page->height, (dem.height() + k - 1) / k);
    auto const decoded = page_decoder::heights(page->bytes, page->width, page->height, page->min, page->max);
    double const nearest = (page->max - page->min) / 65534.0 / 2.0;
    double const rounding = 1e-12 * (std::fabs(page->max) + std::fabs(page->min));
    std::int64_t nodata = 0;
    for (std::int64_t v = 0; v < page->width * page->height; ++v) {
        double sum = 0.0;
        int count = 0;
        for (std::int64_t r = v / page->width * k; r < (v / page->width + 1) * k && r < dem.height(); ++r) {
            for (std::int64_t c = v % page->width * k; c < (v % page->width + 1) * k && c < dem.width(); ++c) {
                if (!std::isnan(dem[Cell{c, r}])) {
                    sum += static_cast<double>(dem[Cell{c, r}]);
                    ++count;
                }
            }
        }
        double const z = decoded[static_cast<std::size_t>(v)];
        nodata += count == 0;
        ASSERT_EQ(std::isnan(z), count == 0) << v;
        if (count > 0) {
            ASSERT_LE(std::fabs(z - sum / count), nearest + rounding) << v;
        }
    }
    ASSERT_EQ(page->nodata, nodata);
}

} // namespace

TEST(PageHeights, WithoutAHeightThereIsNoBlob) {
    EXPECT_FALSE(page_heights(Raster<float>{}).has_value());
    EXPECT_FALSE(page_heights(dem_of(2, {hole, hole, hole, hole})).has_value());
}

TEST(PageHeights, OneCell) {
    auto const page = page_heights(dem_of(1, {12.5F}));
    ASSERT_TRUE(page.has_value());
    EXPECT_EQ(page->min, 12.5);
    EXPECT_EQ(page->max, 12.5);
    EXPECT_EQ(page->nodata, 0);
    EXPECT_EQ(page->bytes.size(), 3U);
    EXPECT_EQ(page_decoder::heights(page->bytes, 1, 1, page->min, page->max), std::vector<double>{12.5});
}

TEST(PageHeights, OneHeightIsExact) {
    Raster<float> dem = dem_of(3, std::vector<float>(12, -0.7F));
    dem[4] = hole;
    auto const page = page_heights(dem);
    ASSERT_TRUE(page.has_value());
    EXPECT_EQ(page->nodata, 1);
    auto const decoded = page_decoder::heights(page->bytes, 3, 4, page->min, page->max);
    for (std::size_t i = 0; i < decoded.size(); ++i) {
        EXPECT_TRUE(i == 4 ? std::isnan(decoded[i]) : decoded[i] == static_cast<double>(-0.7F)) << i;
    }
}

TEST(PageHeights, AnInfiniteHeightIsRefusedByItsPlace) {
    Raster<float> dem = dem_of(2, {1.0F, 2.0F, 3.0F, 4.0F});
    dem[3] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(has(message_of<BadInput>([&] { page_heights(dem); }), "column 1, row 1"));
}

TEST(PageHeights, TheSmallestSquaresThatAreFewEnough) {
    EXPECT_EQ(page_cells(frame(1, 1)), 1);
    EXPECT_EQ(page_cells(frame(1024, 1024)), 1);
    EXPECT_EQ(page_cells(frame(1500, 1000)), 1);
    EXPECT_EQ(page_cells(frame(1500, 1001)), 2);
    EXPECT_EQ(page_cells(frame(4096, 1)), 1);
    EXPECT_EQ(page_cells(frame(4097, 1)), 2);
    EXPECT_EQ(page_cells(frame(1, 9000)), 3);
    EXPECT_EQ(page_cells(frame(10000, 10000)), 9);
}

TEST(PageHeights, AnyDem) {
    ASSERT_TRUE(rc::check("every height within half a step of its cell", [] {
        hold_to_means([] {
            Raster<float> dem = *gen_dem(20, 70);
            dem[dem.cells() / 2] = 3.0F;
            return dem;
        }());
        RC_ASSERT(!testing::Test::HasFatalFailure());
    }));
}

TEST(PageHeights, RoughAndSmoothAndOneRowWithMeans) {
    hold_to_means(rough_dem(frame(300, 200), 3));
    hold_to_means(rough_dem(frame(1, 300), 4));
    Raster<float> smooth =
        test::raster_of(frame(200, 100), [&](Cell c) { return 1e4F - static_cast<float>(c.col * c.row) * 0.1F; });
    hold_to_means(smooth);
    for (auto const& grid : {frame(1301, 1277), frame(9001, 2), frame(1, 12300)}) {
        Raster<float> dem = rough_dem(grid, 5);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Cell const c = grid.at(i);
            if ((c.col / 5 + c.row / 3) % 4 == 0) { // whole squares and parts of them
                dem[i] = hole;
            }
        }
        hold_to_means(dem);
    }
}

TEST(PageHeights, APlaneCostsNextToNothing) {
    Raster<float> plane = test::raster_of(frame(256, 256), [&](Cell c) { return c.col + 2 * c.row; });
    auto const page = page_heights(plane);
    std::size_t small = 0;
    for (std::size_t i = 256; i < page->bytes.size(); ++i) {
        small += page->bytes[i] <= 4;
    }
    EXPECT_GT(small, page->bytes.size() * 98 / 100) << "residuals of a plane are its roundings";
}

} // namespace page_heights_test
