// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/raster/raster_files.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/crs/crs.hpp>
#include <thalweg/io/raster/read_drawable.hpp>

#include "scratch_folder.hpp"
#include "tiff.hpp"

namespace read_dem_test {

using namespace thalweg;
using io::Drawable;
using io::read_drawable;
using test::error_of;
using test::has;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
Tiff const slopes;
Tiff const small{
    .width = 20, .height = 10, .epsg = 32631, .frame = {500000.0, 10.0, 0.0, 5000000.0, 0.0, -10.0}, .nodata = -9999.0};

using Heights = std::function<double(int, int)>;

double slope(int col, int row) {
    return 100.0 + 2.0 * col + 0.5 * row;
}

/// A slope with a block of side x side cells of one value.
Heights hole(double value, int side = 6) {
    return [=](int c, int r) { return c >= 10 && c < 10 + side && r >= 8 && r < 8 + side ? value : slope(c, r); };
}

std::string write(ScratchFolder const& folder, Heights const& value, Tiff const& wanted = slopes) {
    return written(folder / "dem.tif", wanted, value);
}

/// A GeoTIFF whose heights are 100 + column.
std::string make(ScratchFolder const& folder, std::string const& name, Tiff const& made) {
    return written(folder / name, made, [](int col, int) { return 100.0 + col; });
}

std::int64_t missing(Raster<float> const& dem) {
    return std::ranges::count_if(dem.values(), [](float z) { return std::isnan(z); });
}

/// What both readers of DEMs refuse in the same words.
std::string refusal(std::string const& path, io::ReadDemParams const& params = {}) {
    std::string const words = error_of([&] { io::read_dem(path, params); });
    std::string const other = error_of([&] { io::read_drawable(path, {.reading = params}); });
    auto const message = [](std::string const& text) { return text.substr(text.find(": ") + 2); };
    EXPECT_EQ(message(words), message(other)) << "one rule for all readers";
    return words;
}

bool notes_say(Drawable const& read, std::string const& words) {
    for (std::string const& note : texts_of(read.findings)) {
        if (note.find(words) != std::string::npos) {
            return true;
        }
    }
    return false;
}

Raster<float> plane(Grid const& grid, double east, double south) {
    return test::raster_of(grid, [&](Cell c) {
        Vec2 const p = grid.centre(c);
        return 100.0 + east * (p.x - grid.west) + south * (grid.north - p.y);
    });
}

Grid const utm{40, 30, 30.0, 500000.0, 4000000.0, "EPSG:32631"};

} // namespace

TEST(UndeclaredNodata, WhatNoTerrainHasIsRefusedWithTheRemedy) {
    for (double const value : {-9999.0, -32768.0, -32767.0, -99999.0}) {
        for (int const side : {1, 6}) {
            ScratchFolder const folder;
            std::string const path = write(folder, hole(value, side));
            EXPECT_TRUE(has(refusal(path), "BadInput io.read_dem", std::to_string(side * side) + " cells of",
                            "column 10, row 8", "-a_nodata " + std::to_string(static_cast<int>(value)) + " " + path));
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
        EXPECT_THROW(io::read_dem(path), BadInput) << sign;
        EXPECT_THROW(io::read_drawable(path), BadInput) << sign;
        EXPECT_EQ(missing(io::read_dem(path, {.nodata = sign * 3.4e38})), 36);
        EXPECT_EQ(missing(io::read_drawable(path, {.reading = {.nodata = sign * 3.4e38}}).dem), 36);
    }
}

TEST(UndeclaredNodata, TheSmallestFloatIsRefusedButNotTheSea) {
    ScratchFolder const folder;
    auto const tiny = static_cast<double>(std::numeric_limits<float>::min());
    std::string const path = write(folder, hole(tiny), {.nodata = -9999.0}); // what GDAL writes as HF2
    EXPECT_TRUE(has(refusal(path), "BadInput io.read_dem", "36 cells of 1.17549e-38"));
    EXPECT_EQ(missing(io::read_dem(path, {.nodata = tiny})), 36);
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(0.0)))), 0);
}

