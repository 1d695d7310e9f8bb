// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/raster_files.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/read_drawable.hpp>

#include "scratch_folder.hpp"

namespace undeclared_nodata_test {

using namespace thalweg;
using test::has;
using test::message_of;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Written {
    int width = 40;
    int height = 30;
    std::optional<double> nodata = {};
    double high = 30.0; ///< [m] of a cell that is 30 m wide
    double scale = 1.0;
};

using Heights = std::function<double(int, int)>;

/// A GeoTIFF with value(column, row).
std::string write(ScratchFolder const& folder, Heights const& value, Written const& wanted = {}) {
    GDALAllRegister();
    std::string const path = folder / "dem.tif";
    GDALDatasetUniquePtr const data(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path.c_str(), wanted.width, wanted.height, 1, GDT_Float32, nullptr));
    std::vector<double> frame{500000.0, 30.0, 0.0, 5000000.0, 0.0, -wanted.high};
    data->SetGeoTransform(frame.data());
    OGRSpatialReference reference;
    reference.importFromEPSG(32632);
    data->SetSpatialRef(&reference);
    GDALRasterBand& band = *data->GetRasterBand(1);
    if (wanted.nodata) {
        band.SetNoDataValue(*wanted.nodata);
    }
    if (wanted.scale != 1.0) {
        band.SetScale(wanted.scale);
    }
    std::vector<double> row(static_cast<std::size_t>(wanted.width));
    for (int r = 0; r < wanted.height; ++r) {
        for (int c = 0; c < wanted.width; ++c) {
            row[static_cast<std::size_t>(c)] = value(c, r);
        }
        EXPECT_EQ(
            band.RasterIO(GF_Write, 0, r, wanted.width, 1, row.data(), wanted.width, 1, GDT_Float64, 0, 0, nullptr),
            CE_None);
    }
    return path;
}

double slope(int col, int row) {
    return 100.0 + 2.0 * col + 0.5 * row;
}

/// A slope with a block of side x side cells of one value.
Heights hole(double value, int side = 6) {
    return [=](int c, int r) { return c >= 10 && c < 10 + side && r >= 8 && r < 8 + side ? value : slope(c, r); };
}

std::int64_t missing(Raster<float> const& dem) {
    return std::ranges::count_if(dem.values(), [](float z) { return std::isnan(z); });
}

std::string refusal(std::string const& path, io::ReadDemParams const& params = {}) {
    std::string const words = message_of<BadInput>([&] { io::read_dem(path, params); });
    EXPECT_EQ(words.substr(words.find(": ") + 1), [&] {
        std::string const other = message_of<BadInput>([&] { io::read_drawable(path, {.nodata = params.nodata}); });
        return other.substr(other.find(": ") + 1);
    }()) << "one rule for all readers";
    return words;
}

} // namespace

TEST(UndeclaredNodata, WhatNoTerrainHasIsRefusedWithTheRemedy) {
    for (double const value : {-9999.0, -32768.0, -32767.0, -99999.0}) {
        for (int const side : {1, 6}) {
            ScratchFolder const folder;
            std::string const path = write(folder, hole(value, side));
            std::string const words = refusal(path);
            EXPECT_TRUE(has(words, std::to_string(side * side) + " cells of")) << words;
            EXPECT_TRUE(has(words, "column 10, row 8")) << words;
            EXPECT_TRUE(has(words, "gdal_edit.py -a_nodata " + std::to_string(static_cast<int>(value)) + " " + path))
                << words;
            EXPECT_TRUE(has(words, "--nodata " + std::to_string(static_cast<int>(value)))) << words;
            EXPECT_EQ(missing(io::read_dem(path, {.nodata = value})), side * side);
            EXPECT_EQ(missing(io::read_stored_dem(path, {.nodata = value})), side * side);
            EXPECT_EQ(missing(io::read_dem(path, {.nodata = none})), 0);
            EXPECT_FALSE(refusal(write(folder, hole(value, side), {.nodata = -1.0})).empty()) << "another is declared";
            EXPECT_EQ(missing(io::read_dem(write(folder, hole(value, side), {.nodata = value}))), side * side);
        }
    }
}

TEST(UndeclaredNodata, TheLargestFloatIsRefusedWithTheRemedy) {
    for (double const sign : {-1.0, 1.0}) {
        ScratchFolder const folder;
        std::string const path = write(folder, hole(sign * static_cast<double>(std::numeric_limits<float>::max())));
        EXPECT_TRUE(has(message_of<BadInput>([&] { io::read_dem(path); }), "gdal_edit.py -a_nodata")) << sign;
        EXPECT_TRUE(has(message_of<BadInput>([&] { io::read_drawable(path); }), "--nodata")) << sign;
        EXPECT_EQ(missing(io::read_dem(path, {.nodata = sign * 3.4e38})), 36);
        EXPECT_EQ(missing(io::read_drawable(path, {.nodata = sign * 3.4e38}).dem), 36);
    }
}

TEST(UndeclaredNodata, TheDeepSeaIsTerrain) {
    ScratchFolder const folder;
    auto const trench = [](int c, int r) { return -9980.0 - c - r; };
    EXPECT_EQ(missing(io::read_dem(write(folder, trench))), 0);
}

