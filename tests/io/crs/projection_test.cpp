// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/crs/crs.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <cpl_error.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/gdal/driver.hpp>

#include "scratch_folder.hpp"

namespace projection_test {

using namespace thalweg;

namespace {

using test::full_message_of;
using test::has;
using test::message_of;

std::string refusal(std::string const& crs) {
    return message_of<BadInput>([&] { io::projected_crs(crs); });
}

} // namespace

TEST(Projection, RefusesWhatIsNone) {
    for (auto const* const text : {"", " ", "EPSG:", "EPSG:999999", "nonsense", "PROJCS[", "EPSG:32633x"}) {
        EXPECT_TRUE(has(refusal(text), "is not a coordinate system")) << text << ": " << refusal(text);
    }
    std::string const words = refusal(std::string(100000, 'x'));
    EXPECT_TRUE(!words.empty() && words.size() < 400U) << words;
}

TEST(Projection, ReadsNoFileAndNoUrl) {
    ScratchFolder const folder;
    std::filesystem::path const path = folder / "a.prj";
    std::ofstream(path) << "EPSG:32633\n";
    EXPECT_TRUE(has(refusal(path.string()), "is not a coordinate system")) << refusal(path.string());
    EXPECT_TRUE(has(refusal("http://127.0.0.1:9/x.prj"), "is not a coordinate system"));
}

TEST(Projection, RefusesWhatIsNotInMetres) {
    EXPECT_TRUE(has(refusal("EPSG:4326"), "EPSG:4326 is geographic")) << refusal("EPSG:4326");
    EXPECT_TRUE(has(refusal("WGS84"), "is geographic"));
    EXPECT_TRUE(has(refusal("EPSG:2225"), "in 'US survey foot'")) << refusal("EPSG:2225");
    EXPECT_TRUE(has(refusal("EPSG:4978"), "not projected")) << refusal("EPSG:4978"); // geocentric
}

TEST(Projection, GivesTheCode) {
    EXPECT_EQ(io::projected_crs("EPSG:32633"), "EPSG:32633");
    EXPECT_EQ(io::projected_crs("epsg:32633"), "EPSG:32633");
    EXPECT_EQ(io::projected_crs("EPSG:31467"), "EPSG:31467");      // northing first
    EXPECT_EQ(io::projected_crs("EPSG:25832+7837"), "EPSG:25832"); // with heights
    OGRSpatialReference utm;
    utm.importFromEPSG(32633);
    char* wkt = nullptr;
    utm.exportToWkt(&wkt);
    EXPECT_EQ(io::projected_crs(wkt), "EPSG:32633");
    CPLFree(wkt);
}

TEST(Projection, GivesWktWhereThereIsNoCode) {
    auto const wkt = io::projected_crs("+proj=laea +lat_0=10 +lon_0=20 +datum=WGS84 +units=m");
    EXPECT_TRUE(has(wkt, "PROJCRS[")) << wkt;
    EXPECT_EQ(io::projected_crs(wkt), wkt);
}

TEST(Projection, UtmZones) {
    EXPECT_EQ(io::utm_zone(-122.8, 38.2), "EPSG:32610");
    EXPECT_EQ(io::utm_zone(151.2, -33.9), "EPSG:32756");
    EXPECT_EQ(io::utm_zone(0.0, 0.0), "EPSG:32631");
    EXPECT_EQ(io::utm_zone(-0.001, -0.001), "EPSG:32730");
    EXPECT_EQ(io::utm_zone(-180.0, 10.0), "EPSG:32601");
    EXPECT_EQ(io::utm_zone(179.9, 10.0), "EPSG:32660");
    EXPECT_EQ(io::utm_zone(180.0, 10.0), "EPSG:32601");
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(io::utm_zone(nan, 0.0), BadInput);
    EXPECT_THROW(io::utm_zone(0.0, nan), BadInput);
    EXPECT_THROW(io::utm_zone(0.0, 85.0), BadInput);
    EXPECT_THROW(io::utm_zone(0.0, -81.0), BadInput);
}

TEST(Driver, KeepsErrorsUntilTheyAreAskedFor) {
    io::Driver const driver;
    EXPECT_NO_THROW(driver.check("x"));
    CPLError(CE_Warning, CPLE_AppDefined, "a warning");
    EXPECT_NO_THROW(driver.check("x"));
    CPLError(CE_Failure, CPLE_AppDefined, "the disk is full");
    {
        io::Driver const inner;
        CPLError(CE_Failure, CPLE_AppDefined, "another matter");
        EXPECT_EQ(inner.take(), "another matter");
        EXPECT_EQ(inner.take(), "");
    }
    EXPECT_EQ(full_message_of<IoError>([&] { driver.check("io.write_dem: out/dem.tif"); }),
              "io.write_dem: out/dem.tif: the disk is full");
    EXPECT_NO_THROW(driver.check("x"));
}

TEST(Driver, SaysItsVersion) {
    EXPECT_EQ(io::gdal_version().substr(0, 6), "GDAL 3");
}

TEST(Projection, UtmStretchesFarFromItsCentralMeridian) {
    // Of zone 33, whose central meridian is 15 degrees east, scaled by 0.9996.
    EXPECT_EQ(io::utm_stretch("EPSG:32633", {15.0, 45.0, 15.0, 46.0}), 0.0);
    EXPECT_NEAR(io::utm_stretch("EPSG:32633", {12.0, 0.0, 18.0, 10.0}), 0.00097, 1e-5);
    EXPECT_NEAR(io::utm_stretch("EPSG:32633", {-15.0, 0.0, 15.0, 1.0}), 0.9996 / std::sqrt(0.75) - 1.0, 1e-12);
    // The latitude nearest to the equator counts, and both sides.
    EXPECT_EQ(io::utm_stretch("EPSG:32633", {0.0, -5.0, 20.0, 60.0}),
              io::utm_stretch("EPSG:32733", {0.0, 0.0, 1.0, 0.0}));
    EXPECT_LT(io::utm_stretch("EPSG:32633", {0.0, 60.0, 20.0, 70.0}), 0.009);
    // Round the globe, and a quarter of it away.
    EXPECT_EQ(io::utm_stretch("EPSG:32601", {179.0, 50.0, 181.0, 51.0}),
              io::utm_stretch("EPSG:32601", {-181.0, 50.0, -179.0, 51.0}));
    EXPECT_EQ(io::utm_stretch("EPSG:32633", {-100.0, 0.0, 15.0, 1.0}), std::numeric_limits<double>::infinity());
    EXPECT_EQ(io::utm_stretch("EPSG:3035", {-60.0, 0.0, 60.0, 10.0}), 0.0);
    EXPECT_EQ(io::utm_number("EPSG:32660"), 60);
    EXPECT_EQ(io::utm_number("EPSG:32701"), 1);
    for (char const* const other : {"EPSG:32661", "EPSG:32700", "EPSG:32600", "EPSG:4326", "", "PROJCS[]"}) {
        EXPECT_FALSE(io::utm_number(other)) << other;
    }
}

} // namespace projection_test
