// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/dem_derivatives.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/crossings.hpp>
#include <thalweg/geometry/polylines.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>

#include "full_disk.hpp"
#include "tiff.hpp"
#include "vector_files.hpp"

namespace raster_files_test {

using namespace thalweg;

namespace {

using test::error_of;
using test::has;
using test::on_threads;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

Raster<float> raster(std::int64_t width, std::int64_t height, std::function<double(Cell)> const& z) {
    return test::raster_of({width, height, 10.0, 500000.0, 4000000.0, "EPSG:32631"}, z);
}

bool same_bits(std::span<float const> a, std::span<float const> b) {
    return std::ranges::equal(
        a, b, [](float p, float q) { return (std::isnan(p) && std::isnan(q)) || std::memcmp(&p, &q, sizeof p) == 0; });
}

} // namespace

TEST(WriteDem, RefusalsOfEveryWriter) {
    using Write = std::function<void(Grid const&, std::string const& path, thalweg::Run const&)>;
    auto const height = [](Cell c) { return std::sqrt(static_cast<double>(c.col * c.row)); };
    auto const noise = [](Cell c) {
        auto const k = static_cast<std::uint64_t>(700 * c.row + c.col + 77);
        return (k * k * 2654435761U) >> 21U & 1U; // nothing to compress
    };
    std::vector<Write> const writers{[&](Grid const& grid, std::string const& path, thalweg::Run const& run) {
                                         io::write_dem(test::raster_of(grid, height), path, run);
                                     },
                                     [&](Grid const& grid, std::string const& path, thalweg::Run const& run) {
                                         io::write_mask(test::raster_of<std::uint8_t>(grid, noise), path, run);
                                     },
                                     [&](Grid const& grid, std::string const& path, thalweg::Run const& run) {
                                         io::write_field(test::raster_of<double>(grid, height), path, run);
                                     }};
    for (Write const& write : writers) {
        ScratchFolder const folder;
        Grid const grid{700, 600, 10.0, 500000.0, 4000000.0, "EPSG:32631"};
        EXPECT_THROW(write({}, folder / "a.tif", {}), BadInput);
        EXPECT_THROW(write(grid, folder / "none/a.tif", {}), IoError);
        EXPECT_EQ(folder.entries(), 0);
        folder.write("mine.tif", "mine");
        EXPECT_THROW(write(grid, folder / "mine.tif", {}), IoError);
        EXPECT_EQ(bytes_of(folder / "mine.tif"), "mine");
        EXPECT_THROW(write(grid, folder / "b.tif", test::stopped_run()), Cancelled);
        for (rlim_t const bytes : {100U, 5000U}) {
            FullDisk const full(bytes);
            EXPECT_THROW(write(grid, folder / (std::to_string(bytes) + ".tif"), {}), IoError) << bytes;
        }
    }
}

TEST(WriteDem, HeightsThatCannotBeStoredAreNamed) {
    ScratchFolder const folder;
    for (float const bad :
         {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), -9999.0F}) {
        Raster<float> dem = raster(3, 2, [](Cell) { return 1.0; });
        dem[Cell{2, 1}] = bad;
        EXPECT_TRUE(has(error_of([&] { io::write_dem(dem, folder / "dem.tif"); }), "BadInput", "column 2, row 1"))
            << bad;
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WriteDem, IsATiledDeflatedCog) {
    ScratchFolder const folder;
    io::write_dem(
        raster(1200, 700, [](Cell c) { return c.row == 3 ? none : 0.1 * static_cast<double>(c.col + c.row); }),
        folder / "dem.tif");
    auto const dataset = opened(folder / "dem.tif");
    ASSERT_EQ(dataset->GetRasterCount(), 1);
    EXPECT_STREQ(dataset->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
    EXPECT_STREQ(dataset->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
    EXPECT_STREQ(dataset->GetMetadataItem("PREDICTOR", "IMAGE_STRUCTURE"), "3");
    EXPECT_STREQ(dataset->GetSpatialRef()->GetAuthorityCode(nullptr), "32631");
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    EXPECT_EQ(band.GetRasterDataType(), GDT_Float32);
    EXPECT_EQ(band.GetNoDataValue(), -9999.0);
    EXPECT_GE(band.GetOverviewCount(), 1);
    int block_width = 0;
    int block_height = 0;
    band.GetBlockSize(&block_width, &block_height);
    EXPECT_EQ(block_width, 512);
    EXPECT_EQ(block_height, 512);
    std::array<double, 6> place{};
    dataset->GetGeoTransform(place.data());
    EXPECT_EQ(place, (std::array<double, 6>{500000.0, 10.0, 0.0, 4000000.0, 0.0, -10.0}));
}

// Law: the same bytes for the same raster and any number of threads.
TEST(WriteDem, SameBytesForAnyNumberOfThreads) {
    ScratchFolder const folder;
    Raster<float> const dem = raster(2100, 1700, [](Cell c) {
        return c.col % 97 == 0 ? none : std::sqrt(static_cast<double>(c.col * 3 + c.row * c.row));
    });
    Mask mask(dem.grid());
    for (std::int64_t i = 0; i < mask.cells(); i += 1 + i % 7) {
        mask[i] = 1;
    }
    for (int const threads : {1, 2, 8}) {
        thalweg::Run const run = on_threads(threads);
        io::write_dem(dem, folder / ("dem" + std::to_string(threads)), run);
        io::write_mask(mask, folder / ("mask" + std::to_string(threads)), run);
    }
    EXPECT_TRUE(bytes_of(folder / "dem1") == bytes_of(folder / "dem2"));
    EXPECT_TRUE(bytes_of(folder / "dem1") == bytes_of(folder / "dem8"));
    EXPECT_TRUE(bytes_of(folder / "mask1") == bytes_of(folder / "mask8"));
    EXPECT_EQ(folder.entries(), 6);
}

// Law: heights, gaps and frame are read back bit for bit.
TEST(WriteDem, RoundTripIsExact) {
    ASSERT_TRUE(rc::check([] {
        Grid const grid{*rc::gen::inRange<std::int64_t>(1, 40),
                        *rc::gen::inRange<std::int64_t>(1, 40),
                        *rc::gen::elementOf(std::vector<double>{1.0, 0.1, 30.0, 1.0 / 3.0}),
                        static_cast<double>(*rc::gen::inRange(-1000000, 1000000)) / 7.0,
                        4000000.25,
                        "EPSG:32631"};
        auto const heights = *rc::gen::container<std::vector<int>>(static_cast<std::size_t>(grid.cells()),
                                                                   rc::gen::inRange(-1000000, 9000000));
        Raster<float> dem(grid);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            int const height = heights[static_cast<std::size_t>(i)];
            dem[i] = height % 5 == 0 ? none : static_cast<float>(height) / 1000.7F;
        }
        dem[0] = -0.0F;
        ScratchFolder const folder;
        io::write_dem(dem, folder / "dem.tif");
        Raster<float> const read = io::read_dem(folder / "dem.tif");
        RC_ASSERT(read.grid() == grid);
        RC_ASSERT(same_bits(read.values(), dem.values()));
    }));
}

TEST(WriteDem, MaskIsAByteGeoTiff) {
    ScratchFolder const folder;
    Mask mask(Grid{300, 5, 2.5, 1.0, 2.0, "EPSG:32631"});
    mask[Cell{299, 4}] = 1;
    mask[Cell{0, 1}] = 1;
    io::write_mask(mask, folder / "network.tif");
    auto const dataset = opened(folder / "network.tif");
    EXPECT_STREQ(dataset->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
    EXPECT_STREQ(dataset->GetSpatialRef()->GetAuthorityCode(nullptr), "32631");
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    EXPECT_EQ(band.GetRasterDataType(), GDT_Byte);
    int block_width = 0;
    int block_height = 0;
    band.GetBlockSize(&block_width, &block_height);
    EXPECT_EQ(block_width, 256);
    EXPECT_EQ(block_height, 256);
    std::vector<std::uint8_t> cells(1500);
    ASSERT_EQ(band.RasterIO(GF_Read, 0, 0, 300, 5, cells.data(), 300, 5, GDT_Byte, 0, 0, nullptr), CE_None);
    EXPECT_TRUE(std::ranges::equal(cells, mask.values()));
}

TEST(DatasetFiles, WhatACompanionNamesElsewhereIsNoneOfThem) {
    ScratchFolder const folder;
    ScratchFolder const elsewhere;
    auto const seven = [](int, int) { return 7.0; };
    std::string const secret = written(elsewhere / "hand.tif", Tiff{}, seven);
    std::string const path = written(folder / "hand.tif", Tiff{}, seven);
    folder.write("hand.tif.ovr", "<VRTDataset rasterXSize='2' rasterYSize='2'><VRTRasterBand dataType='Float32' "
                                 "band='1'><SimpleSource><SourceFilename relativeToVRT='0'>" +
                                     secret + "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>");
    EXPECT_TRUE(std::ranges::count(io::dataset_files(path), path));
    for (std::string const& file : io::dataset_files({path, io::Access::recipe})) {
        EXPECT_TRUE(has(file, folder.path().string()));
    }
}

TEST(Hillshade, DegenerateRasters) {
    EXPECT_THROW(io::hillshade(Raster<float>()), BadInput);
    EXPECT_THROW(io::hillshade(raster(3, 3, [](Cell) { return 1.0; }), 0.0), BadParameter);
    EXPECT_THROW(io::hillshade(raster(3, 3, [](Cell) { return 1.0; }), none), BadParameter);
    for (auto const& [width, height] : {std::pair{1, 1}, std::pair{1, 5}, std::pair{5, 1}, std::pair{2, 2}}) {
        auto const shade = io::hillshade(raster(width, height, [](Cell) { return 1.0; }));
        EXPECT_EQ(shade.cells(), width * height);
    }
}

TEST(Hillshade, FlatGroundIsEvenAndGapsAreZero) {
    auto const shade = io::hillshade(raster(9, 7, [](Cell c) { return c == Cell{4, 3} ? none : 5.0; }));
    for (std::int64_t i = 0; i < shade.cells(); ++i) {
        // The light comes from 45 degrees: 1 + 254 sin 45.
        EXPECT_EQ(shade[i], shade.grid().at(i) == (Cell{4, 3}) ? 0 : 181) << i;
    }
}

TEST(Hillshade, LightComesFromTheNorthWest) {
    auto const facing = io::hillshade(raster(9, 9, [](Cell c) { return 3.0 * static_cast<double>(c.col + c.row); }));
    auto const averted = io::hillshade(raster(9, 9, [](Cell c) { return -3.0 * static_cast<double>(c.col + c.row); }));
    auto const steeper =
        io::hillshade(raster(9, 9, [](Cell c) { return -3.0 * static_cast<double>(c.col + c.row); }), 3.0);
    auto const all_round = io::hillshade(raster(9, 9, [](Cell c) { return -3.0 * static_cast<double>(c.col + c.row); }),
                                         3.0, io::Light::multidirectional);
    Cell const middle{4, 4};
    EXPECT_GT(facing[middle], averted[middle]);
    EXPECT_GT(averted[middle], steeper[middle]);
    EXPECT_GT(all_round[middle], steeper[middle]);
}

TEST(Contours, DegenerateInput) {
    Raster<float> const dem = raster(3, 3, [](Cell c) { return static_cast<double>(c.col); });
    EXPECT_THROW(io::contours(Raster<float>(), 1.0), BadInput);
    EXPECT_THROW(io::contours(dem, 0.0), BadParameter);
    EXPECT_THROW(io::contours(dem, -1.0), BadParameter);
    EXPECT_THROW(io::contours(dem, none), BadParameter);
    EXPECT_THROW(io::contours(dem, 1e-7), BadParameter);
    EXPECT_TRUE(io::contours(raster(4, 4, [](Cell) { return 5.5; }), 1.0).empty());
    EXPECT_TRUE(io::contours(raster(4, 4, [](Cell) { return none; }), 1.0).empty());
    EXPECT_TRUE(io::contours(raster(1, 1, [](Cell) { return 5.5; }), 1.0).empty());
    // A summit as high as a contour has no ring of a hair's breadth.
    auto const cone = io::contours(raster(9, 9,
                                          [](Cell c) {
                                              return 10.0 - std::hypot(static_cast<double>(c.col) - 4.0,
                                                                       static_cast<double>(c.row) - 4.0);
                                          }),
                                   2.0);
    EXPECT_EQ(std::ranges::count(cone, 10.0, &io::ContourLine::z), 0);
    EXPECT_EQ(std::ranges::count(cone, 8.0, &io::ContourLine::z), 1);
}

TEST(Contours, SimplifiedLinesCrossNeitherThemselvesNorOthers) {
    std::size_t lines_in_all = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Raster<float> const dem = raster(60, 60, [&](Cell c) {
            double const rough =
                unit(random_word(seed, static_cast<std::uint64_t>(c.col), static_cast<std::uint64_t>(c.row)));
            return 0.3 * static_cast<double>(c.col) + 3.0 * rough;
        });
        std::vector<std::vector<Vec2>> lines;
        std::vector<geometry::EndNodes> ends;
        for (io::ContourLine const& contour : io::contours(dem, 1.0)) {
            std::size_t const node = 2 * ends.size();
            ends.push_back({node, contour.line.front() == contour.line.back() ? node : node + 1});
            lines.push_back(contour.line);
        }
        for (auto const& m : geometry::meetings(lines, ends)) {
            bool const closes_ring = m.line == m.other && m.segment == 0 && m.at == lines[m.line].back();
            EXPECT_TRUE(closes_ring) << m.line << " and " << m.other << " at " << m.at.x << ", " << m.at.y << " of "
                                     << seed;
        }
        lines_in_all += lines.size();
    }
    EXPECT_GT(lines_in_all, 400U);
}

TEST(Contours, TheSmallestRingsStayRings) {
    for (double const above : {0.001, 0.01, 0.1, 0.5, 2.0}) { // rings of 0.0004 to 0.57 cells
        auto const lines = io::contours(raster(9, 9,
                                               [&](Cell c) {
                                                   return c == Cell{4, 4} ? 10.0 + above : 5.0;
                                               }),
                                        10.0);
        ASSERT_EQ(lines.size(), above > 0.3 ? 1U : 0U) << above;
        if (lines.empty()) {
            continue;
        }
        auto const& ring = lines[0].line;
        EXPECT_EQ(ring.front(), ring.back()) << above;
        EXPECT_GT(std::fabs(geometry::signed_area(ring)), 0.0) << above;
    }
}

TEST(Contours, PlaneHasStraightLinesAtMultiples) {
    // Height = column centre / 10 m + 0.25, so that level z lies at x = 10 (z + 0.25).
    auto const lines = io::contours(raster(20, 12, [](Cell c) { return static_cast<double>(c.col) + 0.25; }), 4.0);
    std::vector<double> levels;
    for (auto const& line : lines) {
        levels.push_back(line.z);
        ASSERT_GE(line.line.size(), 2U);
        for (Vec2 const p : line.line) {
            EXPECT_NEAR(p.x - 500000.0, 10.0 * (line.z + 0.25), 1e-3);
            EXPECT_LE(p.y, 4000000.0);
            EXPECT_GE(p.y, 4000000.0 - 120.0);
        }
    }
    std::ranges::sort(levels);
    EXPECT_EQ(levels, (std::vector<double>{4.0, 8.0, 12.0, 16.0}));
}

TEST(Contours, StopWhenAsked) {
    auto const slope = raster(50, 50, [](Cell c) { return static_cast<double>(c.col); });
    EXPECT_THROW(io::contours(slope, 1.0, test::stopped_run()), Cancelled);
}

TEST(Contours, GeoPackageMarksEveryFifth) {
    ScratchFolder const folder;
    auto const lines =
        io::contours(raster(30, 5, [](Cell c) { return static_cast<double>(c.col) - 14.7; }), 0.1 * 20.0);
    ASSERT_EQ(lines.size(), 15U);
    io::write_contours(lines, 2.0, "EPSG:32631", folder / "contours.gpkg");
    io::write_contours(lines, 2.0, "EPSG:32631", folder / "again.gpkg");
    io::write_contours({}, 2.0, "EPSG:32631", folder / "none.gpkg");
    EXPECT_THROW(io::write_contours(lines, 2.0, "EPSG:32631", folder / "contours.gpkg"), IoError);
    EXPECT_TRUE(bytes_of(folder / "contours.gpkg") == bytes_of(folder / "again.gpkg"));
    EXPECT_EQ(opened(folder / "none.gpkg")->GetLayerByName("contours")->GetFeatureCount(), 0);
    auto const dataset = opened(folder / "contours.gpkg");
    OGRLayer& layer = *dataset->GetLayerByName("contours");
    EXPECT_EQ(layer.GetGeomType(), wkbLineString25D);
    std::vector<double> marked;
    for (auto const& feature : layer) {
        double const z = feature->GetFieldAsDouble("z");
        EXPECT_EQ(feature->GetGeometryRef()->toLineString()->getZ(0), z);
        if (feature->GetFieldAsInteger("is_index") == 1) {
            marked.push_back(z);
        }
    }
    std::ranges::sort(marked);
    EXPECT_EQ(marked, (std::vector<double>{-10.0, 0.0, 10.0}));
}

TEST(WriteField, WritesDoublesExactly) {
    ScratchFolder const folder;
    Raster<double> field(Grid{300, 280, 10.0, 500000.0, 4000000.0, "EPSG:32631"});
    for (std::int64_t i = 0; i < field.cells(); ++i) {
        field[i] = static_cast<double>(i) / 3.0;
    }
    field[5] = std::numeric_limits<double>::quiet_NaN();
    thalweg::Run const one = on_threads(1);
    thalweg::Run const two = on_threads(2);
    io::write_field(field, folder / "field.tif", one);
    io::write_field(field, folder / "again.tif", two);
    EXPECT_TRUE(bytes_of(folder / "field.tif") == bytes_of(folder / "again.tif"));
    auto const dataset = opened(folder / "field.tif");
    GDALRasterBand& band = *dataset->GetRasterBand(1);
    EXPECT_EQ(band.GetRasterDataType(), GDT_Float64);
    EXPECT_EQ(band.GetNoDataValue(), -9999.0);
    std::vector<double> read(static_cast<std::size_t>(field.cells()));
    ASSERT_EQ(band.RasterIO(GF_Read, 0, 0, 300, 280, read.data(), 300, 280, GDT_Float64, 0, 0, nullptr), CE_None);
    field[5] = -9999.0;
    EXPECT_TRUE(std::ranges::equal(read, field.values()));
    EXPECT_THROW(io::write_field(field, folder / "third.tif"), BadInput);
}

} // namespace raster_files_test
