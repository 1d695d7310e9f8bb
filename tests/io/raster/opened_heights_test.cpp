// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/io/raster/read_drawable.hpp>

#include "scratch_folder.hpp"
#include "tiff.hpp"

namespace opened_heights_test {

using namespace thalweg;
using test::error_of;
using test::has;

namespace {

constexpr double us_foot_m = 1200.0 / 3937.0;

double slope(int col, int row) {
    return 700.0 + 3.0 * col - 1.25 * row;
}

/// Writes a DEM and changes it as another program would.
std::string changed(ScratchFolder const& folder, Tiff const& wanted, std::function<void(GDALDataset&)> const& change,
                    std::function<double(int, int)> const& value = slope) {
    std::string const path = written(folder / "dem.tif", wanted, value);
    GDALDatasetUniquePtr const data(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    change(*data);
    return path;
}

std::function<void(GDALDataset&)> in_crs(std::string const& crs) {
    return [crs](GDALDataset& data) {
        OGRSpatialReference reference;
        EXPECT_EQ(reference.SetFromUserInput(crs.c_str()), OGRERR_NONE);
        reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
        data.SetSpatialRef(&reference);
    };
}

Finding const* found(std::vector<Finding> const& findings, FindingKind kind) {
    auto const at = std::ranges::find(findings, kind, &Finding::kind);
    return at == findings.end() ? nullptr : &*at;
}

/// Both readers see the heights in the same cells.
void expect_heights(std::string const& path, std::function<double(int, int)> const& metres,
                    io::ReadDemParams const& params = {}) {
    Raster<float> const dem = io::read_dem(path, params);
    Raster<float> const drawn = io::read_drawable(path, {.reading = params}).dem;
    ASSERT_EQ(dem.cells(), drawn.cells());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        double const wanted = metres(static_cast<int>(c.col), static_cast<int>(c.row));
        ASSERT_EQ(std::isnan(dem[i]), std::isnan(wanted)) << i;
        ASSERT_TRUE(std::isnan(wanted) || std::fabs(static_cast<double>(dem[i]) - wanted) < 1e-3) << dem[i] << wanted;
        ASSERT_TRUE(dem[i] == drawn[i] || std::isnan(wanted)) << i;
    }
}

} // namespace

TEST(OpenedHeights, FeetOfTheVerticalCrsAreConvertedOnceAndTheCrsIsHorizontal) {
    ScratchFolder const folder;
    std::string const path = changed(folder, {}, in_crs("EPSG:26913+6360"));
    expect_heights(path, [](int c, int r) { return slope(c, r) * us_foot_m; });
    io::DemFile const read = io::read_dem_file(path);
    EXPECT_EQ(read.dem.grid().crs, "EPSG:26913");
    ASSERT_NE(found(read.findings, "heights_in_metres"), nullptr);
    EXPECT_NEAR(found(read.findings, "heights_in_metres")->amount, us_foot_m, 1e-12);
    // Through a warp into another zone they stay what they are.
    Grid zone = read.dem.grid();
    zone.crs = "EPSG:32614";
    Raster<float> const there = io::warp_to_grid(read.dem, zone, "test");
    for (float const z : there.values()) {
        EXPECT_TRUE(std::isnan(z) || (z > 190.0F && z < 260.0F)) << z;
    }
}

TEST(OpenedHeights, TheUnitOfTheBandComesBeforeTheVerticalCrs) {
    ScratchFolder const folder;
    auto const with_unit = [&](char const* unit, char const* crs) {
        return changed(folder, {}, [=](GDALDataset& data) {
            in_crs(crs)(data);
            data.GetRasterBand(1)->SetUnitType(unit);
        });
    };
    expect_heights(with_unit("m", "EPSG:26913+6360"), slope);
    expect_heights(with_unit("ft", "EPSG:26913"), [](int c, int r) { return slope(c, r) * 0.3048; });
    expect_heights(with_unit("cm", "EPSG:26913+6360"), [](int c, int r) { return slope(c, r) * 0.01; });
    EXPECT_TRUE(io::read_dem_file(with_unit("unspecified", "EPSG:26913")).findings.empty());
    std::string const odd = with_unit("parsecs", "EPSG:26913");
    expect_heights(odd, slope);
    EXPECT_NE(found(io::read_dem_file(odd).findings, "unknown_unit"), nullptr);
    // It does not count as that of the vertical CRS, which the band says it is not.
    expect_heights(with_unit("parsecs", "EPSG:26913+6360"), slope);
    Finding const contrary = *found(io::read_dem_file(folder / "dem.tif").findings, "unknown_unit");
    EXPECT_TRUE(has(contrary.text, "'parsecs'", "count as metres", "US survey feet"));
    EXPECT_NE(found(io::read_dem_file(with_unit("'", "EPSG:26913")).findings, "unknown_unit"), nullptr);
    for (auto const& [unit, metres] :
         {std::pair{"fathoms", 1.8288}, std::pair{"Yards", 0.9144}, std::pair{"inches", 0.0254},
          std::pair{"decimetres", 0.1}, std::pair{"kilometers", 1000.0}, std::pair{"US survey feet", us_foot_m}}) {
        expect_heights(with_unit(unit, "EPSG:26913"), [&](int c, int r) { return slope(c, r) * metres; });
    }
}

TEST(OpenedHeights, ADatumShiftsNothing) {
    ScratchFolder const folder;
    Tiff const degrees{.epsg = 4326, .frame = {7.5, 0.001, 0.0, 46.5, 0.0, -0.001}};
    Raster<float> const plain = io::read_drawable(written(folder / "plain.tif", degrees, slope)).dem;
    Raster<float> const geoid = io::read_drawable(changed(folder, degrees, in_crs("EPSG:4326+5773"))).dem;
    ASSERT_EQ(plain.grid(), geoid.grid());
    for (std::int64_t i = 0; i < plain.cells(); ++i) {
        EXPECT_TRUE(plain[i] == geoid[i] || std::isnan(plain[i])) << i;
    }
}

TEST(OpenedHeights, RowsFromTheSouthAndColumnsFromTheEastAreReadTheOtherWay) {
    ScratchFolder const folder;
    Tiff south{.frame = {500000.0, 30.0, 0.0, 5000000.0, 0.0, 30.0}};
    std::string const path = written(folder / "dem.tif", south, slope);
    expect_heights(path, [](int c, int r) { return slope(c, 29 - r); });
    EXPECT_EQ(io::read_dem(path).grid(), (Grid{40, 30, 30.0, 500000.0, 5000900.0, "EPSG:32632"}));
    EXPECT_NE(found(io::read_dem_file(path).findings, "turned_raster"), nullptr);
    south.frame = {501200.0, -30.0, 0.0, 5000000.0, 0.0, 30.0};
    expect_heights(written(folder / "dem.tif", south, slope), [](int c, int r) { return slope(39 - c, 29 - r); });
    EXPECT_EQ(io::read_dem(folder / "dem.tif").grid(), (Grid{40, 30, 30.0, 500000.0, 5000900.0, "EPSG:32632"}));
}

TEST(OpenedHeights, TransparentCellsAreNoData) {
    ScratchFolder const folder;
    for (bool const declares : {false, true}) { // GDAL's mask of a band with a no-data value leaves the alpha out
        Tiff wanted{.bands = 2};
        if (declares) {
            wanted.nodata = slope(3, 0);
        }
        std::string const path = changed(folder, wanted, [](GDALDataset& data) {
            data.GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
            std::vector<double> alpha(40 * 30);
            for (std::size_t i = 0; i < alpha.size(); ++i) {
                alpha[i] = i % 40 < 10 ? 0.0 : 255.0;
            }
            EXPECT_EQ(data.GetRasterBand(2)->RasterIO(GF_Write, 0, 0, 40, 30, alpha.data(), 40, 30, GDT_Float64, 0, 0,
                                                      nullptr),
                      CE_None);
        });
        expect_heights(path, [&](int c, int r) {
            return c < 10 || (declares && slope(c, r) == slope(3, 0)) ? std::nan("") : slope(c, r);
        });
        Finding const* const note = found(io::read_dem_file(path).findings, "transparent_cells");
        ASSERT_NE(note, nullptr);
        EXPECT_LE(note->amount, 300.0);
    }
}

TEST(OpenedHeights, OneOfSeveralBandsIsNamed) {
    ScratchFolder const folder;
    auto const name_bands = [](std::vector<std::string> const& names) {
        return [names](GDALDataset& data) {
            for (std::size_t i = 0; i < names.size(); ++i) {
                GDALRasterBand& band = *data.GetRasterBand(static_cast<int>(i) + 1);
                band.SetDescription(names[i].c_str());
                std::vector<double> values(40 * 30, 10.0 * static_cast<double>(i) + 1.0);
                EXPECT_EQ(band.RasterIO(GF_Write, 0, 0, 40, 30, values.data(), 40, 30, GDT_Float64, 0, 0, nullptr),
                          CE_None);
            }
        };
    };
    auto const is = [](double z) { return [z](int, int) { return z; }; };
    std::string path = changed(folder, {.bands = 2}, name_bands({"before", "after"}));
    EXPECT_TRUE(
        has(error_of([&] { io::read_dem(path); }), "BadInput io.read_dem", "2 bands (1 before, 2 after)", "--band"));
    expect_heights(path, is(11.0), {.band = "2"});
    expect_heights(path, is(1.0), {.band = "before"});
    EXPECT_TRUE(has(error_of([&] { io::read_dem(path, {.band = "3"}); }), "no band 3"));
    EXPECT_TRUE(has(error_of([&] { io::read_dem(path, {.band = "then"}); }), "no band or variable 'then'", "1 before"));
    path = changed(folder, {.bands = 3}, name_bands({"uncertainty", "Elevation", "count"}));
    expect_heights(path, is(11.0));
    EXPECT_NE(found(io::read_dem_file(path).findings, "bands"), nullptr);
    expect_heights(changed(folder, {.bands = 2}, name_bands({"depth", "elevation"})), is(11.0));
}

TEST(OpenedHeights, ColoursAreDecodedOrRefused) {
    ScratchFolder const folder;
    auto const picture = [&](std::vector<double> const& colour) {
        std::string const path = folder / "tile.png";
        GDALAllRegister();
        GDALDatasetUniquePtr const data(
            GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 4, 4, 3, GDT_Byte, nullptr));
        for (int b = 1; b <= 3; ++b) {
            std::vector<double> values(16, colour[static_cast<std::size_t>(b) - 1]);
            values[5] += b == 3 ? 1.0 : 0.0;
            EXPECT_EQ(
                data->GetRasterBand(b)->RasterIO(GF_Write, 0, 0, 4, 4, values.data(), 4, 4, GDT_Float64, 0, 0, nullptr),
                CE_None);
            data->GetRasterBand(b)->SetColorInterpretation(static_cast<GDALColorInterp>(GCI_RedBand + b - 1));
        }
        GDALDatasetUniquePtr const tile(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(
            path.c_str(), data.get(), 0, nullptr, nullptr, nullptr));
        return path;
    };
    std::string const path = picture({1.0, 134.0, 160.0});
    for (auto const& read :
         std::vector<std::function<void()>>{[&] { io::read_dem(path); }, [&] { io::read_drawable(path); }}) {
        EXPECT_TRUE(has(error_of(read), "BadInput", "picture in colours", "--encoding terrain-rgb"));
    }
    // The formulas of the two encodings.
    expect_heights(path, [](int c, int r) { return c == 1 && r == 1 ? 0.1 : 0.0; },
                   {.encoding = io::HeightEncoding::terrain_rgb});
    picture({130.0, 5.0, 128.0});
    expect_heights(path, [](int c, int r) { return 517.5 + (c == 1 && r == 1 ? 1.0 / 256.0 : 0.0); },
                   {.encoding = io::HeightEncoding::terrarium});
    expect_heights(path, [](int, int) { return 130.0; }, {.band = "1"});
    EXPECT_THROW(io::read_dem(written(folder / "dem.tif", {}, slope), {.encoding = io::HeightEncoding::terrarium}),
                 BadInput);
}