TEST(UndeclaredNodata, TheDeepSeaIsTerrain) {
    ScratchFolder const folder;
    auto const trench = [](int c, int r) { return -9980.0 - c - r; };
    EXPECT_EQ(missing(io::read_dem(write(folder, trench))), 0);
}

TEST(UndeclaredNodata, ABlockFarFromAllElseIsRefused) {
    ScratchFolder const folder;
    for (double const value : {-500.0, 9000.0, 20000.0}) {
        EXPECT_TRUE(has(refusal(write(folder, hole(value))), "BadInput io.read_dem", "column 11, row 9"));
        EXPECT_EQ(missing(io::read_dem(folder / "dem.tif", {.nodata = value})), 36);
    }
    EXPECT_TRUE(has(refusal(write(folder, hole(9000.0, 3))), "9000"));
    // Peaks, flats at the level of the terrain, the sea, and what is declared as terrain, are left alone.
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(9000.0, 2)))), 0);
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(20.0)))), 0);
    EXPECT_EQ(missing(io::read_dem(write(folder, hole(0.0)))), 0);
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
    io::DemFile const read = io::read_dem_file(path);
    EXPECT_EQ(missing(read.dem), 36);
    ASSERT_EQ(read.findings.size(), 1U);
    EXPECT_EQ(read.findings[0].kind, "nan_cells");
    EXPECT_EQ(read.findings[0].amount, 36.0);
    EXPECT_EQ(read.findings[0].text, "dem.tif: 36 cells are NaN and count as no-data");
    EXPECT_TRUE(has(io::read_drawable(path).findings.at(0).text, "36 cells are NaN"));
    EXPECT_TRUE(io::read_dem_file(write(folder, hole(none), {.nodata = none})).findings.empty());
    EXPECT_EQ(io::read_dem_file(write(folder, hole(-9999.0)), {.nodata = -9999.0}).findings.at(0).text,
              "dem.tif: 36 cells of -9999 are no-data");
}

TEST(UndeclaredNodata, PicturesOfMeansKnowTheValue) {
    ScratchFolder const folder;
    std::string const path = write(folder, hole(-9999.0, 7), {.width = 80, .height = 60});
    EXPECT_THROW(io::read_drawable(path, {.most_side = 16}), BadInput);
    Raster<float> const dem = io::read_drawable(path, {.most_side = 16, .reading = {.nodata = -9999.0}}).dem;
    EXPECT_EQ(dem.width(), 16);
    for (float const z : dem.values()) {
        EXPECT_TRUE(std::isnan(z) || z > 90.0F) << z;
    }
    std::string const both = write(folder, hole(-9999.0), {.nodata = 105.0});
    EXPECT_EQ(missing(io::read_drawable(both, {.reading = {.nodata = -9999.0}}).dem),
              missing(io::read_dem(both, {.nodata = -9999.0})));
}

TEST(NearlySquareCells, AreTakenWhereTheyMakeATenthOfACellAtMost) {
    ScratchFolder const folder;
    auto const high = [](double cell, Tiff wanted) {
        wanted.frame[5] = -cell;
        return wanted;
    };
    std::string const near = write(folder, slope, high(30.0007, {}));
    EXPECT_EQ(io::read_dem(near).grid(), (Grid{40, 30, 30.0, 500000.0, 5000000.0, "EPSG:32632"}));
    EXPECT_TRUE(io::read_drawable(near).findings.empty());
    // A tenth of a cell over 120 columns; and cells that are visibly not square, however few.
    for (Tiff const& wanted : {high(30.026, {.width = 120}), high(30.1, {.width = 4, .height = 4})}) {
        std::string const far = write(folder, slope, wanted);
        EXPECT_TRUE(has(error_of([&] { io::read_dem(far); }), "BadInput io.read_dem", "30"));
        EXPECT_EQ(io::read_drawable(far).findings.size(), 1U);
    }
}

