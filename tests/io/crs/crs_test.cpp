// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/crs/crs.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <cpl_error.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/gdal/driver.hpp>

#include "scratch_folder.hpp"

namespace crs_test {

using namespace thalweg;
using test::error_of;
using test::has;

namespace {

std::string refusal(std::string const& crs) {
    return error_of([&] { io::projected_crs(crs); });
}

constexpr double half_equator_m = 20037508.342789244;

io::PointScale scale_at(char const* crs, Vec2 place) {
    io::Driver const driver;
    auto const scale = io::GroundScale(io::read_reference(crs)).at(place);
    EXPECT_TRUE(scale) << crs;
    return scale.value_or(io::PointScale{});
}

std::string instead_of(char const* crs, io::FileBox const& box) {
    io::Driver const driver;
    return io::less_distorted(io::read_reference(crs), box, "a.gpkg").value_or("");
}

} // namespace

TEST(Projection, RefusesWhatIsNotInMetres) {
    ScratchFolder const folder; // no file and no URL is read
    folder.write("a.prj", "EPSG:32633\n");
    for (std::string const& text :
         {std::string(), std::string(" "), std::string("EPSG:"), std::string("EPSG:999999"), std::string("nonsense"),
          std::string("PROJCS["), std::string("EPSG:32633x"), folder / "a.prj", std::string("http://127.0.0.1:9/x.prj"),
          std::string(100000, 'x')}) {
        EXPECT_TRUE(has(refusal(text), "BadInput io.", "is not a coordinate system")) << text.substr(0, 30);
        EXPECT_LT(refusal(text).size(), 500U);
    }
    for (std::string const text : {"EPSG:4326", "WGS84", "EPSG:2225", "EPSG:4978"}) { // degrees, feet, geocentric
        EXPECT_TRUE(has(refusal(text), "BadInput io.")) << text;
    }
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
    EXPECT_TRUE(has(wkt, "PROJCRS["));
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
    EXPECT_EQ(error_of([&] { driver.check("io.write_dem", "out/dem.tif"); }),
              "IoError io.write_dem: out/dem.tif: the disk is full");
    EXPECT_NO_THROW(driver.check("x"));
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

TEST(GroundScale, PlacesOffTheGlobeHaveNone) {
    io::Driver const driver;
    double const nan = std::numeric_limits<double>::quiet_NaN();
    io::GroundScale const mollweide(io::read_reference("+proj=moll +datum=WGS84"));
    EXPECT_TRUE(mollweide.at({0.0, 0.0}));
    EXPECT_FALSE(mollweide.at({1e9, 0.0}));
    EXPECT_FALSE(mollweide.at({nan, 0.0}));
    EXPECT_EQ(instead_of("+proj=moll +datum=WGS84", {{1e9, 1e9}, {2e9, 2e9}}), "");
    EXPECT_EQ(instead_of("EPSG:3857", {{nan, nan}, {nan, nan}}), "");
}

TEST(GroundScale, UtmIsThatOfItsFormula) {
    EXPECT_NEAR(scale_at("EPSG:32631", {500000.0, 5000000.0}).side_m, 1.0 / 0.9996, 1e-7);
    EXPECT_NEAR(scale_at("EPSG:32631", {500000.0, 5000000.0}).error, 0.0004, 1e-7);
    // 320 km off the central meridian: 0.9996 (1 + x² / 2 R²).
    double const off = 320000.0 / 0.9996 / 6378000.0;
    EXPECT_NEAR(scale_at("EPSG:32631", {820000.0, 5000000.0}).side_m, 1.0 / (0.9996 * (1.0 + 0.5 * off * off)), 2e-5);
}

TEST(GroundScale, WebMercatorStretchesByLatitude) {
    EXPECT_NEAR(scale_at("EPSG:3857", {0.0, 0.0}).error, 0.0067, 1e-4); // of a sphere on an ellipsoid
    // 60 degrees north: metres of half a metre.
    double const north = half_equator_m / std::acos(-1.0) * std::log(std::tan(std::acos(-1.0) * (0.25 + 1.0 / 6.0)));
    EXPECT_NEAR(scale_at("EPSG:3857", {1e6, north}).side_m, 0.5, 0.002);
    EXPECT_NEAR(scale_at("EPSG:3857", {1e6, north}).error, 1.0, 0.01);
}

TEST(GroundScale, EqualAreaKeepsAreasAndTurnsLengths) {
    io::PointScale const middle = scale_at("EPSG:3035", {4321000.0, 3210000.0});
    EXPECT_NEAR(middle.error, 0.0, 1e-6);
    io::PointScale const far = scale_at("EPSG:3035", {2700000.0, 1900000.0}); // Portugal
    EXPECT_NEAR(far.side_m, 1.0, 1e-6);
    EXPECT_NEAR(far.error, 0.0134, 0.0005); // 1 / cos(c / 2) - 1, 2083 km away
}

TEST(GroundScale, OnlyWhatIsOffByMoreThanAPercentIsLeft) {
    EXPECT_EQ(instead_of("EPSG:3857", {{1000000.0, 5934000.0}, {1008000.0, 5949000.0}}), "EPSG:32632");
    EXPECT_EQ(instead_of("EPSG:3857", {{1000000.0, -5949000.0}, {1008000.0, -5934000.0}}), "EPSG:32732");
    EXPECT_EQ(instead_of("EPSG:3857", {{1000000.0, -50000.0}, {1008000.0, 50000.0}}), ""); // at the equator
    EXPECT_EQ(instead_of("EPSG:3857", {{100000.0, -4e6}, {200000.0, 4e6}}), "EPSG:32631"); // across it
    EXPECT_TRUE(has(instead_of("EPSG:3857", {{-1e6, 3e6}, {4e6, 8e6}}), "Equal area"));
    EXPECT_EQ(instead_of("EPSG:32633", {{100000.0, 4e6}, {900000.0, 6e6}}), "");
    EXPECT_EQ(instead_of("EPSG:32633", {{-3e6, 5e6}, {-2.9e6, 5.1e6}}), "EPSG:32626"); // Iberia's ocean in Austria's
    EXPECT_EQ(instead_of("EPSG:3035", {{4e6, 2.8e6}, {4.6e6, 3.5e6}}), "");
    EXPECT_EQ(instead_of("EPSG:3035", {{2.7e6, 1.9e6}, {2.8e6, 2e6}}), "EPSG:32629");
    EXPECT_EQ(instead_of("EPSG:5070", {{-2.3e6, 3e5}, {2.2e6, 3.2e6}}), "");    // as good as any for all of it
    EXPECT_EQ(instead_of("EPSG:3031", {{-2.5e6, -2.5e6}, {2.5e6, 2.5e6}}), ""); // round the pole
    EXPECT_EQ(instead_of("EPSG:4326", {{10.0, 45.0}, {11.0, 46.0}}), "");
    EXPECT_THROW(instead_of("EPSG:3857", {{-half_equator_m, -1e7}, {half_equator_m, 1e7}}), BadInput); // the world
}

TEST(GroundScale, CellsOfWebMercatorAreMeasuredOnTheGround) {
    Grid const mercator{100, 80, 30.0, 1000000.0, 5950000.0, "EPSG:3857"};
    io::GroundCell const cell = io::ground_cell(mercator);
    EXPECT_EQ(cell.unit, io::GridUnit::distorted);
    EXPECT_EQ(cell.crs, "EPSG:32632");
    EXPECT_NEAR(cell.side_m, 30.0 * 0.681, 0.05);
    EXPECT_TRUE(io::is_distorted(mercator));
    EXPECT_EQ(io::metric_crs(mercator, "a.tif"), "EPSG:32632");
    Grid const utm{100, 80, 30.0, 500000.0, 5200000.0, "EPSG:32632"};
    EXPECT_EQ(io::ground_cell(utm).unit, io::GridUnit::metres);
    EXPECT_EQ(io::ground_cell(utm).side_m, 30.0);
    EXPECT_EQ(io::ground_cell(utm).crs, "EPSG:32632");
    for (char const* const crs : {"EPSG:32632", "EPSG:2225", ""}) {
        EXPECT_FALSE(io::is_distorted({100, 80, 30.0, 500000.0, 5200000.0, crs})) << crs;
    }
    EXPECT_FALSE(io::is_distorted({10, 8, 0.01, 9.0, 47.0, "EPSG:4326"}));
}

} // namespace crs_test
