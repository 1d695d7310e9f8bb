// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/io/raster/raster_files.hpp>

#include "command.hpp"

namespace blend_test {

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

std::string const ring = "[[[500450,3999400],[500750,3999400],[500750,3999600],[500450,3999600],[500450,3999400]]]";

/// What blend says of itself, as JSON.
nlohmann::json blend(Workplace const& place, std::string const& arguments) {
    Outcome const run = expect_run(place, "blend " + arguments + " --json", 0);
    return run.code == 0 ? run.json() : nlohmann::json();
}

} // namespace

TEST(Blend, WritesGeoTiffsOfNoOtherName) {
    Workplace const place;
    write_lands(place);
    for (char const* const name : {"out.png", "out.asc", "out.npy"}) {
        Outcome const run = expect_run(place, std::string("blend target.tif source.tif -o ") + name, 2);
        EXPECT_TRUE(test::has(run.err, "a GeoTIFF is written, whose name ends in .tif")) << run.err;
        EXPECT_FALSE(std::filesystem::exists(place / std::string(name)));
    }
    expect_run(place, "blend target.tif source.tif -o OUT.TIF", 0);
}

TEST(Blend, LiesWhereItsOwnCoordinatesSay) {
    Workplace const place;
    write_lands(place);
    auto const json = blend(place, "target.tif source.tif -o out.tif");
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
    EXPECT_EQ(expect_run(place, "blend -q target.tif source.tif -o c.tif", 0).err, "");
    EXPECT_EQ(file_bytes(place / "out.tif"), file_bytes(place / "c.tif"));
}

TEST(Blend, GoesWhereItIsAskedToAndElseToTheMiddle) {
    Workplace const place;
    write_lands(place);
    auto json = blend(place, "target.tif source.tif -o a.tif --at 501200,3999000 --rotate 90 --scale 0.5 --gain 2");
    EXPECT_EQ(json["place"], "given");
    EXPECT_EQ(json["at"], (nlohmann::json{501200.0, 3999000.0}));
    EXPECT_GT(json["cells"], 30);
    EXPECT_LT(json["cells"], 80);
    Grid far = target_grid;
    far.west += 90000.0;
    far.width = 15;
    far.height = 16;
    write(place, "far.tif", land(far, 3.0));
    json = blend(place, "target.tif far.tif -o b.tif");
    EXPECT_EQ(json["place"], "middle");
    EXPECT_EQ(json["at"], (nlohmann::json{500915.0, 3999250.0})); // 15 columns: the middle of a cell
    EXPECT_EQ(json["cells"], 13 * 14);
}

TEST(Blend, SourcesInAnotherCrsAreWarped) {
    Workplace const place;
    write(place, "target.tif", land(target_grid, 0.0));
    std::string const srtm = samples + "jacksboro_srtm3.tif";
    auto const json = blend(place, "target.tif " + srtm + " -o out.tif --window 100,80,12,10 --feather 3");
    EXPECT_EQ(json["place"], "middle");
    EXPECT_EQ(json["warped"], true);
    // 12 x 10 cells of 3 seconds, in metres, are about 890 x 925 m: 30 x 31 cells less the edge.
    EXPECT_NEAR(json["cells"].get<double>(), 28.0 * 29.0, 120.0);
    // In degrees, into degrees, at its own place.
    EXPECT_EQ(blend(place, srtm + " " + srtm + " -o same.tif --window 100,80,12,10")["place"], "own");
    EXPECT_EQ(changed(io::read_dem(srtm), read(place, "same.tif")), 0);
    // On the same part of the earth it comes into the target's CRS.
    write(place, "near.tif", land(Grid{200, 200, 90.0, 740000.0, 4055000.0, "EPSG:32616"}, 0.0));
    auto const window = blend(place, "near.tif " + srtm + " -o near_out.tif --window 150,150,60,60");
    EXPECT_EQ(window["place"], "own");
    EXPECT_EQ(window["warped"], true);
    expect_refused(place, "blend -o a.tif " + srtm, {srtm + " --window 100,80,12,10 --rotate 5", "target.tif"});
}