TEST(ReadDem, WhatIsNotADemIsRefused) {
    ScratchFolder const folder;
    folder.write("text.tif", "no raster");
    folder.write("large.vrt", R"(<VRTDataset rasterXSize="2000000000" rasterYSize="2000000000">)"
                              R"(<VRTRasterBand dataType="Float32" band="1"/></VRTDataset>)");
    auto const constant = [&](double z, Tiff const& wanted = {.width = 4, .height = 3}) {
        static int count = 0;
        return written(folder / (std::to_string(++count) + ".tif"), wanted, [z](int, int) { return z; });
    };
    for (std::string const& path :
         {folder / "none.tif", std::string("/vsicurl/http://example.org/dem.tif"), folder / "text.tif",
          folder.path().string(), constant(none), constant(5.0, {.nodata = 5.0}),
          constant(-std::numeric_limits<double>::infinity())}) {
        EXPECT_TRUE(has(refusal(path), "BadInput io.read_dem")) << path;
    }
    EXPECT_THROW(io::read_dem(folder / "large.vrt"), BadInput); // before memory is asked for
    EXPECT_TRUE(has(refusal(constant(2e30)), "BadInput io.read_dem", "column 0, row 0"));
    EXPECT_EQ(io::read_dem(constant(9e29))[0], 9e29F);
    for (std::vector<double> const& frame : std::vector<std::vector<double>>{
             {0.0, 2.0, 0.1, 0.0, 0.0, -2.0}, {0.0, 2.0, 0.0, 0.0, 0.0, -2.5}, {0.0, 2.0, 0.0, 0.0, 0.0, -2.01}}) {
        EXPECT_TRUE(has(error_of([&] { io::read_dem(constant(1.0, {.frame = frame})); }), "BadInput io.read_dem"));
    }
    EXPECT_EQ(io::read_dem(constant(1.0, {.frame = {0.0, 2.0, 0.0, 0.0, 0.0, -2.000001}})).grid().cell_m, 2.0);
    EXPECT_THROW(io::read_dem(constant(1.0, {.bands = 3})), BadInput);
    EXPECT_THROW(read_drawable(make(folder, "dem.tif", small), {.most_side = 3}), BadParameter);
    EXPECT_THROW(io::read_dem(constant(1.0), test::stopped_run()), Cancelled);
}

TEST(ReadDem, ScaleOffsetAndForeignNoData) {
    ScratchFolder const folder;
    Raster<float> const dem = io::read_dem(written(folder / "dem.tif",
                                                   {.width = 4,
                                                    .height = 3,
                                                    .epsg = 0,
                                                    .frame = {100.0, 2.0, 0.0, 200.0, 0.0, -2.0},
                                                    .nodata = 7.0,
                                                    .scale = 0.1,
                                                    .offset = -3.0},
                                                   [](int c, int r) { return c == 1 && r == 2 ? 7.0 : 50.0; }));
    EXPECT_EQ(dem.grid(), (Grid{4, 3, 2.0, 100.0, 200.0, ""}));
    EXPECT_EQ((dem[Cell{0, 0}]), 2.0F);
    EXPECT_TRUE(std::isnan(dem[Cell{1, 2}]));
    EXPECT_EQ(missing(dem), 1);
}

TEST(ReadDem, GeographicKeepsItsCrsAndWithoutPlaceItStandsAtTheOrigin) {
    ScratchFolder const folder;
    folder.write("dem.asc", "ncols 2\nnrows 1\nxllcorner 7.5\nyllcorner 46\ncellsize 0.25\nNODATA_value -1\n3 -1\n");
    folder.write("dem.prj", R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                            R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433],AUTHORITY["EPSG","4326"]])");
    Raster<float> const dem = io::read_dem(folder / "dem.asc");
    EXPECT_EQ(dem.grid(), (Grid{2, 1, 0.25, 7.5, 46.25, "EPSG:4326"}));
    EXPECT_EQ(dem[0], 3.0F);
    EXPECT_TRUE(std::isnan(dem[1]));
    folder.write("dem.pgm", "P5 3 2 255\nabcdef");
    Raster<float> const grey = io::read_dem(folder / "dem.pgm");
    EXPECT_EQ(grey.grid(), (Grid{3, 2, 1.0, 0.0, 2.0, ""}));
    EXPECT_EQ((grey[Cell{2, 1}]), static_cast<float>('f'));
}

