// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/raster_files.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>

#include "scratch_folder.hpp"

namespace warp_to_grid_test {

using namespace thalweg;

namespace {

using test::full_message_of;
using test::has;

Raster<float> plane(Grid const& grid, double east, double south) {
    return test::raster_of(grid, [&](Cell c) {
        Vec2 const p = grid.centre(c);
        return 100.0 + east * (p.x - grid.west) + south * (grid.north - p.y);
    });
}

Grid const utm{40, 30, 30.0, 500000.0, 4000000.0, "EPSG:32631"};

} // namespace

TEST(WarpToGrid, LeavesWhatFits) {
    Raster<float> dem = plane(utm, 0.1, 0.2);
    dem[7] = std::numeric_limits<float>::quiet_NaN();
    Grid elsewhere = utm;
    elsewhere.west = 0.123;
    Raster<float> const same = io::warp_to_grid(dem, elsewhere, "test");
    EXPECT_EQ(same.grid(), utm);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        EXPECT_TRUE(same[i] == dem[i] || i == 7);
    }
    // Two without a CRS share their coordinates.
    Grid bare = utm;
    bare.crs = "";
    EXPECT_EQ(io::warp_to_grid(plane(bare, 0, 0), bare, "test").grid(), bare);
}

TEST(WarpToGrid, RefusesWhereOnlyOneSideHasACrs) {
    Grid bare = utm;
    bare.crs = "";
    auto const text = full_message_of<BadInput>([&] { io::warp_to_grid(plane(utm, 0, 0), bare, "io.test: a.tif"); });
    EXPECT_TRUE(has(text, "io.test: a.tif has EPSG:32631, the grid has no CRS")) << text;
    EXPECT_TRUE(has(full_message_of<BadInput>([&] { io::warp_to_grid(plane(bare, 0, 0), utm, "a"); }),
                    "a has no CRS, the grid has"));
}

TEST(WarpToGrid, OtherCellsLieOnTheGridsLattice) {
    Grid fine = utm;
    fine.cell_m = 10.0;
    fine.west += 7.0;
    fine.width = 90;
    fine.height = 60;
    for (std::string const crs : {"EPSG:32631", ""}) {
        fine.crs = crs;
        Grid grid = utm;
        grid.crs = crs;
        Raster<float> const dem = io::warp_to_grid(plane(fine, 0.1, 0.2), grid, "test");
        EXPECT_EQ(dem.grid().cell_m, 30.0);
        EXPECT_EQ(std::fmod(dem.grid().west - grid.west, 30.0), 0.0);
        EXPECT_EQ(std::fmod(dem.grid().north - grid.north, 30.0), 0.0);
        std::int64_t known = 0;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Vec2 const p = dem.grid().centre(dem.grid().at(i));
            double const inside = 45.0; // what a mean of 3 x 3 cells reaches
            if (p.x > fine.west + inside && p.x < fine.east() - inside && p.y < fine.north - inside &&
                p.y > fine.south() + inside) {
                EXPECT_NEAR(dem[i], 100.0 + 0.1 * (p.x - fine.west) + 0.2 * (fine.north - p.y), 0.02);
                ++known;
            }
        }
        EXPECT_GT(known, 300);
    }
}

TEST(WarpToGrid, RealLandComesIntoItsZone) {
    Raster<float> const srtm = io::read_dem(THALWEG_SOURCE_DIR "/samples/jacksboro_srtm3.tif");
    EXPECT_EQ(io::metric_crs(srtm.grid(), "srtm"), "EPSG:32616");
    Grid const grid{400, 300, 90.0, 737000.0, 4060000.0, "EPSG:32616"};
    EXPECT_TRUE(io::overlap_on_earth(srtm.grid(), grid, "a", "b"));
    EXPECT_FALSE(io::overlap_on_earth(srtm.grid(), utm, "a", "b"));
    Raster<float> const dem = io::warp_to_grid(srtm, grid, "test");
    EXPECT_EQ(dem.grid().crs, "EPSG:32616");
    // 403 x 344 cells of 3 seconds are about 30 x 32 km.
    EXPECT_NEAR(static_cast<double>(dem.width()) * 90.0, 31500.0, 1200.0);
    EXPECT_NEAR(static_cast<double>(dem.height()) * 90.0, 32900.0, 1200.0);
    double mean = 0.0;
    double count = 0.0;
    double own = 0.0;
    for (float const z : dem.values()) {
        mean += std::isnan(z) ? 0.0 : z;
        count += std::isnan(z) ? 0.0 : 1.0;
    }
    for (float const z : srtm.values()) {
        own += z;
    }
    EXPECT_NEAR(mean / count, own / static_cast<double>(srtm.cells()), 1.0);
    EXPECT_TRUE(std::isnan(dem[0])); // the corners are turned: there is no data
}