TEST(OpenedHeights, DepthsChangeTheirSign) {
    ScratchFolder const folder;
    auto const tell = [](char const* key, char const* value) {
        return [=](GDALDataset& data) { data.GetRasterBand(1)->SetMetadataItem(key, value); };
    };
    auto const depth = [](int c, int r) { return -slope(c, r); };
    expect_heights(changed(folder, {}, tell("positive", "down")), depth);
    EXPECT_NE(found(io::read_dem_file(folder / "dem.tif").findings, "depths"), nullptr);
    EXPECT_EQ((io::read_stored_dem(folder / "dem.tif")[Cell{7, 3}]), static_cast<float>(depth(7, 3)));
    expect_heights(changed(folder, {}, tell("standard_name", "sea_floor_depth_below_geoid")), depth);
    expect_heights(changed(folder, {}, in_crs("EPSG:32632+5715")), depth); // MSL depth
    expect_heights(changed(folder, {}, tell("positive", "up")), slope);
    // A band of elevations under an axis that points down, as in BAG files.
    expect_heights(changed(folder, {},
                           [](GDALDataset& data) {
                               in_crs("EPSG:32632+5715")(data);
                               data.GetRasterBand(1)->SetDescription("elevation");
                           }),
                   slope);
    expect_heights(changed(folder, {}, tell("standard_name", "surface_altitude")), slope);
}