TEST(ReadDem, DamagedTilesNeverPassUnseen) {
    ScratchFolder const folder;
    Raster<float> const dem = test::raster_of(
        test::frame(600, 600), [](Cell c) { return std::sqrt(static_cast<double>(c.col * c.row)) + 300.0; });
    io::write_dem(dem, folder / "dem.tif");
    std::string const bytes = bytes_of(folder / "dem.tif");
    for (double const share : {0.4, 0.6, 0.8}) {
        std::string damaged = bytes;
        damaged.replace(static_cast<std::size_t>(share * static_cast<double>(bytes.size())), 5000,
                        std::string(5000, '\x55'));
        folder.write("damaged.tif", damaged);
        EXPECT_THROW(io::read_dem(folder / "damaged.tif"), Error) << share;
    }
    folder.write("cut.tif", bytes.substr(0, bytes.size() / 2));
    EXPECT_THROW(io::read_dem(folder / "cut.tif"), Error);
}

TEST(ReadDrawable, WhatReadDemTakesIsReadAlike) {
    ScratchFolder const folder;
    std::string const path = make(folder, "dem.tif", small);
    Drawable const read = read_drawable(path);
    EXPECT_TRUE(read.findings.empty());
    Raster<float> const dem = io::read_dem(path);
    EXPECT_EQ(read.dem.grid(), dem.grid());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        EXPECT_EQ(read.dem[i], dem[i]);
    }
}

TEST(ReadDrawable, LargeOnesBecomeMeansOfTheirKnownCells) {
    ScratchFolder const folder;
    Tiff made = small;
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
    Tiff made = small;
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
    Tiff feet = small;
    feet.epsg = 2229;
    feet.frame = {6500000.0, 100.0, 0.0, 1900000.0, 0.0, -100.0};
    Drawable const metres = read_drawable(make(folder, "feet.tif", feet));
    EXPECT_NEAR(metres.dem.grid().cell_m, 30.48, 0.05);
}

TEST(ReadDrawable, MetresThatAreNoneAreWarped) {
    ScratchFolder const folder;
    Tiff made = small;
    made.epsg = 3857;
    made.frame = {1000000.0, 30.0, 0.0, 5950000.0, 0.0, -30.0};
    std::string const path = make(folder, "mercator.tif", made);
    Drawable const read = read_drawable(path);
    EXPECT_EQ(read.dem.grid().crs, "EPSG:32632");
    EXPECT_NEAR(read.dem.grid().cell_m, 30.0 * 0.681, 0.2);
    EXPECT_TRUE(notes_say(read, "warped from WGS 84 / Pseudo-Mercator into WGS 84 / UTM zone 32N"));
    Drawable const kept = read_drawable(path, {.metres = io::MetresOf::any_crs});
    EXPECT_TRUE(kept.findings.empty());
    EXPECT_EQ(kept.dem.grid().crs, "EPSG:3857");
}

TEST(ReadDrawable, OddFramesBecomeNorthUpSquares) {
    ScratchFolder const folder;
    Tiff made = small;
    made.frame = {500000.0, 10.0, 0.0, 5000000.0, 0.0, -20.0};
    Drawable const tall = read_drawable(make(folder, "tall.tif", made));
    EXPECT_TRUE(notes_say(tall, "10 x 20 made squares"));
    EXPECT_NEAR(static_cast<double>(tall.dem.height()) * tall.dem.grid().cell_m, 200.0, 15.0);
    made.frame = {500000.0, 8.0, 6.0, 5000000.0, 6.0, -8.0};
    EXPECT_TRUE(notes_say(read_drawable(make(folder, "turned.tif", made)), "turned north-up"));
    made.frame = {500000.0, 10.0, 0.0, 5000000.0, 0.0, 10.0};
    Drawable const south_up = read_drawable(make(folder, "south.tif", made));
    EXPECT_TRUE(notes_say(south_up, "from south to north"));
    EXPECT_EQ(south_up.dem.width(), 20);
}

