// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/raster_files.hpp>

#include <cmath>
#include <fstream>
#include <limits>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/read_drawable.hpp>

#include "scratch_folder.hpp"

namespace read_drawable_test {

using namespace thalweg;
using io::Drawable;
using io::read_drawable;

namespace {

struct Made {
    int width = 20;
    int height = 10;
    int bands = 1;
    int epsg = 32631;
    std::vector<double> frame{500000.0, 10.0, 0.0, 5000000.0, 0.0, -10.0}; ///< none: no position
    double nodata = -9999.0;
};

/// A GeoTIFF whose heights are 100 + column.
std::string make(ScratchFolder const& folder, std::string const& name, Made const& made) {
    GDALAllRegister();
    std::string path = folder / name;
    GDALDatasetUniquePtr const data(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path.c_str(), made.width, made.height, made.bands, GDT_Float32, nullptr));
    if (!made.frame.empty()) {
        std::vector<double> frame = made.frame;
        data->SetGeoTransform(frame.data());
    }
    if (made.epsg > 0) {
        OGRSpatialReference reference;
        reference.importFromEPSG(made.epsg);
        data->SetSpatialRef(&reference);
    }
    std::vector<float> row(static_cast<std::size_t>(made.width));
    for (std::size_t col = 0; col < row.size(); ++col) {
        row[col] = 100.0F + static_cast<float>(col);
    }
    for (int band = 1; band <= made.bands; ++band) {
        data->GetRasterBand(band)->SetNoDataValue(made.nodata);
        for (int y = 0; y < made.height; ++y) {
            EXPECT_EQ(data->GetRasterBand(band)->RasterIO(GF_Write, 0, y, made.width, 1, row.data(), made.width, 1,
                                                          GDT_Float32, 0, 0, nullptr),
                      CE_None);
        }
    }
    return path;
}

bool notes_say(Drawable const& read, std::string const& words) {
    for (std::string const& note : read.notes) {
        if (note.find(words) != std::string::npos) {
            return true;
        }
    }
    return false;
}

} // namespace

TEST(ReadDrawable, RefusesWhatIsNoRaster) {
    ScratchFolder const folder;
    EXPECT_THROW(read_drawable(folder / "none.tif"), BadInput);
    EXPECT_THROW(read_drawable(folder.path().string()), BadInput);
    std::ofstream(folder / "text.tif") << "no raster";
    EXPECT_THROW(read_drawable(folder / "text.tif"), BadInput);
    Made made;
    made.nodata = 100.0;
    made.width = 1;
    EXPECT_THROW(read_drawable(make(folder, "empty.tif", made)), BadInput);
    EXPECT_THROW(read_drawable(make(folder, "dem.tif", {}), {.most_side = 3}), BadParameter);
}

TEST(ReadDrawable, WhatReadDemTakesIsReadAlike) {
    ScratchFolder const folder;
    std::string const path = make(folder, "dem.tif", {});
    Drawable const read = read_drawable(path);
    EXPECT_TRUE(read.notes.empty());
    Raster<float> const dem = io::read_dem(path);
    EXPECT_EQ(read.dem.grid(), dem.grid());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        EXPECT_EQ(read.dem[i], dem[i]);
    }
}

TEST(ReadDrawable, LargeOnesBecomeMeansOfTheirKnownCells) {
    ScratchFolder const folder;
    Made made;
    made.width = 65;
    made.height = 40;
    made.nodata = 105.0;
    Drawable const read = read_drawable(make(folder, "dem.tif", made), {.most_side = 16});
    EXPECT_TRUE(notes_say(read, "means of 5x5 cells"));
    EXPECT_EQ(read.dem.width(), 13);
    EXPECT_EQ(read.dem.height(), 8);
    EXPECT_EQ(read.dem.grid().cell_m, 50.0);
    for (std::int64_t col = 0; col < 13; ++col) {
        // 105 itself is missing in the second block: the mean of 106 to 109.
        double const wanted = col == 1 ? 107.5 : 102.0 + 5.0 * static_cast<double>(col);
        EXPECT_NEAR(read.dem[(Cell{col, 3})], wanted, 1e-4) << col;
    }
}

