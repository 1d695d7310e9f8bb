// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Land from numbers and from points, as the command line makes it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/io/raster/raster_files.hpp>

#include "command.hpp"

namespace land_test {

namespace fs = std::filesystem;

TEST(Land, EverySampleIsMadeAgainWithAnyNumberOfThreads) {
    for (std::string const name : {"statistics", "points", "scattered", "tin", "feature_points"}) {
        Workplace const place;
        auto const report =
            expect_run(place, "make " + samples + name + ".toml -o out -q --threads 1 --json", 0).json();
        expect_checks_hold(report, name);
        bool const has_rivers = name == "tin" || name == "feature_points";
        EXPECT_EQ(report.contains("statistics"), !has_rivers);
        EXPECT_EQ(fs::exists(place / "out/tin.2dm"), name == "scattered" || has_rivers);
        EXPECT_EQ(fs::exists(place / "out/network.gpkg"), has_rivers);
        EXPECT_TRUE(fs::exists(place / "out/report.html"));
        expect_run(place, "replay out --threads 2", 0);
    }
}

TEST(Land, TheReportTellsWhichStageTookTheMemory) {
    Workplace const place;
    auto const report =
        expect_run(place, "make --set grid.width=768 --set grid.height=768 --only dem -o out -q --json", 0).json();
    double most_mb = 0.0;
    for (auto const& [stage, seconds] : report["timings_s"].items()) {
        most_mb = std::max(most_mb, report["peak_mb"].at(stage).get<double>());
    }
    EXPECT_NEAR(most_mb, report["peak_rss_mb"].get<double>(), 0.05 * most_mb) << "what is seen is the program's peak";
}

TEST(Land, ADemIsTheTerrain) {
    Workplace const place;
    std::string const dem = samples + "jacksboro_utm16.tif";
    expect_run(place, "make " + dem + " -q -o out", 0);
    auto const given = thalweg::io::read_dem(dem);
    auto const made = thalweg::io::read_dem((place / "out/dem.tif").string());
    EXPECT_EQ(made.grid(), given.grid());
    for (std::int64_t i = 0; i < given.cells(); ++i) {
        ASSERT_TRUE(made[i] == given[i] || (std::isnan(made[i]) && std::isnan(given[i]))) << i;
    }
    EXPECT_TRUE(fs::exists(place / "out/inputs/source/jacksboro_utm16.tif"));
    fs::rename(place / "out", place / "moved");
    expect_run(place, "replay moved --verify", 0);
    place.write("again.toml", expect_run(place, "recipe --for " + dem, 0).out);
    expect_run(place, "make again.toml -q -o again --set output.title=jacksboro", 0);
    EXPECT_EQ(file_bytes(place / "again/dem.tif"), file_bytes(place / "moved/dem.tif"));
}

TEST(Land, RiversDrainADem) {
    Workplace const place;
    std::string const dem = samples + "jacksboro_srtm3.tif"; // in degrees
    expect_run(place, "make " + dem + " -o out --set network.source=forest --set network.prune=20 --set grid.cell=120",
               0, "is resampled from 403x344 cells", "cells of rivers cut");
    expect_checks_hold(report_of(place / "out"));
    EXPECT_EQ(report_of(place / "out")["dem"]["pit_cells"], 0);
    expect_run(place, "check out -q", 0);
    expect_run(place, "replay out --verify", 0);
}

TEST(Land, AStreamThatSinksStaysInItsDoline) {
    Workplace const place;
    // A closed basin of 30 m whose bottom lies in cell (30, 30), and a stream that ends there.
    std::string grid = "ncols 60\nnrows 60\nxllcorner 500000\nyllcorner 4400000\ncellsize 5\n";
    auto const height = [](int c, int r) {
        return 470.0 + 0.05 * c + std::min(30.0, 1.5 * std::hypot(c - 30, r - 30));
    };
    for (int r = 0; r < 60; ++r) {
        for (int c = 0; c < 60; ++c) {
            grid += std::to_string(height(c, r)) + (c == 59 ? "\n" : " ");
        }
    }
    place.write("dem.asc", grid);
    place.write("stream.geojson", test::geojson(test::line("[500152.5,4400287.5],[500152.5,4400147.5]")));
    std::string const make = "make stream.geojson --set surface.method=raster --set "
                             "surface.source=dem.asc ";
    expect_run(place, make + "-o carried", 0, "warning: rivers are cut into dem.asc by up to", "[deep_cut]");
    auto const carried = report_of(place / "carried");
    expect_run(place, make + "-o calm --set surface.max_cut=40", 0);
    EXPECT_EQ(file_bytes(place / "carried/dem.tif"), file_bytes(place / "calm/dem.tif"));
    Outcome const kept = expect_run(place, make + "-o sink --set network.inland=sink", 0);
    EXPECT_EQ(kept.err.find("deep_cut"), std::string::npos);
    expect_checks_hold(report_of(place / "sink"));
    expect_run(place, "check sink -q", 0);
    expect_run(place, "replay sink --verify", 0);
    auto const bottom = [&](std::string const& folder) {
        return static_cast<double>(thalweg::io::read_dem((place / folder / "dem.tif").string())[thalweg::Cell{30, 30}]);
    };
    EXPECT_NEAR(bottom("sink"), height(30, 30), 1e-3);
    EXPECT_GT(std::fabs(bottom("carried") - height(30, 30)), 1.0) << "the way out is cut, and what it leaves is filled";
    EXPECT_TRUE(carried["findings"].dump().find("deep_cut") != std::string::npos);
}

/// A valley of 80 x 60 cells of 10 m that falls to the east, and in it the floor of a lake, 12 m deep around cell
/// (40, 30).
void write_lake_floor(Workplace const& place) {
    std::string grid = "ncols 80\nnrows 60\nxllcorner 500000\nyllcorner 4400000\ncellsize 10\n";
    for (int r = 0; r < 60; ++r) {
        for (int c = 0; c < 80; ++c) {
            double const depth = std::max(0.0, 12.0 - std::hypot(c - 40, r - 30));
            grid += std::to_string(300.0 - 0.25 * c + 0.5 * std::abs(r - 30) - depth) + (c == 79 ? "\n" : " ");
        }
    }
    place.write("dem.asc", grid);
    place.write("river.geojson", test::geojson(test::line("[500005,4400295],[500795,4400295]")));
    place.write("ends.geojson", test::geojson(test::line("[500005,4400295],[500405,4400295]")));
}

void write_lake(Workplace const& place, std::string const& properties) {
    place.write("lake.geojson",
                "{\"type\":\"FeatureCollection\",\"crs\":{\"type\":\"name\",\"properties\":{\"name\":"
                "\"urn:ogc:def:crs:EPSG::32631\"}},\"features\":[{\"type\":\"Feature\",\"properties\":{" +
                    properties +
                    "},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[500330,4400220],[500330,4400370],"
                    "[500480,4400370],[500480,4400220],[500330,4400220]]]}}]}");
}

/// The height of all cells of the lake but that where its water sinks and those beside the river that leaves it.
float level_of_lake(Workplace const& place, std::string const& folder) {
    auto const dem = thalweg::io::read_dem((place / folder / "dem.tif").string());
    float const level = dem[thalweg::Cell{36, 28}];
    std::int64_t others = 0;
    for (std::int64_t r = 23; r < 38; ++r) {
        for (std::int64_t c = 33; c < 48; ++c) {
            others += dem[thalweg::Cell{c, r}] == level ? 0 : 1;
        }
    }
    EXPECT_LE(others, 2) << folder;
    EXPECT_TRUE(fs::exists(place / folder / "lakes.tif")) << folder;
    return level;
}

TEST(Land, LakesLieLevelOnADem) {
    Workplace const place;
    write_lake_floor(place);
    std::string const make =
        "make river.geojson --set surface.method=raster --set surface.source=dem.asc --set surface.lakes=lake.geojson ";
    write_lake(place, "");
    Outcome const by_outlet = expect_run(place, make + "-o outlet", 0);
    EXPECT_EQ(by_outlet.err.find("warning"), std::string::npos) << by_outlet.err;
    EXPECT_NEAR(level_of_lake(place, "outlet"), 300.0 - 0.25 * 47 - 5.0, 1e-3) << "of the cell where water leaves it";
    write_lake(place, "\"level\":295.5");
    expect_run(place, make + "-o level", 0);
    EXPECT_EQ(level_of_lake(place, "level"), 295.5F);
    for (std::string const folder : {"outlet", "level"}) {
        expect_checks_hold(report_of(place / folder));
        EXPECT_EQ(report_of(place / folder)["dem"]["pit_cells"], 0);
        expect_run(place, "check " + folder + " -q", 0);
        expect_run(place, "replay " + folder + " --verify", 0);
    }
    write_lake(place, "\"level\":968"); // in feet
    expect_run(place, make + "-o feet", 0, "dammed by lakes above dem.asc by up to", "[high_lake]");
}

TEST(Land, ALakeWithoutAnOutletKeepsItsWater) {
    Workplace const place;
    write_lake_floor(place);
    write_lake(place, "\"level\":284");
    expect_run(place,
               "make ends.geojson --set surface.method=raster --set surface.source=dem.asc --set network.inland=sink "
               "--set surface.lakes=lake.geojson -o out",
               0);
    EXPECT_EQ(level_of_lake(place, "out"), 284.0F);
    expect_checks_hold(report_of(place / "out"));
    expect_run(place, "check out -q", 0);
    expect_run(place, "replay out --verify", 0);
}

TEST(Land, ADemWithoutACrsTakesThatOfTheRivers) {
    Workplace const place;
    std::string grid = "ncols 40\nnrows 40\nxllcorner 500000\nyllcorner 4400000\ncellsize 10\n";
    for (int i = 0; i < 1600; ++i) {
        grid += std::to_string(300 + i / 40 + (i % 40 > 20 ? i % 40 - 20 : 20 - i % 40)) + (i % 40 == 39 ? "\n" : " ");
    }
    place.write("dem.asc", grid);
    std::string river = test::geojson(test::line("[500205,4400005],[500205,4400395]"));
    std::size_t const at = river.find("32631");
    ASSERT_NE(at, std::string::npos);
    place.write("river.geojson", river.replace(at, 5, "32633"));
    expect_run(place, "make river.geojson --set surface.method=raster --set surface.source=dem.asc -o out", 0,
               "count as metres in EPSG:32633");
    EXPECT_EQ(thalweg::io::read_dem((place / "out/dem.tif").string()).grid().crs, "EPSG:32633");
}

TEST(Land, WhatIsNoDemIsRefused) {
    Workplace const place;
    place.write("rivers.geojson", test::geojson(test::line("[500000,5000000],[500300,5000000]")));
    place.write("text.asc", "no raster");
    place.write("empty.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n-9 -9\n");
    place.shell("printf 'P6\\n2 2\\n255\\n123456789012' > photo.ppm");
    expect_refused(place, "make -q -o out", {"text.asc", "empty.asc", "photo.ppm", "none.tif"});
    std::string const raster = "[surface]\nmethod = \"raster\"\n";
    place.write("alone.toml", raster);
    for (std::string const name : {"rivers.geojson", "empty.asc", "none.tif"}) {
        place.write(name + ".toml", raster + "source = \"" + name + "\"\n");
        expect_refused(place, "make -q -o out", {name + ".toml"});
    }
    expect_refused(place, "make -q -o out", {"alone.toml"});
}

TEST(Land, RealReliefGivesARecipeThatHasItsStatistics) {
    Workplace const place;
    Outcome const recipe = expect_run(place, "stats " + samples + "jacksboro_utm16.tif --recipe", 0);
    place.write("real.toml", recipe.out);
    auto const report = expect_run(place, "make real.toml -o out -q --json", 0).json();
    auto const wanted = expect_run(place, "stats " + samples + "jacksboro_utm16.tif --json", 0).json();
    EXPECT_EQ(report["statistics"]["residuals"].size(), 8U);
    for (char const* name : {"mean", "std", "slope_rad", "lx_cells", "ly_cells"}) {
        double const asked = wanted[name].get<double>();
        EXPECT_NEAR(report["dem"][name].get<double>(), asked, 0.01 * asked) << name;
    }
    EXPECT_NEAR(report["dem"]["dimension"].get<double>(), wanted["dimension"].get<double>(), 0.02);
    EXPECT_EQ(report["dem"]["max"], wanted["max"]);
    EXPECT_EQ(report["dem"]["min"], wanted["min"]);
    expect_run(place, "stats " + samples + "jacksboro_utm16.tif --recipe --json", 2);
}

TEST(Land, StatsHasLawsAndReliefOnRequest) {
    Workplace const place;
    std::string const stats = "stats " + samples + "jacksboro_srtm3.tif ";
    auto const plain = expect_run(place, stats + "--json", 0).json();
    EXPECT_FALSE(plain.contains("laws") || plain.contains("relief"));
    auto const laws = expect_run(place, stats + "--json --laws --support 100", 0).json()["laws"];
    EXPECT_EQ(laws["support"]["cells"], 100);
    EXPECT_EQ(laws["support"]["as_dense_as_the_network"], false);
    EXPECT_EQ(laws["hack"]["range"], (nlohmann::json{0.52, 0.60}));
    EXPECT_GT(laws["hack"]["r2"], 0.98);
    EXPECT_GT(laws["concavity"]["value"], 0.3);
    EXPECT_FALSE(laws["link_ratio"].contains("range")); // none is known well enough

    std::string const metres = "stats " + samples + "jacksboro_utm16.tif ";
    auto const relief = expect_run(place, metres + "--json --relief", 0).json()["relief"];
    auto const& slope = relief["figures"]["slope_mean"];
    EXPECT_NEAR(slope["value"].get<double>(), slope["beside"]["Jacksboro"].get<double>(), 1e-3);
    EXPECT_TRUE(slope["in_range"]); // it is one of the reference DEMs
    EXPECT_EQ(relief["forms"].size(), 10U);
    for (std::string const table : {"--laws", "--relief"}) {
        EXPECT_TRUE(test::has(expect_run(place, metres + table, 0).out, "\n"));
    }
    expect_refused(place, metres,
                   {"--recipe --json", "--support 100", "--laws --support 0", "--laws --recipe", "--relief --recipe"});
}

TEST(Land, ARecipeOfTerrainWithoutRelief) {
    Workplace const place;
    place.shell("gdal_translate -srcwin 20 30 200 1 " + samples +
                "jacksboro_srtm3.tif row.tif && "
                "gdal_create -outsize 20 10 -bands 1 -burn 5 -a_srs EPSG:32631 -a_ullr 0 300 600 0 flat.tif");
    place.write("row.toml", expect_run(place, "stats row.tif --recipe", 0).out);
    expect_run(place, "make row.toml -o out -q", 0);
    expect_refused(place, "stats flat.tif", {"--recipe"});
}

TEST(Land, ContradictionsAreRefused) {
    Workplace const place;
    place.write("nan.csv", "x,y,z\n1,2,3\n4,5,nan\n");
    place.write("two.csv", "x,y,z\n1,2,3\n400,5,6\n");
    place.write("line.csv", "x,y,z\n0,0,1\n100,100,2\n200,200,3\n");
    place.write("same.csv", "x,y,z\n5,5,1\n5,5,2\n5,5,3\n");
    for (std::string const name : {"nan", "two", "line", "same", "none"}) {
        place.write(name + ".toml", "[skeleton]\npoints = \"" + name + ".csv\"\n");
    }
    place.write("empty.toml", "[statistics]\nmean = 5\n");
    place.write("unmet.toml", "[grid]\nwidth = 32\nheight = 32\n[statistics]\nmean = 50\nstd = 40\nmax = [60, 3, 3]\n"
                              "min = [40, 9, 9]\n");
    expect_refused(place, "make -q -o out",
                   {"empty.toml", "unmet.toml", "nan.toml", "two.toml", "line.toml", "same.toml", "none.toml",
                    "--set skeleton.scatter=9", "--set detail.levels=2", "--set detail.stencil=5",
                    "--set detail.stencil=exakt"});
    expect_refused(place, "make " + samples + "statistics.toml -o out -q --set",
                   {"statistics.mean=2000", "statistics.std=9999", "'statistics.max=[1038,129,26]'",
                    "'statistics.max=[1038,500,1]'", "'statistics.length=[0,5]'", "statistics.dimension=3.5",
                    "statistics.skeleton=points",
                    "statistics.skeleton=points --set skeleton.scatter=5000 --set skeleton.spacing=3",
                    "network.prune=4", "surface.method=dilate",
                    "detail.stencil=exact --set detail.levels=1 --set grid.width=260 --set grid.height=80",
                    "detail.stencil=exact --set detail.levels=6 --set grid.width=40000 --set grid.height=30",
                    "detail.stencil=exact --set detail.noise=uniform"});
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
    auto const report = expect_run(place, "make r.toml -o out -q --json", 3).json();
    EXPECT_FALSE(report["statistics"]["converged"].get<bool>());
    EXPECT_EQ(report["statistics"]["residuals"].size(), 4U);
    EXPECT_TRUE(fs::exists(place / "out/dem.tif"));
}

} // namespace land_test