TEST(ReadDrawable, CellsTooSmallForTheirPositionAreRefused) {
    ScratchFolder const folder;
    for (double const cell : {1e-16, 1e-300}) {
        for (int const epsg : {32631, 4326, 2154, 0}) { // 2154: another zone; 4326 and unequal sides are warped
            for (double const high : {cell, 2.0 * cell}) {
                Tiff made = small;
                made.epsg = epsg;
                made.frame = {epsg == 4326 ? 3.0 : 500000.0, cell, 0.0, epsg == 4326 ? 45.0 : 5000000.0, 0.0, -high};
                std::string const path = make(folder, "tiny.tif", made);
                try {
                    Drawable const drawn = read_drawable(path);
                    EXPECT_GT(drawn.dem.cells(), 0) << epsg;
                } catch (BadInput const& refusal) {
                    EXPECT_TRUE(test::has(std::string(refusal.what()), "tiny.tif"));
                }
            }
        }
    }
    Tiff made = small;
    made.frame = {500000.0, 1e-16, 0.0, 5000000.0, 0.0, -2e-16};
    EXPECT_THROW(read_drawable(make(folder, "tiny.tif", made)), BadInput);
}

TEST(ReadDrawable, SaysWhatItHadToAssume) {
    ScratchFolder const folder;
    Tiff made = small;
    made.epsg = 0;
    EXPECT_TRUE(notes_say(read_drawable(make(folder, "crs.tif", made)), "no CRS"));
    made.frame.clear();
    EXPECT_TRUE(notes_say(read_drawable(make(folder, "place.tif", made)), "no position"));
}

TEST(WarpToGrid, LeavesWhatFits) {
    Raster<float> dem = plane(utm, 0.1, 0.2);
    dem[7] = std::numeric_limits<float>::quiet_NaN();
    Grid elsewhere = utm;
    elsewhere.west = 0.123;
    Raster<float> const same = io::warp_to_grid(dem, elsewhere, "test");
    EXPECT_EQ(same.grid(), utm);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        EXPECT_TRUE(same[i] == dem[i] || i == 7);
    }
    // Two without a CRS share their coordinates.
    Grid bare = utm;
    bare.crs = "";
    EXPECT_EQ(io::warp_to_grid(plane(bare, 0, 0), bare, "test").grid(), bare);
}

TEST(WarpToGrid, RefusesWhereOnlyOneSideHasACrs) {
    Grid bare = utm;
    bare.crs = "";
    auto const text = error_of([&] { io::warp_to_grid(plane(utm, 0, 0), bare, "a.tif"); });
    EXPECT_TRUE(has(text, "BadInput io.warp_to_grid: a.tif", "EPSG:32631"));
    EXPECT_THROW(io::warp_to_grid(plane(bare, 0, 0), utm, "a"), BadInput);
}

TEST(WarpToGrid, OtherCellsLieOnTheGridsLattice) {
    Grid fine = utm;
    fine.cell_m = 10.0;
    fine.west += 7.0;
    fine.width = 90;
    fine.height = 60;
    for (std::string const crs : {"EPSG:32631", ""}) {
        fine.crs = crs;
        Grid grid = utm;
        grid.crs = crs;
        Raster<float> const dem = io::warp_to_grid(plane(fine, 0.1, 0.2), grid, "test");
        EXPECT_EQ(dem.grid().cell_m, 30.0);
        EXPECT_EQ(std::fmod(dem.grid().west - grid.west, 30.0), 0.0);
        EXPECT_EQ(std::fmod(dem.grid().north - grid.north, 30.0), 0.0);
        std::int64_t known = 0;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            Vec2 const p = dem.grid().centre(dem.grid().at(i));
            double const inside = 45.0; // what a mean of 3 x 3 cells reaches
            if (p.x > fine.west + inside && p.x < fine.east() - inside && p.y < fine.north - inside &&
                p.y > fine.south() + inside) {
                EXPECT_NEAR(dem[i], 100.0 + 0.1 * (p.x - fine.west) + 0.2 * (fine.north - p.y), 0.02);
                ++known;
            }
        }
        EXPECT_GT(known, 300);
    }
}