TEST(UndeclaredNodata, ABlockFarFromAllElseIsRefused) {
    ScratchFolder const folder;
    for (double const value : {-500.0, 9000.0, 65535.0}) {
        std::string const words = refusal(write(folder, hole(value)));
        EXPECT_TRUE(has(words, "around column 11, row 9") && has(words, "gdal_edit.py -a_nodata ")) << words;
        EXPECT_EQ(missing(io::read_dem(folder / "dem.tif", {.nodata = value})), 36);
    }
    EXPECT_TRUE(has(refusal(write(folder, hole(9000.0, 3))), "9000"));
    // Peaks, flats at the level of the terrain, the sea, and what is declared as terrain, are left alone.
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(9000.0, 2)))), 0);
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(20.0)))), 0);
    EXPECT_EQ(missing(io::read_dem(write(folder, [](int c, int r) { return hole(0.0)(c, r) * 10.0; }))), 0);
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(9000.0), {.nodata = -9999.0}))), 0);
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(9000.0)), {.nodata = none})), 0);
    auto const two_levels = [](int c, int /*row*/) { return c < 20 ? 1.0 : 255.0; };
    EXPECT_EQ(missing(io::read_dem(write(folder, two_levels))), 0);
    // Numbers of masks and classes are no heights.
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(9000.0)), {.values = io::CellValues::numbers})), 0);
    Grid const grid = io::read_dem(folder / "dem.tif", {.nodata = none}).grid();
    EXPECT_NO_THROW(io::read_mask(folder / "dem.tif", grid));
    EXPECT_THROW(io::read_mask(write(folder, hole(-9999.0)), grid), BadInput);
}

TEST(UndeclaredNodata, StoredValuesCountNotScaledOnes) {
    ScratchFolder const folder;
    std::string const path = write(folder, hole(-9999.0), {.scale = 0.1});
    EXPECT_TRUE(has(refusal(path), "36 cells of -9999"));
    Raster<float> const dem = io::read_dem(path, {.nodata = -9999.0});
    EXPECT_EQ(missing(dem), 36);
    EXPECT_EQ(dem[0], 10.0F);
}

TEST(UndeclaredNodata, NanIsCounted) {
    ScratchFolder const folder;
    std::string const path = write(folder, hole(none));
    std::string log;
    thalweg::Run run;
    run.log = [&](std::string_view line) { log += std::string(line) + "\n"; };
    EXPECT_EQ(missing(io::read_dem(path, run)), 36);
    EXPECT_TRUE(has(log, "dem.tif: 36 cells are NaN and count as no-data")) << log;
    EXPECT_TRUE(has(io::read_drawable(path).notes.at(0), "36 cells are NaN"));
    log.clear();
    io::read_dem(write(folder, hole(none), {.nodata = none}), run);
    EXPECT_EQ(log, "");
    io::read_dem(write(folder, hole(-9999.0)), {.nodata = -9999.0}, run);
    EXPECT_TRUE(has(log, "dem.tif: 36 cells of -9999 are no-data")) << log;
}

TEST(UndeclaredNodata, PicturesOfMeansKnowTheValue) {
    ScratchFolder const folder;
    std::string const path = write(folder, hole(-9999.0, 7), {.width = 80, .height = 60});
    EXPECT_THROW(io::read_drawable(path, {.most_side = 16}), BadInput);
    Raster<float> const dem = io::read_drawable(path, {.most_side = 16, .nodata = -9999.0}).dem;
    EXPECT_EQ(dem.width(), 16);
    for (float const z : dem.values()) {
        EXPECT_TRUE(std::isnan(z) || z > 90.0F) << z;
    }
    std::string const both = write(folder, hole(-9999.0), {.nodata = 105.0});
    EXPECT_TRUE(has(message_of<BadInput>([&] { io::read_drawable(both, {.nodata = -9999.0}); }), "one of them"));
}

TEST(NearlySquareCells, AreTakenWhereTheyMakeATenthOfACellAtMost) {
    ScratchFolder const folder;
    std::string const near = write(folder, slope, {.high = 30.0007});
    EXPECT_EQ(io::read_dem(near).grid(), (Grid{40, 30, 30.0, 500000.0, 5000000.0, "EPSG:32632"}));
    EXPECT_TRUE(io::has_square_cells(near));
    EXPECT_TRUE(io::read_drawable(near).notes.empty());
    // A tenth of a cell over 120 columns; and cells that are seen not to be square, however few.
    for (Written const& wanted :
         {Written{.width = 120, .high = 30.026}, Written{.width = 4, .height = 4, .high = 30.1}}) {
        std::string const far = write(folder, slope, wanted);
        EXPECT_FALSE(io::has_square_cells(far));
        std::string const words = message_of<BadInput>([&] { io::read_dem(far); });
        EXPECT_TRUE(has(words, "not squares: warp it (gdalwarp -tr 30 30)")) << words;
        EXPECT_TRUE(has(io::read_drawable(far).notes.at(0), "made squares"));
    }
}

} // namespace undeclared_nodata_test
