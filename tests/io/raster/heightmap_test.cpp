// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/heightmap.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace heightmap_test {

using namespace thalweg;

namespace {

Raster<float> slope() {
    return test::raster_of(test::frame(5, 3, 10.0),
                           [](Cell c) { return -12.5F + 0.37F * static_cast<float>(c.col * c.col + 7 * c.row); });
}

std::uint32_t number_at(std::string const& bytes, std::size_t begin, std::size_t size) {
    std::uint32_t number = 0;
    for (std::size_t k = 0; k < size; ++k) {
        number |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[begin + k])) << (8 * k);
    }
    return number;
}

/// As GDAL reads them.
std::vector<std::uint16_t> samples_of(std::string const& path, int width, int height) {
    GDALAllRegister();
    auto* const file = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_ReadOnly));
    EXPECT_EQ(file->GetRasterXSize(), width);
    EXPECT_EQ(file->GetRasterYSize(), height);
    EXPECT_EQ(file->GetRasterCount(), 1);
    EXPECT_EQ(file->GetRasterBand(1)->GetRasterDataType(), GDT_UInt16);
    std::vector<std::uint16_t> samples(static_cast<std::size_t>(width * height));
    EXPECT_EQ(file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, samples.data(), width, height, GDT_UInt16,
                                               0, 0, nullptr),
              CE_None);
    GDALClose(file);
    return samples;
}

} // namespace

TEST(Heightmap, SixteenBitsAreWithinHalfAStep) {
    ScratchFolder const folder;
    Raster<float> const heights = slope();
    io::HeightmapScale const scale = io::write_heightmap(heights, folder / "a.png", io::HeightmapFormat::png16);
    auto const samples = samples_of(folder / "a.png", 5, 3);
    io::write_heightmap(heights, folder / "a.r16", io::HeightmapFormat::r16);
    std::string const raw = test::bytes_of(folder / "a.r16");
    ASSERT_EQ(raw.size(), 30U);
    EXPECT_EQ(scale.min_m, -12.5);
    EXPECT_EQ(samples.front(), 0);
    EXPECT_EQ(samples.back(), 65535);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(number_at(raw, 2 * i, 2), samples[i]);
        EXPECT_LE(std::fabs(scale.min_m + samples[i] * scale.step_m - static_cast<double>(heights.values()[i])),
                  0.5 * scale.step_m * (1.0 + 1e-9));
    }
    EXPECT_EQ(folder.entries(), 2);
}

TEST(Heightmap, ThirtyTwoBitsAreTheHeights) {
    ScratchFolder const folder;
    Raster<float> const heights = slope();
    EXPECT_EQ(io::write_heightmap(heights, folder / "a.r32", io::HeightmapFormat::r32).step_m, 0.0);
    std::string const raw = test::bytes_of(folder / "a.r32");
    ASSERT_EQ(raw.size(), 60U);
    for (std::size_t i = 0; i < 15; ++i) {
        EXPECT_EQ(std::bit_cast<float>(number_at(raw, 4 * i, 4)), heights.values()[i]);
    }
}

TEST(Heightmap, FlatLandIsAllLowest) {
    ScratchFolder const folder;
    Raster<float> const flat(test::frame(3, 2), 80.0F);
    io::HeightmapScale const scale = io::write_heightmap(flat, folder / "a.png", io::HeightmapFormat::png16);
    EXPECT_EQ(scale.step_m, 0.0);
    EXPECT_EQ(scale.max_m, 80.0);
    EXPECT_EQ(samples_of(folder / "a.png", 3, 2), std::vector<std::uint16_t>(6, 0));
}

TEST(Heightmap, HolesAndFilesThatExistAreRefused) {
    ScratchFolder const folder;
    Raster<float> heights = slope();
    io::write_heightmap(heights, folder / "a.r16", io::HeightmapFormat::r16);
    EXPECT_NE(
        test::message_of<IoError>([&] { io::write_heightmap(heights, folder / "a.r16", io::HeightmapFormat::r16); }),
        "");
    for (float const bad : {std::nanf(""), HUGE_VALF}) {
        heights[Cell{2, 1}] = bad;
        EXPECT_TRUE(test::has(test::message_of<BadInput>(
                                  [&] { io::write_heightmap(heights, folder / "b.png", io::HeightmapFormat::png16); }),
                              "column 2, row 1"));
    }
    EXPECT_EQ(folder.entries(), 1);
}

} // namespace heightmap_test