TEST(Resample, CellsOfTheSameLatticeAreCutOut) {
    Raster<float> dem = plane(utm, 0.1, 0.2);
    dem[7] = std::numeric_limits<float>::quiet_NaN();
    Grid part = utm;
    part.west -= 2.0 * utm.cell_m;
    part.north += 3.0 * utm.cell_m;
    part.height = 7;
    Raster<float> const cut = io::resample(dem, part, "test");
    EXPECT_EQ(cut.grid(), part);
    for (std::int64_t i = 0; i < part.cells(); ++i) {
        Cell const c = part.at(i);
        bool const is_there = c.col >= 2 && c.row >= 3 && c != Cell{9, 3};
        EXPECT_EQ(std::isnan(cut[i]), !is_there) << i;
        EXPECT_TRUE(!is_there || (cut[i] == dem[Cell{c.col - 2, c.row - 3}])) << i;
    }
    EXPECT_TRUE(std::isnan(io::resample(dem, utm, "test")[7]));
}

TEST(Resample, OtherCellsAreWarpedToTheGrid) {
    Grid shifted = utm;
    shifted.west += 0.5 * utm.cell_m;
    shifted.width -= 1;
    Raster<float> const dem = io::resample(plane(utm, 0.1, 0.2), shifted, "test");
    EXPECT_EQ(dem.grid(), shifted);
    for (std::int64_t i = 0; i < shifted.cells(); ++i) {
        Vec2 const p = shifted.centre(shifted.at(i));
        EXPECT_NEAR(dem[i], 100.0 + 0.1 * (p.x - utm.west) + 0.2 * (utm.north - p.y), 1e-3);
    }
    shifted.crs = "";
    EXPECT_TRUE(has(error_of([&] { io::resample(plane(utm, 0.1, 0.2), shifted, "a.tif"); }), "BadInput"));
}

TEST(WarpToGrid, RealLandComesIntoItsZone) {
    Raster<float> const srtm = io::read_dem(THALWEG_SOURCE_DIR "/samples/jacksboro_srtm3.tif");
    EXPECT_EQ(io::metric_crs(srtm.grid(), "srtm"), "EPSG:32616");
    Grid const grid{400, 300, 90.0, 737000.0, 4060000.0, "EPSG:32616"};
    EXPECT_TRUE(io::overlap_on_earth(srtm.grid(), grid, "a", "b"));
    EXPECT_FALSE(io::overlap_on_earth(srtm.grid(), utm, "a", "b"));
    Raster<float> const dem = io::warp_to_grid(srtm, grid, "test");
    EXPECT_EQ(dem.grid().crs, "EPSG:32616");
    // 403 x 344 cells of 3 seconds are about 30 x 32 km.
    EXPECT_NEAR(static_cast<double>(dem.width()) * 90.0, 31500.0, 1200.0);
    EXPECT_NEAR(static_cast<double>(dem.height()) * 90.0, 32900.0, 1200.0);
    double mean = 0.0;
    double count = 0.0;
    double own = 0.0;
    for (float const z : dem.values()) {
        mean += std::isnan(z) ? 0.0 : z;
        count += std::isnan(z) ? 0.0 : 1.0;
    }
    for (float const z : srtm.values()) {
        own += z;
    }
    EXPECT_NEAR(mean / count, own / static_cast<double>(srtm.cells()), 1.0);
    EXPECT_TRUE(std::isnan(dem[0])); // the corners are turned: there is no data
}

TEST(WarpToGrid, WhatWouldNotFitInMemoryIsRefused) {
    Grid tiny = utm;
    tiny.cell_m = 1e-6;
    EXPECT_THROW(io::warp_to_grid(plane(utm, 0, 0), tiny, "a"), BadInput);
}

