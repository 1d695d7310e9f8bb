// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// `thalweg rebuild`: terrain between rivers with heights, compared with a DEM.
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

namespace rebuild_test {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// Land of two seconds whose rivers are rebuilt from.
std::string const truth = "make -q --only dem,network --set grid.width=160 --set grid.height=128 --seed 3 -o ";

/// The data of a page.
json data_of(fs::path const& page) {
    std::string const html = file_bytes(page);
    std::string const begin = R"(<script type="application/json" id="data">)";
    std::size_t const from = html.find(begin) + begin.size();
    return json::parse(html.substr(from, html.find("</script>", from) - from));
}

} // namespace

TEST(Rebuild, MakesTheTerrainOnTheCellsOfTheDemAndComparesThem) {
    Workplace const place;
    expect_run(place, truth + "truth", 0);
    Outcome const run = expect_run(place, "rebuild truth --against truth/dem.tif -o out", 0, "compare", "dem.tif: r ");
    EXPECT_EQ(run.out, "out\n");
    json const report = report_of(place / "out");
    expect_checks_hold(report);
    EXPECT_EQ(report["recipe"]["network"]["heights"], "file");
    json const grid = report["recipe"]["grid"];
    EXPECT_EQ(grid["width"], 160);
    EXPECT_EQ(grid["origin"], report_of(place / "truth")["recipe"]["grid"]["origin"]);
    json const& against = report["against"];
    EXPECT_EQ(against["dem"], "dem.tif");
    EXPECT_EQ(against["cells"], (160 - 16) * (128 - 16));
    json const& terrains = against["terrains"];
    ASSERT_EQ(terrains.size(), 4U);
    EXPECT_GT(terrains["terrain"]["correlation"], 0.9);
    EXPECT_GT(terrains["terrain"]["same_reach"], 0.5);
    EXPECT_GT(terrains["terrain"]["correlation"], terrains["tin"]["correlation"]);
    for (char const* const name : {"cone", "dilation"}) { // they have the DEM's mean slope
        EXPECT_NEAR(terrains[name]["mean_slope_deg"], against["mean_slope_deg"], 0.05) << name;
    }
    EXPECT_TRUE(fs::exists(place / "out/against.png"));
    json const page = data_of(place / "out/report.html")["against"];
    ASSERT_EQ(page["rows"].size(), 4U);
    EXPECT_EQ(page["rows"][0]["correlation"], terrains["terrain"]["correlation"]);
    EXPECT_EQ(page["slopes"].size(), 5U);
    EXPECT_EQ(page["hypsometry"][0]["points"].size(), 101U);
    EXPECT_EQ(page["scatter"]["counts"].size(), 64U * 64U);
    EXPECT_EQ(page["difference"]["image"].get<std::string>().rfind("data:image/png;base64,iVBOR", 0), 0U);
    expect_run(place, "replay out --verify", 0);
}

TEST(Rebuild, TheDemItIsComparedWithDecidesNothingButItsCells) {
    Workplace const place;
    expect_run(place, truth + "truth", 0);
    expect_run(place, "make -q --only dem --set grid.width=160 --set grid.height=128 --seed 4 -o other_land", 0);
    std::string const quick = " --only dem,network -q -o ";
    expect_run(place, "rebuild truth --against truth/dem.tif" + quick + "one", 0);
    expect_run(place, "rebuild truth --against other_land/dem.tif" + quick + "other", 0);
    EXPECT_TRUE(file_bytes(place / "one/dem.tif") == file_bytes(place / "other/dem.tif"));
    Outcome const coarse =
        expect_run(place, "rebuild truth --against truth/dem.tif --set grid.cell=60 --dry-run --json -o coarse", 0);
    EXPECT_EQ(coarse.json()["grid"]["width"], 80);
}

TEST(Rebuild, TheMeanSlopeAndTheTextureMayBeThoseOfADem) {
    Workplace const place;
    expect_run(place, truth + "truth", 0);
    std::string const like = "rebuild truth --set grid.cell=30 --only dem -q --like ";
    expect_run(place, like + "truth/dem.tif -o out", 0);
    json const report = report_of(place / "out");
    json const& found = report["equilibrium"]["like"];
    EXPECT_NEAR(static_cast<double>(found["mean_slope_deg"]), 24.6, 1.0);
    EXPECT_EQ(found["lag_m"], 360.0);
    double const slope = report["dem"]["slope_true_deg"];
    // The rivers keep their heights, and uplift differs from place to place in the truth alone.
    EXPECT_NEAR(slope / static_cast<double>(found["mean_slope_deg"]), 1.0, 0.07);
    expect_run(place, "replay out --verify", 0);
    // A roughness that is given, or a slope, comes before it.
    expect_run(place, like + "truth/dem.tif --set surface.roughness=0.3 --set surface.mean_slope=22 -o asked", 0);
    json const asked = report_of(place / "asked");
    EXPECT_EQ(asked["equilibrium"]["like"]["roughness"], 0.3);
    EXPECT_NEAR(static_cast<double>(asked["dem"]["slope_true_deg"]), 22.0, 1.4);
    // Land of coarse cells says less.
    expect_run(place,
               "rebuild truth --set grid.cell=30 --like " + samples + "jacksboro_utm16.tif --only dem --dry-run -o x",
               0, "has cells of 90 m, the grid of 30 m");
}