TEST(WarpToGrid, WhatWouldNotFitInMemoryIsRefused) {
    Grid tiny = utm;
    tiny.cell_m = 1e-6;
    EXPECT_TRUE(has(full_message_of<BadInput>([&] { io::warp_to_grid(plane(utm, 0, 0), tiny, "a"); }),
                    "more than memory holds"));
}

TEST(WarpToGrid, CellsTooSmallForTheirPositionAreRefused) {
    Grid tiny = utm;
    for (double const cell : {1e-16, 1e-300}) {
        tiny.cell_m = cell;
        EXPECT_THROW(io::warp_to_grid(plane(utm, 0.1, 0.2), tiny, "test"), BadInput) << cell;
        Raster<float> const speck = io::warp_to_grid(plane(tiny, 0.1, 0.2), utm, "test"); // smaller than a cell
        EXPECT_EQ(speck.cells(), 1) << cell;
        EXPECT_EQ(speck.grid().cell_m, utm.cell_m);
    }
}

TEST(SameFrame, ComparesCrsAndCells) {
    Raster<float> const dem = plane(utm, 0, 0);
    EXPECT_TRUE(io::same_crs("EPSG:32631", "EPSG:32631", "a", "b"));
    EXPECT_FALSE(io::same_crs("EPSG:32631", "EPSG:32632", "a", "b"));
    EXPECT_TRUE(io::same_crs("EPSG:32631+5773", "EPSG:32631", "a", "b")); // heights above the geoid: the same plan
    EXPECT_TRUE(io::same_crs("", "", "a", "b"));
    EXPECT_THROW(io::same_crs("nonsense", "EPSG:32631", "a", "b"), BadInput);
    Grid other = utm;
    other.west += 0.2;
    EXPECT_TRUE(io::same_cells(utm, other));
    other.west += 2.0;
    EXPECT_FALSE(io::same_cells(utm, other));
    other = utm;
    other.cell_m *= 1.001;
    EXPECT_FALSE(io::same_cells(utm, other));
    EXPECT_FALSE(io::same_size(utm, other));
    EXPECT_TRUE(io::same_size(utm, utm));
    EXPECT_TRUE(io::overlap_on_earth(utm, utm, "a", "b"));
    EXPECT_EQ(io::metric_crs(utm, "a"), "EPSG:32631");
    // Across the antimeridian, from either side.
    Grid const fiji{10, 10, 0.2, 179.0, -16.0, "EPSG:4326"};
    Grid const beyond{10, 10, 0.1, -180.0, -16.5, "EPSG:4326"};
    EXPECT_TRUE(io::overlap_on_earth(fiji, beyond, "a", "b"));
    EXPECT_TRUE(io::overlap_on_earth(beyond, fiji, "a", "b"));
    Grid nowhere = utm;
    nowhere.west = 1e300;
    EXPECT_TRUE(has(full_message_of<BadInput>([&] { io::overlap_on_earth(utm, nowhere, "a.tif", "b.tif"); }),
                    "b.tif lies where"));
}

TEST(ReadMask, TakesCellsThatAreNeitherZeroNorNoData) {
    ScratchFolder const folder;
    Raster<float> values(utm);
    values[3] = 1.0F;
    values[4] = -2.5F;
    values[5] = std::numeric_limits<float>::quiet_NaN();
    io::write_dem(values, folder / "a.tif");
    Mask const mask = io::read_mask(folder / "a.tif", utm);
    EXPECT_EQ(mask.grid(), utm);
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        EXPECT_EQ(mask[i], i == 3 || i == 4 ? 1 : 0);
    }
    io::write_mask(mask, folder / "b.tif");
    Mask const again = io::read_mask(folder / "b.tif", utm);
    EXPECT_EQ(again[3] + again[4], 2);
    Grid other = utm;
    other.width = 41;
    EXPECT_TRUE(has(full_message_of<BadInput>([&] { io::read_mask(folder / "b.tif", other); }), "40 x 30 cells"));
    other = utm;
    other.crs = "EPSG:32632";
    auto const text = full_message_of<BadInput>([&] { io::read_mask(folder / "b.tif", other); });
    EXPECT_TRUE(has(text, "is in EPSG:32631, the grid in EPSG:32632")) << text;
    other.crs = "";
    EXPECT_TRUE(has(full_message_of<BadInput>([&] { io::read_mask(folder / "b.tif", other); }), "the grid has no CRS"));
    EXPECT_TRUE(has(full_message_of<BadInput>([&] { io::read_mask(folder / "c.tif", utm); }), "does not exist"));
}

} // namespace warp_to_grid_test
