// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// No-data that a DEM's file does not declare, and cells that are nearly square.
#include <algorithm>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

namespace nodata_test {

using nlohmann::json;

namespace {

/// A slope of 40 x 30 cells of 30 m, in them 36 of -9999 that nothing declares.
void write_dem(Workplace const& place, std::string const& name, std::string const& cells = "cellsize 30") {
    std::ostringstream text;
    text << "ncols 40\nnrows 30\nxllcorner 500000\nyllcorner 5000000\n" << cells << "\n";
    for (int row = 0; row < 30; ++row) {
        for (int col = 0; col < 40; ++col) {
            bool const is_hole = col >= 10 && col < 16 && row >= 8 && row < 14;
            text << (is_hole ? -9999.0 : 100.0 + 2.0 * col + 0.5 * row) << ' ';
        }
        text << '\n';
    }
    place.write(name, text.str());
}

} // namespace

TEST(Nodata, EveryCommandRefusesWhatIsNotDeclared) {
    Workplace const place;
    write_dem(place, "dem.asc");
    place.write(
        "mask.asc", "ncols 40\nnrows 30\nxllcorner 500000\nyllcorner 5000000\ncellsize 30\nNODATA_value -1\n" + [] {
            std::string cells;
            for (int i = 0; i < 1200; ++i) {
                cells += i / 40 > 20 && i / 40 < 26 && i % 40 > 20 && i % 40 < 30 ? "1 " : "0 ";
            }
            return cells;
        }());
    for (std::string const arguments :
         {"stats dem.asc", "stats dem.asc --recipe", "measure dem.asc -o m", "tin dem.asc -o t.2dm",
          "points dem.asc -o p.xyz", "draw dem.asc --what map -o d.png",
          "blend dem.asc dem.asc -o b.tif --window 1,1,8,6", "deform dem.asc --mask mask.asc --scale 2 -o f.tif"}) {
        expect_refused(place, arguments, {""});
        expect_run(place, arguments + " --nodata -9999", 0);
    }
    json const stats = thalweg_run("stats dem.asc --json --nodata -9999", place.path()).json();
    EXPECT_EQ(stats["cells"], 1164);
    EXPECT_GT(stats["min"]["z"].get<double>(), 99.0);
    EXPECT_EQ(thalweg_run("stats dem.asc --json --nodata nan", place.path()).json()["cells"], 1200);
    expect_refused(place, "stats dem.asc", {"--nodata x"});
    place.write("p.csv", "x,y,z\n0,0,1\n1,0,2\n0,1,3\n1,1,-9999\n");
    expect_refused(place, "tin p.csv -o t2.2dm", {"", "--nodata x"});
    expect_run(place, "tin p.csv -o t2.2dm --nodata -9999", 0, "1 point is of no data left out");
}

TEST(Nodata, CheckTakesTheSameOption) {
    Workplace const place;
    expect_run(place, small + "land", 0);
    place.shell("gdal_translate -of AAIGrid land/dem.tif dem.asc && sed -i '/NODATA/Id; /^ *[0-9-]/{s/^ *[^ "
                "]*/-9999/;:a;n;ba}' "
                "dem.asc && gdal_translate -a_srs EPSG:32631 dem.asc dem.tif");
    expect_refused(place, "check land --dem dem.tif", {""});
    Outcome const o = thalweg_run("check land --dem dem.tif --nodata -9999", place.path());
    EXPECT_NE(o.code, 2) << o.err;
}

TEST(Nodata, CellsThatAreNotQuiteSquare) {
    Workplace const place;
    write_dem(place, "near.asc", "dx 30.0007\ndy 30.0005\nNODATA_value -9999");
    write_dem(place, "far.asc", "dx 30\ndy 40\nNODATA_value -9999");
    for (std::string const arguments : {"stats", "measure -o m", "tin -o t.2dm", "points -o p.xyz"}) {
        std::size_t const end = std::min(arguments.find(' '), arguments.size());
        std::string const near = arguments.substr(0, end) + " near.asc" + arguments.substr(end);
        expect_run(place, near, 0);
        if (arguments != "stats" && !arguments.starts_with("measure")) {
            std::string far = arguments.substr(0, end) + " far.asc" + arguments.substr(end);
            far.insert(far.find("-o ") + 3, "far_");
            expect_refused(place, far, {""});
        }
    }
    expect_run(place, "stats far.asc --json", 0);
    expect_run(place, "measure far.asc -o far_m", 0, "cells of 30 x 40 made squares");
}

} // namespace nodata_test
