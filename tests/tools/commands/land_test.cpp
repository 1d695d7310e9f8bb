// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Land from numbers and from points, as the command line makes it.
#include <cmath>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include "command.hpp"
#include "refused.hpp"
#include "report.hpp"

namespace land_test {

namespace fs = std::filesystem;

namespace {

std::string const samples = THALWEG_SOURCE_DIR "/samples/";
std::string const table4 = "make " + samples + "statistics.toml -o out -q ";

void refused(std::string const& arguments, std::string const& words) {
    Workplace const place;
    place.write("nan.csv", "x,y,z\n1,2,3\n4,5,nan\n");
    place.write("two.csv", "x,y,z\n1,2,3\n400,5,6\n");
    place.write("line.csv", "x,y,z\n0,0,1\n100,100,2\n200,200,3\n");
    place.write("same.csv", "x,y,z\n5,5,1\n5,5,2\n5,5,3\n");
    for (std::string const name : {"nan", "two", "line", "same", "none"}) {
        place.write(name + ".toml", "[skeleton]\npoints = \"" + name + ".csv\"\n");
    }
    place.write("empty.toml", "[statistics]\nmean = 5\n");
    expect_refused(place, arguments, words);
}

} // namespace

TEST(Land, EverySampleIsMadeAgainWithAnyNumberOfThreads) {
    for (std::string const name : {"statistics", "points", "scattered", "tin", "feature_points"}) {
        Workplace const place;
        Outcome const o = expect_run(place, "make " + samples + name + ".toml -o out -q --threads 1 --json", 0);
        auto const report = nlohmann::json::parse(o.out);
        expect_checks_hold(report, name);
        bool const has_rivers = name == "tin" || name == "feature_points";
        EXPECT_EQ(report.contains("statistics"), !has_rivers);
        EXPECT_EQ(fs::exists(place / "out/tin.2dm"), name == "scattered" || has_rivers);
        EXPECT_EQ(fs::exists(place / "out/network.gpkg"), has_rivers);
        EXPECT_TRUE(fs::exists(place / "out/report.html"));
        EXPECT_EQ(thalweg_run("replay out --threads 2", place.path()).code, 0) << name;
    }
}

TEST(Land, RealReliefGivesARecipeThatHasItsStatistics) {
    Workplace const place;
    Outcome const recipe = expect_run(place, "stats " + samples + "jacksboro_utm16.tif --recipe", 0);
    place.write("real.toml", recipe.out);
    Outcome const o = expect_run(place, "make real.toml -o out -q --json", 0);
    auto const report = nlohmann::json::parse(o.out);
    Outcome const real = thalweg_run("stats " + samples + "jacksboro_utm16.tif --json", place.path());
    auto const wanted = nlohmann::json::parse(real.out);
    EXPECT_EQ(report["statistics"]["residuals"].size(), 8U);
    for (char const* name : {"mean", "std", "slope_rad", "lx_cells", "ly_cells"}) {
        double const asked = wanted[name].get<double>();
        EXPECT_NEAR(report["dem"][name].get<double>(), asked, 0.01 * asked) << name;
    }
    EXPECT_NEAR(report["dem"]["dimension"].get<double>(), wanted["dimension"].get<double>(), 0.02);
    EXPECT_EQ(report["dem"]["max"], wanted["max"]);
    EXPECT_EQ(report["dem"]["min"], wanted["min"]);
    EXPECT_EQ(thalweg_run("stats " + samples + "jacksboro_utm16.tif --recipe --json", place.path()).code, 2);
}

TEST(Land, StatsTellsTheLawsOfADemsRiversBesideNature) {
    Workplace const place;
    std::string const stats = "stats " + samples + "jacksboro_srtm3.tif ";
    Outcome const words = expect_run(place, stats + "--laws", 0);
    for (char const* part : {"rivers where at least 200 cells (1.38 km²) drain", "bifurcation ratio R_B", "3 to 5",
                             "Hack’s exponent h", "junction angle, mean", "45 to 72"}) {
        EXPECT_TRUE(test::has(words.out, part)) << "\n";
    }
    auto const plain = nlohmann::json::parse(thalweg_run(stats + "--json", place.path()).out);
    EXPECT_FALSE(plain.contains("laws"));
    Outcome const o = expect_run(place, stats + "--json --laws --support 100", 0);
    auto const laws = nlohmann::json::parse(o.out)["laws"];
    EXPECT_EQ(laws["support"]["cells"], 100);
    EXPECT_EQ(laws["support"]["as_dense_as_the_network"], false);
    EXPECT_EQ(laws["hack"]["range"], (nlohmann::json{0.52, 0.60}));
    EXPECT_TRUE(test::has(laws["hack"]["source"].get<std::string>(), "1957"));
    EXPECT_GT(laws["hack"]["r2"], 0.98);
    EXPECT_GT(laws["concavity"]["value"], 0.3);
    EXPECT_FALSE(laws["link_ratio"].contains("range")); // none is known well enough

    EXPECT_EQ(thalweg_run(stats + "--support 100", place.path()).code, 2);
    EXPECT_EQ(thalweg_run(stats + "--laws --support 0", place.path()).code, 2);
    EXPECT_EQ(thalweg_run(stats + "--laws --recipe", place.path()).code, 2);
}

TEST(Land, StatsTellsTheReliefOfADemBesideRealLand) {
    Workplace const place;
    std::string const stats = "stats " + samples + "jacksboro_utm16.tif ";
    Outcome const words = expect_run(place, stats + "--relief", 0);
    for (char const* part :
         {"Big Tujunga", "Jacksboro", "slope, mean", "concavity θ of the DEM’s rivers", "10.1 to 26.9"}) {
        EXPECT_TRUE(test::has(words.out, part)) << "\n";
    }
    EXPECT_FALSE(test::has(words.out, "outside")); // it is one of the reference DEMs
    EXPECT_FALSE(nlohmann::json::parse(thalweg_run(stats + "--json", place.path()).out).contains("relief"));
    Outcome const o = expect_run(place, stats + "--json --relief", 0);
    auto const relief = nlohmann::json::parse(o.out)["relief"];
    auto const& slope = relief["figures"]["slope_mean"];
    EXPECT_NEAR(slope["value"].get<double>(), slope["beside"]["Jacksboro"].get<double>(), 1e-3);
    EXPECT_TRUE(slope["in_range"]);
    EXPECT_EQ(relief["forms"].size(), 10U);
    EXPECT_EQ(thalweg_run(stats + "--relief --recipe", place.path()).code, 2);
}

TEST(Land, ARecipeOfLandThatIsHardlyLand) {
    Workplace const place;
    std::string const in = "cd '" + place.path().string() + "' && ";
    ASSERT_EQ(
        std::system((in + "gdal_translate -q -srcwin 20 30 200 1 " + samples + "jacksboro_srtm3.tif row.tif && " +
                     "gdal_create -q -outsize 20 10 -bands 1 -burn 5 -a_srs EPSG:32631 -a_ullr 0 300 600 0 flat.tif")
                        .c_str()),
        0);
    Outcome const row = expect_run(place, "stats row.tif --recipe", 0);
    EXPECT_TRUE(test::has(row.out, "# statistics.length is left out: the heights do not determine it along columns"));
    place.write("row.toml", row.out);
    EXPECT_EQ(thalweg_run("make row.toml -o out -q", place.path()).code, 0);
    expect_run(place, "stats flat.tif --recipe", 2, "every height of flat.tif is 5 m");
}

TEST(Land, WhatCannotBeIsRefusedWithItsNumbers) {
    refused(table4 + "--set statistics.mean=2000", "not between the lowest point of 276 m and the highest of 1038 m");
    refused(table4 + "--set statistics.std=9999", "the most is 361.276 m");
    refused(table4 + "--set 'statistics.max=[1038,129,26]'", "both at column 129, row 26");
    refused(table4 + "--set 'statistics.max=[1038,500,1]'", "lies off the grid of 130 x 40 cells");
    refused(table4 + "--set 'statistics.length=[0,5]'", "[Lx, Ly] above 0 is required");
    refused(table4 + "--set statistics.dimension=3.5", "outside its range");
    refused(table4 + "--set statistics.skeleton=points", "needs skeleton.points or skeleton.scatter");
    refused(table4 + "--set statistics.skeleton=points --set skeleton.scatter=5000 --set skeleton.spacing=3",
            "a density of 8.654");
    refused(table4 + "--set network.prune=4", "[statistics] and [network] do not go together");
    refused(table4 + "--set surface.method=dilate", "needs [network]");
    refused("make empty.toml -o out", "grid.width and grid.height are missing");
    refused("make nan.toml -o out", "nan.csv, line 3: z is 'nan'");
    refused("make two.toml -o out", "2 points in 2 different places");
    refused("make line.toml -o out", "3 points lie on one line");
    refused("make same.toml -o out", "points 1 and 2 of same.csv lie both at");
    refused("make none.toml -o out", "none.csv");
    refused("make -o out --set skeleton.scatter=9", "skeleton.scatter = 9 (--set) has no effect in this recipe");
    refused("make -o out --set detail.levels=2", "detail.sigma is missing");
    refused("make -o out --set detail.stencil=5", "not one of 4, 12, 16");
    refused("make -o out --set detail.stencil=exakt", "Did you mean 'exact'");
    std::string const exact = table4 + " --set detail.stencil=exact ";
    refused(exact + "--set detail.levels=1 --set grid.width=260 --set grid.height=80", "takes up to 2000 coarse cells");
    refused(exact + "--set detail.levels=6 --set grid.width=40000 --set grid.height=30",
            "40001 x 65 cells are too many for an exact fractional Brownian surface");
    refused(exact + "--set detail.noise=uniform", "detail.noise = 'uniform'");
}

TEST(Land, LengthsTheGridCannotShowAreWarnedOf) {
    Workplace const place;
    Outcome const o =
        thalweg_run("make " + samples + "statistics.toml -o out --set 'statistics.length=[20,39]'", place.path());
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(test::has(o.err, "warning: statistics.length"));
}

TEST(Land, PointsThatContradictTheStatisticsLeaveResidualsAndFiles) {
    Workplace const place;
    std::string points = "x,y,z\n";
    for (int i = 0; i < 900; ++i) { // half of all cells, all but level
        points += std::to_string(500015 + 30 * (i % 60)) + "," + std::to_string(4999985 - 60 * (i / 60)) + "," +
                  std::to_string(100 + i % 2) + "\n";
    }
    place.write("points.csv", points);
    place.write("r.toml",
                "[grid]\nwidth = 60\nheight = 30\norigin = [500000, 5000000]\n[skeleton]\npoints = \"points.csv\"\n"
                "[statistics]\nskeleton = \"points\"\nstd = 400\nlength = [20, 10]\nslope = 0.05\n");
    Outcome const o = expect_run(place, "make r.toml -o out -q --json", 3);
    auto const report = nlohmann::json::parse(o.out);
    EXPECT_FALSE(report["statistics"]["converged"].get<bool>());
    EXPECT_EQ(report["statistics"]["residuals"].size(), 4U);
    EXPECT_TRUE(fs::exists(place / "out/dem.tif"));
}

} // namespace land_test