TEST(OpenedHeights, ABlockOfZerosIsRefusedWhereNoCoastIsSoSteep) {
    ScratchFolder const folder;
    auto const collar = [&](double lowest) {
        return written(folder / "dem.tif", {}, [=](int c, int r) {
            return c < 8 ? 0.0 : lowest + 0.2 * c + 0.1 * r; // differ by 9 m
        });
    };
    EXPECT_TRUE(
        has(error_of([&] { io::read_dem(collar(1200.0)); }), "BadInput io.read_dem", "cells of 0", "--nodata 0"));
    EXPECT_TRUE(has(error_of([&] { io::read_drawable(folder / "dem.tif"); }), "BadInput", "cells of 0"));
    io::DemFile const doubt = io::read_dem_file(collar(80.0));
    ASSERT_NE(found(doubt.findings, "zero_heights"), nullptr);
    EXPECT_EQ(found(doubt.findings, "zero_heights")->severity(), Severity::warning);
    EXPECT_EQ(found(doubt.findings, "zero_heights")->amount, 240.0);
    EXPECT_TRUE(io::read_dem_file(collar(20.0)).findings.empty()) << "a low cliff";
    EXPECT_EQ(io::read_dem_file(collar(1200.0), {.nodata = std::nan("")}).findings.size(), 0U);
    // In feet a gap of 900 is one of 274 m.
    std::string const feet = changed(folder, {}, in_crs("EPSG:26913+6360"),
                                     [](int c, int r) { return c < 8 ? 0.0 : 900.0 + 0.2 * c + 0.1 * r; });
    EXPECT_NE(found(io::read_dem_file(feet).findings, "zero_heights"), nullptr);
}

