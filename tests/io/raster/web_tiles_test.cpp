// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/web_tiles.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace web_tiles_test {

using namespace thalweg;

namespace {

constexpr double half_world_m = 20037508.342789244;

/// A band of a PNG as GDAL reads it.
std::vector<std::uint8_t> band_of(std::string const& path, int side, int bands, int band) {
    GDALAllRegister();
    auto* const file = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_ReadOnly));
    EXPECT_NE(file, nullptr) << path;
    EXPECT_EQ(file->GetRasterXSize(), side);
    EXPECT_EQ(file->GetRasterYSize(), side);
    EXPECT_EQ(file->GetRasterCount(), bands);
    std::vector<std::uint8_t> values(static_cast<std::size_t>(side * side));
    EXPECT_EQ(file->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, side, side, values.data(), side, side, GDT_Byte, 0, 0,
                                                  nullptr),
              CE_None);
    GDALClose(file);
    return values;
}

std::vector<double> heights_of(std::string const& path) {
    std::vector<std::uint8_t> const r = band_of(path, 256, 3, 1);
    std::vector<std::uint8_t> const g = band_of(path, 256, 3, 2);
    std::vector<std::uint8_t> const b = band_of(path, 256, 3, 3);
    std::vector<double> z(r.size());
    for (std::size_t i = 0; i < z.size(); ++i) {
        z[i] = -10000.0 + 0.1 * (65536.0 * r[i] + 256.0 * g[i] + b[i]);
    }
    return z;
}

/// A picture of one colour, as PNG.
std::string picture(int width, int height) {
    GDALAllRegister();
    GDALDriverManager& drivers = *GetGDALDriverManager();
    GDALDataset* const memory = drivers.GetDriverByName("MEM")->Create("", width, height, 3, GDT_Byte, nullptr);
    for (int band = 1; band <= 3; ++band) {
        memory->GetRasterBand(band)->Fill(50.0 * band);
    }
    std::string const path = "/vsimem/web_tiles_test.png";
    GDALClose(drivers.GetDriverByName("PNG")->CreateCopy(path.c_str(), memory, TRUE, nullptr, nullptr, nullptr));
    GDALClose(memory);
    vsi_l_offset size = 0;
    GByte const* const bytes = VSIGetMemFileBuffer(path.c_str(), &size, FALSE);
    std::string out(reinterpret_cast<char const*>(bytes), static_cast<std::size_t>(size));
    VSIUnlink(path.c_str());
    return out;
}

Grid frame(std::int64_t width, std::int64_t height, std::string const& crs) {
    Grid grid = test::frame(width, height, 30.0);
    grid.west = 500000.0;
    grid.north = 4400000.0;
    grid.crs = crs;
    return grid;
}

float plane_at(Vec2 p) {
    return static_cast<float>(300.0 + 0.02 * (p.x - 500000.0) + 0.05 * (p.y - 4400000.0));
}

struct Tiles {
    ScratchFolder folder;
    io::WebPyramid pyramid;
    std::vector<std::string> names;

    Tiles(Raster<float> const& dem, Mask const& shown, Run const& run = {}, io::WebPyramidParams const& params = {})
        : pyramid(io::web_pyramid(dem.grid(), params)) {
        io::OutputFolder out(folder / "web");
        names = io::write_web_tiles({dem, shown, picture(300, 200)}, pyramid, out, run);
        EXPECT_EQ(out.files(), names);
        out.commit();
    }
    std::string operator/(std::string const& name) const { return folder / ("web/" + name); }
    std::string tile(char const* kind, std::int64_t zoom, std::int64_t column, std::int64_t row) const {
        return *this / (std::string(kind) + "/" + std::to_string(zoom) + "/" + std::to_string(column) + "/" +
                        std::to_string(row) + ".png");
    }
    /// Calls take(place [m, EPSG:3857], height) for every sample of a level.
    void each_height(std::int64_t zoom, auto take) const {
        io::WebTileRange const at = io::web_tiles_at(pyramid, zoom);
        double const sample = 2.0 * half_world_m / static_cast<double>(std::int64_t{256} << zoom);
        for (std::int64_t c = at.west; c <= at.east; ++c) {
            for (std::int64_t r = at.north; r <= at.south; ++r) {
                std::vector<double> const z = heights_of(tile("heights", zoom, c, r));
                for (std::int64_t i = 0; i < 65536; ++i) {
                    take(Vec2{(static_cast<double>(256 * c + i % 256) + 0.5) * sample - half_world_m,
                              half_world_m - (static_cast<double>(256 * r + i / 256) + 0.5) * sample},
                         z[static_cast<std::size_t>(i)]);
                }
            }
        }
    }
};

