// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include <thalweg/io/raster/raster_files.hpp>

#include "blend_runs.hpp"

namespace blend_test {

using blend_runs::blend;
using blend_runs::refused;

namespace fs = std::filesystem;
using namespace thalweg;

namespace {

Grid const target_grid{60, 50, 30.0, 500000.0, 4000000.0, "EPSG:32631"};

/// A slope to the east, and waves on it where a source is wanted.
Raster<float> land(Grid const& grid, double waves) {
    return test::raster_of(grid, [&](Cell c) {
        return static_cast<float>(c.col) + static_cast<float>(waves) * static_cast<float>((c.col * 7 + c.row * 5) % 11);
    });
}

void write(Workplace const& place, std::string const& name, Raster<float> const& dem) {
    io::write_dem(dem, (place / name).string());
}

Raster<float> read(Workplace const& place, std::string const& name) {
    return io::read_dem((place / name).string());
}

/// A target of 60 x 50 cells and a source of 20 x 16 that lies in it from column 10, row 8 on.
void write_lands(Workplace const& place) {
    write(place, "target.tif", land(target_grid, 0.0));
    Grid frame = target_grid;
    frame.width = 20;
    frame.height = 16;
    frame.west += 300.0;
    frame.north -= 240.0;
    write(place, "source.tif", land(frame, 3.0));
}

std::int64_t changed(Raster<float> const& a, Raster<float> const& b) {
    std::int64_t cells = 0;
    for (std::int64_t i = 0; i < a.cells(); ++i) {
        cells += a[i] != b[i] ? 1 : 0;
    }
    return cells;
}

std::string const ring = R"("coordinates":[[[500450,3999400],[500750,3999400],[500750,3999600],[500450,3999600],)"
                         R"([500450,3999400]]]})";

std::string shapes(std::string const& geometry) {
    return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32631"}},)"
           R"("features":[{"type":"Feature","properties":{},"geometry":)" +
           geometry + "}]}";
}

} // namespace

TEST(Blend, LiesWhereItsOwnCoordinatesSay) {
    Workplace const place;
    write_lands(place);
    Outcome const o = blend(place, "target.tif source.tif -o out.tif --json");
    ASSERT_EQ(o.code, 0) << o.err;
    auto const json = nlohmann::json::parse(o.out);
    EXPECT_EQ(json["file"], "out.tif");
    EXPECT_EQ(json["place"], "own");
    EXPECT_EQ(json["at"], (nlohmann::json{500600.0, 3999520.0}));
    EXPECT_EQ(json["cells"], 18 * 14); // the source's outermost cells tell its edge
    EXPECT_EQ(json["warped"], false);
    EXPECT_EQ(json["outside"], 0);
    EXPECT_LE(json["residual"], 1e-10);
    EXPECT_GT(json["seam_max_m"], json["seam_rms_m"]);
    Raster<float> const before = read(place, "target.tif");
    Raster<float> const after = read(place, "out.tif");
    EXPECT_EQ(after.grid(), before.grid());
    for (std::int64_t i = 0; i < before.cells(); ++i) {
        Cell const c = before.grid().at(i);
        bool const inside = c.col > 10 && c.col < 29 && c.row > 8 && c.row < 23;
        EXPECT_TRUE(inside || after[i] == before[i]) << c.col << " " << c.row;
    }
    EXPECT_GT(changed(before, after), 18 * 14 / 2);
    EXPECT_TRUE(
        test::has(blend(place, "target.tif source.tif -o b.tif").err, "blend      252 cells around (500600.000"));
    EXPECT_EQ(blend(place, "-q target.tif source.tif -o c.tif").err, "");
    EXPECT_EQ(file_bytes(place / "out.tif"), file_bytes(place / "c.tif"));
}

TEST(Blend, TheTargetInItselfIsTheTarget) {
    Workplace const place;
    write(place, "target.tif", land(target_grid, 1.0));
    for (std::string const how : {"--window 5,6,30,20", "--window 0,0,30,20 --feather 4",
                                  "--window 5,6,30,20 --mixed --feather 2.5", "--window 0,0,59,50 --fill-holes"}) {
        ASSERT_EQ(blend(place, "target.tif target.tif -o out.tif --overwrite " + how).code, 0) << how;
        EXPECT_EQ(changed(read(place, "target.tif"), read(place, "out.tif")), 0) << how;
    }
}

TEST(Blend, GoesWhereItIsAskedToAndElseToTheMiddle) {
    Workplace const place;
    write_lands(place);
    Outcome const there =
        blend(place, "target.tif source.tif -o a.tif --at 501200,3999000 --rotate 90 --scale 0.5 --gain 2 --json");
    ASSERT_EQ(there.code, 0) << there.err;
    auto json = nlohmann::json::parse(there.out);
    EXPECT_EQ(json["place"], "given");
    EXPECT_EQ(json["at"], (nlohmann::json{501200.0, 3999000.0}));
    EXPECT_GT(json["cells"], 30);
    EXPECT_LT(json["cells"], 80);
    Grid far = target_grid;
    far.west += 90000.0;
    far.width = 15;
    far.height = 16;
    write(place, "far.tif", land(far, 3.0));
    Outcome const middle = blend(place, "target.tif far.tif -o b.tif --json");
    ASSERT_EQ(middle.code, 0) << middle.err;
    json = nlohmann::json::parse(middle.out);
    EXPECT_EQ(json["place"], "middle");
    EXPECT_EQ(json["at"], (nlohmann::json{500915.0, 3999250.0})); // 15 columns: the middle of a cell
    EXPECT_EQ(json["cells"], 13 * 14);
    EXPECT_TRUE(test::has(middle.err, "the centre of the target, because the source lies outside it"));
}

TEST(Blend, RealLandOfAnotherCrsAndSomewhereElse) {
    Workplace const place;
    write(place, "target.tif", land(target_grid, 0.0));
    std::string const srtm = THALWEG_SOURCE_DIR "/samples/jacksboro_srtm3.tif";
    Outcome const o = blend(place, "target.tif " + srtm + " -o out.tif --window 100,80,12,10 --feather 3 --json");
    ASSERT_EQ(o.code, 0) << o.err;
    auto const json = nlohmann::json::parse(o.out);
    EXPECT_EQ(json["place"], "middle");
    EXPECT_EQ(json["warped"], true);
    // 12 x 10 cells of 3 seconds, in metres, are about 890 x 925 m: 30 x 31 cells less the edge.
    EXPECT_NEAR(json["cells"].get<double>(), 28.0 * 29.0, 120.0);
    // In degrees, into degrees, at its own place.
    Outcome const same = blend(place, srtm + " " + srtm + " -o same.tif --window 100,80,12,10 --json");
    ASSERT_EQ(same.code, 0) << same.err;
    EXPECT_EQ(nlohmann::json::parse(same.out)["place"], "own");
    EXPECT_EQ(changed(io::read_dem(srtm), read(place, "same.tif")), 0);
    refused(place, srtm + " " + srtm + " -o a.tif --window 100,80,12,10 --rotate 5", "is in degrees");
    refused(place, srtm + " target.tif -o a.tif", "whose cells are not in metres");
    // On the same part of the earth it comes into the target's CRS.
    write(place, "near.tif", land(Grid{200, 200, 90.0, 740000.0, 4055000.0, "EPSG:32616"}, 0.0));
    Outcome const window = blend(place, "near.tif " + srtm + " -o near_out.tif --json --window 150,150,60,60");
    ASSERT_EQ(window.code, 0) << window.err;
    EXPECT_EQ(nlohmann::json::parse(window.out)["place"], "own");
    EXPECT_EQ(nlohmann::json::parse(window.out)["warped"], true);
}

TEST(Blend, MasksAndRiversSayWhatStays) {
    Workplace const place;
    write_lands(place);
    place.write("mask.geojson", shapes(R"({"type":"Polygon",)" + ring));
    Outcome const polygons = blend(place, "target.tif source.tif -o a.tif --mask mask.geojson --json");
    ASSERT_EQ(polygons.code, 0) << polygons.err;
    EXPECT_EQ(nlohmann::json::parse(polygons.out)["cells"], 10 * 7);
    Raster<float> const before = read(place, "target.tif");
    Raster<float> cells = test::raster_of(
        target_grid, [&](Cell c) { return c.col >= 25 && c.col < 35 && c.row >= 10 && c.row < 15 ? 1.0F : 0.0F; });
    write(place, "mask.tif", cells);
    Outcome const raster = blend(place, "target.tif source.tif -o b.tif --mask mask.tif --json");
    ASSERT_EQ(raster.code, 0) << raster.err;
    EXPECT_EQ(nlohmann::json::parse(raster.out)["cells"], 4 * 5);
    EXPECT_EQ(nlohmann::json::parse(raster.out)["outside"], 6 * 5);
    // A river through the patch, from beyond the target's edge.
    place.write("river.geojson", shapes(R"({"type":"LineString","coordinates":[[400000,3999505],[700000,3999505]]})"));
    Outcome const river = blend(place, "target.tif source.tif -o c.tif --keep river.geojson --json");
    ASSERT_EQ(river.code, 0) << river.err;
    EXPECT_EQ(nlohmann::json::parse(river.out)["kept"], 18);
    Raster<float> const after = read(place, "c.tif");
    for (std::int64_t col = 0; col < 60; ++col) {
        EXPECT_EQ((after[{col, 16}]), (before[{col, 16}]));
    }
    Outcome const kept = blend(place, "target.tif source.tif -o d.tif --keep mask.tif --json");
    ASSERT_EQ(kept.code, 0) << kept.err;
    EXPECT_EQ(nlohmann::json::parse(kept.out)["kept"], 4 * 5);
}

TEST(Blend, HolesOfTheSourceStayOrAreFilled) {
    Workplace const place;
    write_lands(place);
    Raster<float> source = read(place, "source.tif");
    for (std::int64_t row = 6; row < 9; ++row) {
        for (std::int64_t col = 5; col < 9; ++col) {
            source[{col, row}] = std::numeric_limits<float>::quiet_NaN();
        }
    }
    write(place, "holes.tif", source);
    Outcome const left = blend(place, "target.tif holes.tif -o a.tif --json");
    ASSERT_EQ(left.code, 0) << left.err;
    EXPECT_EQ(nlohmann::json::parse(left.out)["holes"], 12);
    EXPECT_EQ(nlohmann::json::parse(left.out)["cells"], 240);
    EXPECT_TRUE(test::has(left.err, "12 cells in holes of the source are left as they were"));
    Outcome const filled = blend(place, "target.tif holes.tif -o b.tif --fill-holes --json");
    ASSERT_EQ(filled.code, 0) << filled.err;
    EXPECT_EQ(nlohmann::json::parse(filled.out)["cells"], 252);
}

TEST(Blend, NothingIsOverwrittenUnasked) {
    Workplace const place;
    write_lands(place);
    place.write("out.tif", "mine");
    refused(place, "target.tif source.tif -o out.tif", "out.tif already exists");
    EXPECT_EQ(file_bytes(place / "out.tif"), "mine");
    EXPECT_EQ(blend(place, "target.tif source.tif -o out.tif --overwrite").code, 0);
    // Onto itself: it has been read whole before.
    EXPECT_EQ(blend(place, "target.tif source.tif -o target.tif --overwrite").code, 0);
    EXPECT_EQ(file_bytes(place / "target.tif"), file_bytes(place / "out.tif"));
}

TEST(Blend, BadInputIsRefused) {
    Workplace const place;
    write_lands(place);
    Grid bare = target_grid;
    bare.crs = "";
    write(place, "bare.tif", land(bare, 1.0));
    write(place, "one.tif", land(Grid{1, 1, 30.0, 500000.0, 4000000.0, "EPSG:32631"}, 1.0));
    Grid small = target_grid;
    small.width = 59;
    write(place, "small.tif", land(small, 1.0));
    write(place, "zeros.tif", Raster<float>(target_grid, 0.0F));
    place.write("void.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 30\nNODATA_value -9999\n"
                            "-9999 -9999\n-9999 -9999\n");
    place.write("points.csv", "x,y,z\n1,1,1\n");
    place.write("away.geojson", shapes(R"({"type":"Polygon","coordinates":[[[1,1],[2,1],[2,2],[1,1]]]})"));
    place.write("dry.geojson", shapes(R"({"type":"LineString","coordinates":[[400000,1],[700000,1]]})"));
    refused(place, "", "TARGET");
    refused(place, "target.tif", "SOURCE");
    refused(place, "target.tif source.tif", "--output");
    refused(place, "nowhere.tif source.tif -o a.tif", "nowhere.tif does not exist");
    refused(place, "target.tif nowhere.tif -o a.tif", "nowhere.tif does not exist");
    refused(place, "void.asc source.tif -o a.tif", "holds no heights");
    refused(place, "target.tif bare.tif -o a.tif", "bare.tif has no CRS, the target target.tif has EPSG:32631");
    refused(place, "bare.tif target.tif -o a.tif", "target.tif has EPSG:32631, the target bare.tif has no CRS");
    refused(place, "target.tif one.tif -o a.tif", "has all its neighbours on the source");
    refused(place, "one.tif target.tif -o a.tif", "all 1 x 1 cells of the target would change");
    refused(place, "target.tif target.tif -o a.tif", "all 60 x 50 cells of the target would change");
    refused(place, "target.tif source.tif -o a.tif --at 900000,1", "covers no cell of the target");
    refused(place, "target.tif source.tif -o a.tif --at 900000", "--at has 1 numbers");
    refused(place, "target.tif source.tif -o a.tif --at 1,2,3", "--at has 3 numbers");
    refused(place, "target.tif source.tif -o a.tif --at here", "--at");
    refused(place, "target.tif source.tif -o a.tif --at nan,1", "finite coordinates");
    refused(place, "target.tif source.tif -o a.tif --window 1,2,3", "--window has 3 numbers");
    refused(place, "target.tif source.tif -o a.tif --window 10,0,11,4", "of a source of 20 x 16 cells");
    refused(place, "target.tif source.tif -o a.tif --scale 0", "scale is 0");
    refused(place, "target.tif source.tif -o a.tif --scale nan", "scale is nan");
    refused(place, "target.tif source.tif -o a.tif --gain inf", "gain is inf");
    refused(place, "target.tif source.tif -o a.tif --rotate 400", "--rotate");
    refused(place, "target.tif source.tif -o a.tif --feather -1", "--feather");
    refused(place, "target.tif source.tif -o a.tif --mask none.gpkg", "none.gpkg does not exist");
    refused(place, "target.tif source.tif -o a.tif --mask zeros.tif", "the mask holds no cell of the target");
    refused(place, "target.tif source.tif -o a.tif --mask small.tif", "has 59 x 50 cells");
    refused(place, "target.tif source.tif -o a.tif --mask away.geojson", "away.geojson lie between (1.000, 1.000)");
    refused(place, "target.tif source.tif -o a.tif --keep points.csv", "holds points");
    refused(place, "target.tif source.tif -o a.tif --keep dry.geojson", "no line of dry.geojson crosses the target");
    refused(place, "target.tif source.tif -o none/a.tif", "there is no folder none");
}

} // namespace blend_test