TEST(OpenedHeights, AHeaderTellsWhichFileHasTheData) {
    ScratchFolder const folder;
    GDALDatasetUniquePtr const dem(GDALDataset::Open(written(folder / "dem.tif", {}, slope).c_str(), GDAL_OF_RASTER));
    GDALDatasetUniquePtr const saga(GetGDALDriverManager()->GetDriverByName("SAGA")->CreateCopy(
        (folder / "saga.sdat").c_str(), dem.get(), 0, nullptr, nullptr, nullptr));
    EXPECT_TRUE(has(error_of([&] { io::read_dem(folder / "saga.sgrd"); }), "BadInput io.read_dem", "name that file",
                    "saga.sdat"));
}

TEST(OpenedHeights, ASiteHasMetresWithoutAPlace) {
    ScratchFolder const folder;
    auto const site = [](char const* unit, double metres) {
        return in_crs("LOCAL_CS[\"site\",UNIT[\"" + std::string(unit) + "\"," + std::to_string(metres) +
                      "],AXIS[\"x\",EAST],AXIS[\"y\",NORTH]]");
    };
    std::string const path = changed(folder, {.frame = {100.0, 2.0, 0.0, 300.0, 0.0, -2.0}}, site("metre", 1.0));
    EXPECT_EQ(io::read_dem(path).grid(), (Grid{40, 30, 2.0, 100.0, 300.0, ""}));
    EXPECT_NE(found(io::read_dem_file(path).findings, "site_grid"), nullptr);
    expect_heights(path, slope);
    changed(folder, {.frame = {100.0, 2.0, 0.0, 300.0, 0.0, -2.0}}, site("foot", 0.3048));
    EXPECT_NEAR(io::read_dem(path).grid().cell_m, 0.6096, 1e-12);
    Finding const* const unit = found(io::read_dem_file(path).findings, "heights_in_metres");
    ASSERT_NE(unit, nullptr) << "feet in plan, and no word on heights";
    EXPECT_EQ(unit->amount, 1.0);
}

