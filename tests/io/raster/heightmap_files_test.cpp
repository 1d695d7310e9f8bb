// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/sources/sources.hpp>

namespace heightmap_files_test {

using namespace thalweg;

namespace {

void write_bytes(std::string const& path, std::string const& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// Numbers of 16 bits, little-endian.
std::string numbers(std::vector<int> const& of) {
    std::string bytes;
    for (int const n : of) {
        bytes += static_cast<char>(n & 0xFF);
        bytes += static_cast<char>(n >> 8);
    }
    return bytes;
}

std::string const described = R"({"thalweg": "1", "format": "r16", "width": 3, "height": 2, "min_m": 100.0,
    "metres_per_step": 0.5, "step_m": [10.0, 10.0], "north_west": [500005.0, 4000015.0], "crs": "EPSG:32631"})";

} // namespace

TEST(HeightmapFiles, WithoutADescriptionAreSquaresOfMetres) {
    ScratchFolder const folder;
    write_bytes(folder / "a.r16", numbers({0, 1, 2, 65535}));
    io::DemFile const read = io::read_dem_file(folder / "a.r16");
    EXPECT_EQ(read.dem.width(), 2);
    EXPECT_EQ(read.dem[1], 1.0F);
    EXPECT_EQ(read.dem[3], 65535.0F);
    ASSERT_EQ(read.findings.size(), 1U);
    EXPECT_TRUE(test::has(read.findings[0].text, "2 x 2 samples", "count as metres", "--raw-heights", "--raw-cell"));
    EXPECT_EQ(io::content_of(folder / "a.r16").kind, io::FileContent::Kind::raster);
}

TEST(HeightmapFiles, OptionsNameSizeHeightsAndDistance) {
    ScratchFolder const folder;
    write_bytes(folder / "a.RAW", numbers({0, 13107, 26214, 39321, 52428, 65535}));
    io::ReadDemParams params;
    params.raw_width = 3;
    params.raw_height = 2;
    params.raw_cell_m = 30.0;
    params.raw_heights = std::pair{-50.0, 50.0};
    Raster<float> const dem = io::read_dem(folder / "a.RAW", params);
    EXPECT_EQ(dem.grid().cell_m, 30.0);
    EXPECT_EQ(dem.grid().north, 60.0);
    for (std::int64_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(dem[i], -50.0 + 20.0 * static_cast<double>(i), 1e-4);
    }
}

TEST(HeightmapFiles, ADescriptionNamesHeightsAndPlace) {
    ScratchFolder const folder;
    write_bytes(folder / "a.r16", numbers({0, 2, 4, 6, 8, 65535}));
    write_bytes(folder / "a.r16.json", described);
    Raster<float> const dem = io::read_dem(folder / "a.r16");
    EXPECT_EQ(dem.grid().crs, "EPSG:32631");
    EXPECT_EQ(dem.grid().west, 500000.0);
    EXPECT_EQ(dem.grid().north, 4000020.0);
    EXPECT_EQ(dem[1], 101.0F);
    EXPECT_EQ(dem[5], 100.0F + 0.5F * 65535.0F);
    EXPECT_EQ(io::dataset_files(folder / "a.r16"), (std::vector<std::string>{folder / "a.r16", folder / "a.r16.json"}));
}

TEST(HeightmapFiles, DescriptionsOfOtherProgramsArePassedOver) {
    ScratchFolder const folder;
    write_bytes(folder / "a.r16", numbers({0, 2, 4, 6}));
    for (std::string const text : {"", "no json", "[1, 2]", R"({"width": 7})", R"({"thalweg": 1, "format": 7})"}) {
        write_bytes(folder / "a.r16.json", text);
        EXPECT_EQ(io::read_dem(folder / "a.r16").width(), 2) << text;
    }
}

TEST(HeightmapFiles, WrongSizesAreRefused) {
    ScratchFolder const folder;
    write_bytes(folder / "a.r16", numbers({0, 2, 4, 6, 8}));
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { io::read_dem(folder / "a.r16"); }), "10 bytes", "no square",
                          "--raw-size"));
    write_bytes(folder / "a.r16.json", described);
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { io::read_dem(folder / "a.r16"); }), "3 x 2 samples", "12",
                          "a.r16.json"));
    write_bytes(folder / "b.r32", "123");
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { io::read_dem(folder / "b.r32"); }), "3 bytes"));
    write_bytes(folder / "empty.r16", "");
    EXPECT_FALSE(test::message_of<Error>([&] { io::read_dem(folder / "empty.r16"); }).empty());
    write_bytes(folder / "c.exr", std::string("\x76\x2f\x31\x01", 4) + "nothing else");
    EXPECT_FALSE(test::message_of<Error>([&] { io::read_dem(folder / "c.exr"); }).empty());
}

} // namespace heightmap_files_test