Raster<float> plane(Grid const& grid) {
    Raster<float> dem(grid);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = plane_at(grid.centre(grid.at(i)));
    }
    return dem;
}

} // namespace

TEST(WebTiles, APlaneIsThereAtEveryLevelAndGoesOnLevelAtItsRim) {
    // Without CRS the sampled place is known without PROJ.
    Raster<float> const dem = plane(frame(300, 200, ""));
    Tiles const tiles(dem, Mask(dem.grid(), 1));
    io::WebPyramid const& pyramid = tiles.pyramid;
    EXPECT_EQ(pyramid.max_zoom, pyramid.full_zoom);
    EXPECT_LT(pyramid.min_zoom, pyramid.max_zoom);
    EXPECT_EQ(static_cast<std::int64_t>(tiles.names.size()), pyramid.tiles);
    EXPECT_EQ(pyramid.grid.crs, "EPSG:3857");
    EXPECT_NEAR(pyramid.box.west, -pyramid.box.east, 1e-7);
    Grid const& grid = dem.grid();
    for (std::int64_t zoom = pyramid.min_zoom; zoom <= pyramid.max_zoom; ++zoom) {
        double const reach = 2.0 * half_world_m / static_cast<double>(std::int64_t{256} << zoom); // of a mean
        std::int64_t inside = 0;
        tiles.each_height(zoom, [&](Vec2 at, double z) {
            Vec2 const p = at - pyramid.shift;
            Vec2 const kept{std::clamp(p.x, grid.west + 15.0, grid.east() - 15.0),
                            std::clamp(p.y, grid.south() + 15.0, grid.north - 15.0)};
            bool const is_off_rim =
                std::min({std::fabs(p.x - grid.west), std::fabs(p.x - grid.east()), std::fabs(p.y - grid.north),
                          std::fabs(p.y - grid.south())}) > reach + 30.0;
            if (is_off_rim) {
                ASSERT_NEAR(z, static_cast<double>(plane_at(kept)), 0.051) << p.x << ' ' << p.y << " at " << zoom;
                inside += p == kept ? 1 : 0;
            }
        });
        EXPECT_GT(inside, 50);
    }
}

TEST(WebTiles, OfAProjectionTheyLieWhereTheirCornersAre) {
    Raster<float> const dem = plane(frame(300, 200, "EPSG:32616"));
    Tiles const tiles(dem, Mask(dem.grid(), 1));
    // In the middle of zone 16 the grid's west edge is the meridian of 87 degrees west.
    EXPECT_NEAR(tiles.pyramid.box.west, -87.0, 1e-6);
    double const metres_of_degree = half_world_m / 180.0;
    double nearest = 1e9;
    double z_there = 0.0;
    std::vector<std::vector<Vec2>> const middle =
        io::lines_in_degrees({{dem.grid().centre({150, 100})}}, tiles.pyramid);
    tiles.each_height(tiles.pyramid.max_zoom, [&](Vec2 at, double z) {
        // At one latitude samples of a row differ by longitude alone.
        double const off = std::fabs(at.x - middle[0][0].x * metres_of_degree) +
                           std::fabs(at.y - 0.5 * (tiles.pyramid.low.y + tiles.pyramid.high.y));
        if (off < nearest) {
            nearest = off;
            z_there = z;
        }
    });
    EXPECT_NEAR(z_there, static_cast<double>(plane_at(dem.grid().centre({150, 100}))), 2.5);
}