TEST(ReadDrawable, GeographicOnesAreWarped) {
    ScratchFolder const folder;
    Made made;
    made.epsg = 4326;
    made.frame = {3.0, 0.001, 0.0, 45.0, 0.0, -0.001};
    Drawable const zone = read_drawable(make(folder, "zone.tif", made));
    EXPECT_EQ(zone.dem.grid().crs, "EPSG:32631");
    EXPECT_TRUE(notes_say(zone, "UTM zone 31N"));
    EXPECT_NEAR(zone.dem.grid().west, 500000.0, 200.0);
    made.frame = {-20.0, 2.0, 0.0, 60.0, 0.0, -2.0};
    Drawable const wide = read_drawable(make(folder, "wide.tif", made));
    EXPECT_TRUE(notes_say(wide, "Equal area around 0, 50"));
    Vec2 const middle{0.5 * (wide.dem.grid().west + wide.dem.grid().east()), 0.0};
    EXPECT_LT(std::fabs(middle.x), 2e5);
    Made feet;
    feet.epsg = 2229;
    feet.frame = {6500000.0, 100.0, 0.0, 1900000.0, 0.0, -100.0};
    Drawable const metres = read_drawable(make(folder, "feet.tif", feet));
    EXPECT_NEAR(metres.dem.grid().cell_m, 30.48, 0.05);
}

TEST(ReadDrawable, MetresThatAreNoneAreWarped) {
    ScratchFolder const folder;
    Made made;
    made.epsg = 3857;
    made.frame = {1000000.0, 30.0, 0.0, 5950000.0, 0.0, -30.0};
    std::string const path = make(folder, "mercator.tif", made);
    Drawable const read = read_drawable(path);
    EXPECT_EQ(read.dem.grid().crs, "EPSG:32632");
    EXPECT_NEAR(read.dem.grid().cell_m, 30.0 * 0.681, 0.2);
    EXPECT_TRUE(notes_say(read, "warped from WGS 84 / Pseudo-Mercator into WGS 84 / UTM zone 32N"));
    Drawable const kept = read_drawable(path, {.metres = io::MetresOf::any_crs});
    EXPECT_TRUE(kept.notes.empty());
    EXPECT_EQ(kept.dem.grid().crs, "EPSG:3857");
}

TEST(ReadDrawable, OddFramesBecomeNorthUpSquares) {
    ScratchFolder const folder;
    Made made;
    made.frame = {500000.0, 10.0, 0.0, 5000000.0, 0.0, -20.0};
    Drawable const tall = read_drawable(make(folder, "tall.tif", made));
    EXPECT_TRUE(notes_say(tall, "10 x 20 made squares"));
    EXPECT_NEAR(static_cast<double>(tall.dem.height()) * tall.dem.grid().cell_m, 200.0, 15.0);
    made.frame = {500000.0, 8.0, 6.0, 5000000.0, 6.0, -8.0};
    EXPECT_TRUE(notes_say(read_drawable(make(folder, "turned.tif", made)), "turned north-up"));
    made.frame = {500000.0, 10.0, 0.0, 5000000.0, 0.0, 10.0};
    Drawable const south_up = read_drawable(make(folder, "south.tif", made));
    EXPECT_TRUE(notes_say(south_up, "turned north-up"));
    EXPECT_EQ(south_up.dem.width(), 20);
}

TEST(ReadDrawable, CellsTooSmallForTheirPositionAreRefused) {
    ScratchFolder const folder;
    for (double const cell : {1e-16, 1e-300}) {
        for (int const epsg : {32631, 4326, 2154, 0}) { // 2154: another zone; 4326 and unequal sides are warped
            for (double const high : {cell, 2.0 * cell}) {
                Made made;
                made.epsg = epsg;
                made.frame = {epsg == 4326 ? 3.0 : 500000.0, cell, 0.0, epsg == 4326 ? 45.0 : 5000000.0, 0.0, -high};
                std::string const path = make(folder, "tiny.tif", made);
                try {
                    Drawable const drawn = read_drawable(path);
                    EXPECT_GT(drawn.dem.cells(), 0) << epsg;
                } catch (BadInput const& refusal) {
                    EXPECT_NE(std::string(refusal.what()).find("tiny.tif"), std::string::npos) << refusal.what();
                }
            }
        }
    }
    Made made;
    made.frame = {500000.0, 1e-16, 0.0, 5000000.0, 0.0, -2e-16};
    EXPECT_THROW(read_drawable(make(folder, "tiny.tif", made)), BadInput);
}

TEST(ReadDrawable, SaysWhatItHadToAssume) {
    ScratchFolder const folder;
    Made made;
    made.epsg = 0;
    EXPECT_TRUE(notes_say(read_drawable(make(folder, "crs.tif", made)), "no CRS"));
    made.frame.clear();
    EXPECT_TRUE(notes_say(read_drawable(make(folder, "place.tif", made)), "no position"));
    made.bands = 3;
    EXPECT_TRUE(notes_say(read_drawable(make(folder, "bands.tif", made)), "first of 3 bands"));
}

} // namespace read_drawable_test