TEST(WarpToGrid, CellsTooSmallForTheirPositionAreRefused) {
    Grid tiny = utm;
    for (double const cell : {1e-16, 1e-300}) {
        tiny.cell_m = cell;
        EXPECT_THROW(io::warp_to_grid(plane(utm, 0.1, 0.2), tiny, "test"), BadInput) << cell;
        Raster<float> const speck = io::warp_to_grid(plane(tiny, 0.1, 0.2), utm, "test"); // smaller than a cell
        EXPECT_EQ(speck.cells(), 1) << cell;
        EXPECT_EQ(speck.grid().cell_m, utm.cell_m);
    }
}

TEST(SameFrame, ComparesCrsAndCells) {
    Raster<float> const dem = plane(utm, 0, 0);
    EXPECT_TRUE(io::same_crs("EPSG:32631", "EPSG:32631", "a", "b"));
    EXPECT_FALSE(io::same_crs("EPSG:32631", "EPSG:32632", "a", "b"));
    EXPECT_TRUE(io::same_crs("EPSG:32631+5773", "EPSG:32631", "a", "b")); // heights above the geoid: the same plan
    EXPECT_TRUE(io::same_crs("", "", "a", "b"));
    EXPECT_THROW(io::same_crs("nonsense", "EPSG:32631", "a", "b"), BadInput);
    Grid other = utm;
    other.west += 0.2;
    EXPECT_TRUE(io::same_cells(utm, other));
    other.west += 2.0;
    EXPECT_FALSE(io::same_cells(utm, other));
    other = utm;
    other.cell_m *= 1.001;
    EXPECT_FALSE(io::same_cells(utm, other));
    EXPECT_FALSE(io::same_size(utm, other));
    EXPECT_TRUE(io::same_size(utm, utm));
    EXPECT_TRUE(io::overlap_on_earth(utm, utm, "a", "b"));
    EXPECT_EQ(io::metric_crs(utm, "a"), "EPSG:32631");
    // Across the antimeridian, from either side.
    Grid const fiji{10, 10, 0.2, 179.0, -16.0, "EPSG:4326"};
    Grid const beyond{10, 10, 0.1, -180.0, -16.5, "EPSG:4326"};
    EXPECT_TRUE(io::overlap_on_earth(fiji, beyond, "a", "b"));
    EXPECT_TRUE(io::overlap_on_earth(beyond, fiji, "a", "b"));
    Grid nowhere = utm;
    nowhere.west = 1e300;
    EXPECT_TRUE(has(error_of([&] { io::overlap_on_earth(utm, nowhere, "a.tif", "b.tif"); }), "b.tif lies where"));
}

TEST(ReadMask, TakesCellsThatAreNeitherZeroNorNoData) {
    ScratchFolder const folder;
    Raster<float> values(utm);
    values[3] = 1.0F;
    values[4] = -2.5F;
    values[5] = std::numeric_limits<float>::quiet_NaN();
    io::write_dem(values, folder / "a.tif");
    Mask const mask = io::read_mask(folder / "a.tif", utm);
    EXPECT_EQ(mask.grid(), utm);
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        EXPECT_EQ(mask[i], i == 3 || i == 4 ? 1 : 0);
    }
    io::write_mask(mask, folder / "b.tif");
    Mask const again = io::read_mask(folder / "b.tif", utm);
    EXPECT_EQ(again[3] + again[4], 2);
    Grid other = utm;
    other.width = 41;
    EXPECT_TRUE(has(error_of([&] { io::read_mask(folder / "b.tif", other); }), "BadInput", "40 x 30"));
    for (std::string const crs : {"EPSG:32632", ""}) {
        other = utm;
        other.crs = crs;
        EXPECT_THROW(io::read_mask(folder / "b.tif", other), BadInput) << crs;
    }
    EXPECT_TRUE(has(error_of([&] { io::read_mask(folder / "c.tif", utm); }), "BadInput", "c.tif"));
}

} // namespace read_dem_test