TEST(Rebuild, HeightsAtSomeVerticesStayAndRiversMayEndInASink) {
    Workplace const place;
    // The last vertex of the first and both ends of the second lack heights; the third ends inland.
    test::write(
        place / "rivers.geojson",
        test::geojson(test::line("[500300,5003500,190],[500700,5002500],[500900,5001600,130],[500900,5000700]") + "," +
                      test::line("[502000,5003400],[501500,5002000,160],[500900,5000700]") + "," +
                      test::line("[500900,5000700],[501000,5000010,80]") + "," +
                      test::line("[503500,5003000,260],[503300,5001500,210]")));
    Outcome const run = expect_run(place,
                                   "rebuild rivers.geojson --set grid.cell=30 --set network.inland=sink "
                                   "--set surface.mean_slope=15 --only dem,network -o out",
                                   0, "missing in 3 of 4 lines of", "with some, which stay: 3");
    json const report = report_of(place / "out");
    expect_checks_hold(report);
    EXPECT_LT(report["given"]["heights"]["most_off_m"], 0.5) << report["given"].dump();
    // Without a slope: rivers of plains are told, and a DEM is asked for.
    test::write(place / "plain.geojson", test::geojson(test::line("[500300,5003500,12],[500900,5000700,10]") + "," +
                                                       test::line("[503500,5003500,13],[503300,5000700,10]")));
    expect_run(place, "rebuild plain.geojson --set grid.cell=30 --only dem,network -o plain", 0, "the land is gentle",
               "--like DEM");
}

TEST(Rebuild, RiversWhoseSlopesTellTooLittleStillLieInValleys) {
    Workplace const place;
    expect_run(place, truth + "truth", 0);
    expect_run(place, "rebuild truth --set grid.cell=30 --only dem -q -o out", 0);
    json const report = report_of(place / "out");
    EXPECT_GT(report["equilibrium"]["rebuilt"]["smooth_slope_deg"], 10.0); // 5.5 by the slopes of the sources
    for (json const& check : report["checks"]) {
        if (check["name"] == "land_below_rivers") {
            EXPECT_LT(check["value"], 0.1);
        }
    }
}

TEST(Rebuild, GapsOfTheDemAreNoLand) {
    Workplace const place;
    expect_run(place,
               "make " + samples +
                   "island.toml -q --only dem,network --set grid.width=200 --set grid.height=160 -o island",
               0);
    json const island = report_of(place / "island");
    expect_run(place, "rebuild island --against island/dem.tif --only dem,pictures -o out", 0, "gaps",
               " cells without data in island/dem.tif are no land");
    json const report = report_of(place / "out");
    EXPECT_EQ(report["dem"]["nodata"], island["dem"]["nodata"]);
    EXPECT_EQ(report["recipe"]["surface"]["edge"], "coast"); // rivers end at the gaps near height 0
    EXPECT_GT(report["against"]["terrains"]["terrain"]["correlation"], 0.7);
}

TEST(Rebuild, WhatItCannotUseIsRefusedInWords) {
    Workplace const place;
    expect_run(place, truth + "truth", 0);
    expect_run(place, "rebuild " + samples + "walker_nhdplus.gpkg -o out", 2, "without Z");
    expect_run(place, "rebuild truth --against " + samples + "jacksboro_utm16.tif -o out", 2, "no river");
    expect_run(place, "rebuild truth --against none.tif -o out", 2, "none.tif");
    expect_run(place, "rebuild truth --like none.tif -o out", 2, "none.tif");
    expect_run(place, "rebuild truth/dem.tif -o out", 2, "no rivers of a file");
    expect_run(place, "rebuild -o out", 2, "RIVERS");
    expect_run(place,
               "make truth --set surface.method=tin --set output.against=" + samples + "jacksboro_utm16.tif -o out", 2,
               "output.against", "same place");
    EXPECT_FALSE(fs::exists(place / "out"));
}

} // namespace rebuild_test
