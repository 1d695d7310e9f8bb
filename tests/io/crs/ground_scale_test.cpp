// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/crs/crs.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/internal/crs.hpp>
#include <thalweg/io/crs/internal/into_metres.hpp>
#include <thalweg/io/gdal/driver.hpp>

namespace ground_scale_test {

using namespace thalweg;
using test::has;
using test::message_of;

namespace {

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
    std::string const world = message_of<BadInput>([] {
        instead_of("EPSG:3857", {{-half_equator_m, -1e7}, {half_equator_m, 1e7}});
    });
    EXPECT_TRUE(has(world, "degrees of longitude") && has(world, "--crs")) << world;
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

} // namespace ground_scale_test