TEST(Blend, MasksAndRiversSayWhatStays) {
    Workplace const place;
    write_lands(place);
    place.write("mask.geojson", test::geojson(test::feature("Polygon", ring)));
    EXPECT_EQ(blend(place, "target.tif source.tif -o a.tif --mask mask.geojson")["cells"], 10 * 7);
    write(place, "mask.tif", test::raster_of(target_grid, [&](Cell c) {
              return c.col >= 25 && c.col < 35 && c.row >= 10 && c.row < 15 ? 1.0F : 0.0F;
          }));
    auto const raster = blend(place, "target.tif source.tif -o b.tif --mask mask.tif");
    EXPECT_EQ(raster["cells"], 4 * 5);
    EXPECT_EQ(raster["outside"], 6 * 5);
    // A river through the patch, from beyond the target's edge.
    place.write("river.geojson", test::geojson(test::line("[400000,3999505],[700000,3999505]")));
    EXPECT_EQ(blend(place, "target.tif source.tif -o c.tif --keep river.geojson")["kept"], 18);
    Raster<float> const before = read(place, "target.tif");
    Raster<float> const after = read(place, "c.tif");
    for (std::int64_t col = 0; col < 60; ++col) {
        EXPECT_EQ((after[{col, 16}]), (before[{col, 16}]));
    }
    EXPECT_EQ(blend(place, "target.tif source.tif -o d.tif --keep mask.tif")["kept"], 4 * 5);
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
    auto const kept = blend(place, "target.tif holes.tif -o a.tif");
    EXPECT_EQ(kept["holes"], 12);
    EXPECT_EQ(kept["cells"], 240);
    EXPECT_EQ(blend(place, "target.tif holes.tif -o b.tif --fill-holes")["cells"], 252);
}

TEST(Blend, NothingIsOverwrittenUnasked) {
    Workplace const place;
    write_lands(place);
    place.write("out.tif", "mine");
    expect_refused(place, "blend", {"target.tif source.tif -o out.tif"});
    expect_run(place, "blend target.tif source.tif -o out.tif --overwrite", 0);
    // Onto itself: it has been read completely before.
    expect_run(place, "blend target.tif source.tif -o target.tif --overwrite", 0);
    EXPECT_EQ(file_bytes(place / "target.tif"), file_bytes(place / "out.tif"));
}

TEST(Blend, BadInputIsRefused) {
    Workplace const place;
    write_lands(place);
    Grid bare = target_grid;
    bare.crs = "";
    write(place, "bare.tif", land(bare, 1.0));
    Grid narrow = target_grid;
    narrow.width = 59;
    write(place, "narrow.tif", land(narrow, 1.0));
    write(place, "zeros.tif", Raster<float>(target_grid, 0.0F));
    place.write("points.csv", "x,y,z\n1,1,1\n");
    place.write("away.geojson", test::geojson(test::feature("Polygon", "[[[1,1],[2,1],[2,2],[1,1]]]")));
    place.write("dry.geojson", test::geojson(test::line("[400000,1],[700000,1]")));
    expect_refused(place, "blend", {"", "target.tif", "target.tif source.tif"});
    expect_refused(place, "blend -o a.tif",
                   {"nowhere.tif source.tif", "target.tif nowhere.tif", "target.tif bare.tif", "bare.tif target.tif",
                    "target.tif target.tif"});
    expect_refused(place, "blend target.tif source.tif -o a.tif",
                   {"--at 900000,1", "--at 900000", "--at 1,2,3", "--at here", "--at nan,1", "--window 1,2,3",
                    "--window 10,0,11,4", "--scale 0", "--scale nan", "--gain inf", "--rotate 400", "--feather -1",
                    "--mask none.gpkg", "--mask zeros.tif", "--mask narrow.tif", "--mask away.geojson",
                    "--keep points.csv", "--keep dry.geojson"});
    expect_refused(place, "blend target.tif source.tif -o none/a.tif", {""});
}

} // namespace blend_test