TEST(OpenedHeights, RowsThatAreColumnsAreReadAsThese) {
    ScratchFolder const folder;
    // A quarter turn either way, and the two that mirror: column and row of the file by those of the map.
    struct Quarter {
        std::vector<double> frame;
        int (*col)(int c, int r);
        int (*row)(int c, int r);
    };
    for (Quarter const &quarter :
         {Quarter{
              {500000.0, 0.0, 30.0, 5000000.0, -30.0, 0.0}, [](int, int r) { return r; }, [](int c, int) { return c; }},
          Quarter{{500900.0, 0.0, -30.0, 5000000.0, -30.0, 0.0},
                  [](int, int r) { return r; },
                  [](int c, int) { return 29 - c; }},
          Quarter{{500000.0, 0.0, 30.0, 4998800.0, 30.0, 0.0},
                  [](int, int r) { return 39 - r; },
                  [](int c, int) { return c; }}}) {
        std::string const path = written(folder / "dem.tif", {.frame = quarter.frame}, slope);
        EXPECT_EQ(io::read_dem(path).grid(), (Grid{30, 40, 30.0, 500000.0, 5000000.0, "EPSG:32632"}));
        expect_heights(path, [&](int c, int r) { return slope(quarter.col(c, r), quarter.row(c, r)); });
        EXPECT_NE(found(io::read_dem_file(path).findings, "turned_raster"), nullptr);
    }
}

TEST(OpenedHeights, PositionsOffTheMapAreRefused) {
    ScratchFolder const folder;
    auto const placed = [&](double north) {
        return written(folder / "dem.tif", {.epsg = 4326, .frame = {7.0, 0.1, 0.0, north, 0.0, -0.1}}, slope);
    };
    for (double const north : {95.0, -88.0}) {
        std::string const path = placed(north);
        for (auto const& read :
             std::vector<std::function<void()>>{[&] { io::read_dem(path); }, [&] { io::read_drawable(path); }}) {
            EXPECT_TRUE(has(error_of(read), "BadInput", "latitude", "beyond a pole", "gdal_edit.py"));
        }
    }
    EXPECT_NO_THROW(io::read_dem(placed(90.05))) << "cells centred on the pole";
    std::string const path = changed(folder, {}, in_crs("EPSG:4978"));
    EXPECT_TRUE(
        has(error_of([&] { io::read_dem(path); }), "BadInput io.read_dem", "geocentric", "gdal_edit.py -a_srs"));
}

TEST(OpenedHeights, DegreesWithoutACrsAreRefused) {
    ScratchFolder const folder;
    auto const placed = [&](std::vector<double> const& frame) {
        return written(folder / "dem.tif", {.epsg = 0, .frame = frame}, slope);
    };
    for (auto const& frame :
         {std::vector{7.5, 0.0008333, 0.0, 46.5, 0.0, -0.0008333}, std::vector{-115.0, 0.01, 0.0, -20.0, 0.0, -0.01}}) {
        std::string const path = placed(frame);
        EXPECT_TRUE(has(error_of([&] { io::read_dem(path); }), "BadInput io.read_dem", "longitudes and latitudes",
                        "gdal_edit.py -a_srs"));
        EXPECT_THROW(io::read_drawable(path), BadInput);
        EXPECT_NO_THROW(io::read_dem(path, {.values = io::CellValues::numbers})) << "a mask has the grid's cells";
    }
    // A model of a few metres at the origin, and any raster of larger cells.
    EXPECT_EQ(io::read_dem(placed({0.0, 0.005, 0.0, 0.15, 0.0, -0.005})).grid().cell_m, 0.005);
    EXPECT_EQ(io::read_dem(placed({7.5, 1.0, 0.0, 46.5, 0.0, -1.0})).grid().cell_m, 1.0);
}