TEST(WebTiles, ColoursAreThoseOfThePictureWhereCellsAreShown) {
    Raster<float> const dem = plane(frame(300, 200, ""));
    Mask shown(dem.grid(), 1);
    for (std::int64_t row = 0; row < 200; ++row) {
        std::ranges::fill(shown.row(row).first(150), std::uint8_t{0});
    }
    Tiles const tiles(dem, shown);
    io::WebTileRange const at = io::web_tiles_at(tiles.pyramid, tiles.pyramid.max_zoom);
    std::int64_t seen = 0;
    std::int64_t hidden = 0;
    double const sample = 2.0 * half_world_m / static_cast<double>(std::int64_t{512} << tiles.pyramid.max_zoom);
    for (std::int64_t c = at.west; c <= at.east; ++c) {
        for (std::int64_t r = at.north; r <= at.south; ++r) {
            std::string const path = tiles.tile("colour", tiles.pyramid.max_zoom, c, r);
            std::vector<std::uint8_t> const green = band_of(path, 512, 4, 2);
            std::vector<std::uint8_t> const alpha = band_of(path, 512, 4, 4);
            for (std::int64_t i = 0; i < 512 * 512; ++i) {
                double const x = (static_cast<double>(512 * c + i % 512) + 0.5) * sample - half_world_m;
                auto const k = static_cast<std::size_t>(i);
                if (alpha[k] == 255) {
                    ASSERT_EQ(green[k], 100);
                    ASSERT_GT(x, -1e-6); // the middle of the grid is at 0
                    ++seen;
                } else {
                    ASSERT_EQ(alpha[k], 0);
                    ++hidden;
                }
            }
        }
    }
    double const share = 150.0 * 30.0 * 200.0 * 30.0 / (sample * sample);
    EXPECT_NEAR(static_cast<double>(seen), share, 0.02 * share);
    EXPECT_GT(hidden, seen);
}

TEST(WebTiles, AreTheSameForAnyNumberOfThreads) {
    Raster<float> const dem = plane(frame(120, 90, "EPSG:32616"));
    thalweg::Run one;
    one.threads = 1;
    thalweg::Run three;
    three.threads = 3;
    Tiles const a(dem, Mask(dem.grid(), 1), one);
    Tiles const b(dem, Mask(dem.grid(), 1), three);
    ASSERT_EQ(a.names, b.names);
    for (std::string const& name : a.names) {
        EXPECT_EQ(test::bytes_of(a / name), test::bytes_of(b / name)) << name;
    }
}

TEST(WebTiles, LimitsLeaveOutTheDeepestLevels) {
    Grid const grid = frame(3000, 2000, "EPSG:32616");
    io::WebPyramid const whole = io::web_pyramid(grid);
    io::WebPyramid const less = io::web_pyramid(grid, {.most_tiles = whole.tiles - 1});
    EXPECT_EQ(less.max_zoom, whole.max_zoom - 1);
    EXPECT_EQ(less.full_zoom, whole.full_zoom);
    io::WebPyramid const least = io::web_pyramid(grid, {.most_zoom = 3, .most_tiles = 1});
    EXPECT_EQ(least.min_zoom, 1);
    EXPECT_EQ(least.max_zoom, 1);
    // Levels that are left out are still sampled: a level is the same with and without those below it.
    Raster<float> const dem = plane(frame(300, 200, ""));
    Tiles const all(dem, Mask(dem.grid(), 1));
    Tiles const some(dem, Mask(dem.grid(), 1), {}, {.most_zoom = all.pyramid.max_zoom - 1});
    ASSERT_LT(some.names.size(), all.names.size());
    for (std::string const& name : some.names) {
        EXPECT_EQ(test::bytes_of(some / name), test::bytes_of(all / name)) << name;
    }
}

TEST(WebTiles, WhatHasNoPlaceOnAWebMapIsRefused) {
    EXPECT_THROW(io::web_pyramid(frame(0, 3, "")), BadInput);
    EXPECT_THROW(io::web_pyramid(frame(3, 3, "EPSG:1")), BadInput);
    Grid polar = frame(100, 100, "EPSG:3413");
    polar.west = polar.north = 0.0;
    EXPECT_THROW(io::web_pyramid(polar), BadInput);
    Grid turning = frame(2000, 100, "EPSG:32601");
    turning.west = 320000.0;
    turning.north = 7000000.0;
    EXPECT_THROW(io::web_pyramid(turning), BadInput);
    Raster<float> dem = plane(frame(20, 20, ""));
    dem[7] = std::numeric_limits<float>::quiet_NaN();
    ScratchFolder const folder;
    io::OutputFolder const out(folder / "web");
    Mask const shown(dem.grid(), 1);
    EXPECT_THROW(io::write_web_tiles({dem, shown, picture(20, 20)}, io::web_pyramid(dem.grid()), out), BadInput);
    dem[7] = 0.0F;
    EXPECT_THROW(io::write_web_tiles({dem, shown, "no picture"}, io::web_pyramid(dem.grid()), out), Error);
}

} // namespace web_tiles_test