TEST(OpenedHeights, FeetInPlanAreMetresOfTheSameProjectionInPictures) {
    ScratchFolder const folder;
    Tiff const feet{.epsg = 2229, .frame = {6500000.0, 100.0, 0.0, 1900000.0, 0.0, -100.0}};
    io::Drawable const read = io::read_drawable(written(folder / "dem.tif", feet, slope));
    EXPECT_NEAR(read.dem.grid().cell_m, 100.0 * us_foot_m, 1e-9);
    EXPECT_NEAR(read.dem.grid().west, 6500000.0 * us_foot_m, 1e-6);
    EXPECT_EQ((read.dem[Cell{7, 3}]), static_cast<float>(slope(7, 3))) << "not resampled";
    EXPECT_NE(found(read.findings, "dem_reprojected"), nullptr);
    EXPECT_EQ(io::read_dem(folder / "dem.tif").grid().crs, "EPSG:2229");
}

TEST(OpenedHeights, OtherBodiesKeepTheirMetres) {
    ScratchFolder const folder;
    std::string const mars = "+proj=eqc +lat_ts=40 +R=3396190 +units=m +no_defs";
    std::string const path = changed(folder, {.frame = {0.0, 463.0, 0.0, 2000000.0, 0.0, -463.0}}, in_crs(mars));
    io::Drawable const read = io::read_drawable(path);
    EXPECT_EQ(read.dem.grid().cell_m, 463.0);
    EXPECT_TRUE(read.findings.empty());
    expect_heights(path, slope);
    // In degrees: an equal-area projection of that body.
    io::Drawable const degrees = io::read_drawable(
        changed(folder, {.frame = {20.0, 0.01, 0.0, 10.0, 0.0, -0.01}}, in_crs("+proj=longlat +R=3396190 +no_defs")));
    EXPECT_NEAR(degrees.dem.grid().cell_m, 3396190.0 * 0.01 * 3.14159265 / 180.0, 6.0);
    Grid const own = io::read_dem(folder / "dem.tif").grid();
    std::string const metric = io::metric_crs(own, "mars");
    EXPECT_TRUE(has(metric, "Equal area around 20, 10", "3396190"));
    EXPECT_TRUE(io::overlap_on_earth(own, own, "a", "b"));
    // The whole globe has heights, but no lengths.
    std::string const globe =
        changed(folder, {.frame = {-180.0, 9.0, 0.0, 90.0, 0.0, -6.0}}, in_crs("+proj=longlat +R=1737400 +no_defs"));
    EXPECT_NE(found(io::read_drawable(globe).findings, "stretched"), nullptr);
}

TEST(OpenedHeights, OwnHeightsOfDegreesAreWeightedByArea) {
    ScratchFolder const folder;
    Tiff const globe{.width = 36, .height = 18, .epsg = 4326, .frame = {-180.0, 10.0, 0.0, 90.0, 0.0, -10.0}};
    auto const by_latitude = [](int c, int r) { return std::fabs(r - 8.5) * 100.0 + c; };
    io::Drawable const read = io::read_drawable(written(folder / "dem.tif", globe, by_latitude), {.summarises = true});
    ASSERT_TRUE(read.own.has_value());
    EXPECT_EQ(read.own->cells, 36 * 18);
    EXPECT_EQ(read.own->min, 50.0);
    EXPECT_EQ(read.own->max, 885.0);
    // On a sphere, which the ellipsoid's figures follow to a few tenths of a percent.
    double sum = 0.0;
    double squares = 0.0;
    double areas = 0.0;
    for (int r = 0; r < 18; ++r) {
        constexpr double degree = 3.14159265358979 / 180.0;
        double const area = std::sin((90.0 - 10.0 * r) * degree) - std::sin((80.0 - 10.0 * r) * degree);
        for (int c = 0; c < 36; ++c) {
            sum += area * by_latitude(c, r);
            squares += area * by_latitude(c, r) * by_latitude(c, r);
            areas += area;
        }
    }
    double const mean = sum / areas;
    EXPECT_NEAR(read.own->mean, mean, 0.005 * mean);
    EXPECT_NEAR(read.own->std, std::sqrt(squares / areas - mean * mean), 0.01 * mean);
    EXPECT_FALSE(io::read_drawable(written(folder / "dem.tif", {}, slope), {.summarises = true}).own.has_value());
}

} // namespace opened_heights_test
