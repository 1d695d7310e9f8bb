// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"

#include <thalweg/io/read_dem.hpp>
#include <thalweg/io/write_dem.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

namespace {

using namespace thalweg;

Grid const frame{40, 30, 10.0, 500000.0, 4000000.0, "EPSG:32631"};

/// A slope to the east with waves, and the cells 10 to 29, 8 to 21 as a region.
void write_lands(Workplace const& place) {
    Raster<float> dem(frame);
    Raster<float> region(frame);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = frame.at(i);
        dem[i] = static_cast<float>(2 * c.col + (c.col * 7 + c.row * 5) % 11);
        region[i] = c.col >= 10 && c.col < 30 && c.row >= 8 && c.row < 22 ? 1.0F : 0.0F;
    }
    io::write_dem(dem, (place / "land.tif").string());
    io::write_dem(region, (place / "region.tif").string());
}

Outcome deform(Workplace const& place, std::string const& arguments) {
    return thalweg_run("deform " + arguments, place.path());
}

} // namespace

TEST(Deform, PullsAPlaceToItsHeightAndKeepsWhatIsOutside) {
    Workplace const place;
    write_lands(place);
    Outcome const o = deform(place, "land.tif -o bent.tif --mask region.tif --pull 500205,3999845,500 --json");
    ASSERT_EQ(o.code, 0) << o.err;
    nlohmann::json const json = nlohmann::json::parse(o.out);
    EXPECT_EQ(json["cells"], 280);
    EXPECT_EQ(json["handles"], 1);
    Raster<float> const before = io::read_dem((place / "land.tif").string());
    Raster<float> const after = io::read_dem((place / "bent.tif").string());
    EXPECT_EQ(after[(Cell{20, 15})], 500.0F);
    std::int64_t changed = 0;
    for (std::int64_t i = 0; i < before.cells(); ++i) {
        Cell const c = frame.at(i);
        bool const inside = c.col >= 10 && c.col < 30 && c.row >= 8 && c.row < 22;
        if (!inside) {
            EXPECT_EQ(after[i], before[i]);
        }
        changed += after[i] != before[i];
    }
    EXPECT_GT(changed, 200);
}

TEST(Deform, ScaleZeroTakesTheRegionsReliefAway) {
    Workplace const place;
    write_lands(place);
    ASSERT_EQ(deform(place, "land.tif -o flat.tif --mask region.tif --scale 0").code, 0);
    Raster<float> const dem = io::read_dem((place / "flat.tif").string());
    Cell const c{20, 15};
    double const around =
        0.25 * (static_cast<double>(dem[Cell{19, 15}]) + dem[Cell{21, 15}] + dem[Cell{20, 14}] + dem[Cell{20, 16}]);
    EXPECT_NEAR(dem[c], around, 1e-4); // harmonic
}

TEST(Deform, BadInputIsRefusedWithItsPlace) {
    Workplace const place;
    write_lands(place);
    for (auto const& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
             {"land.tif -o x.tif --mask region.tif", "nothing to do"},
             {"land.tif -o x.tif --mask region.tif --pull 1,2,3", "(1, 2) lies outside"},
             {"land.tif -o x.tif --mask region.tif --pull 500005,3999995,3", "column 0, row 0"},
             {"land.tif -o x.tif --mask region.tif --pull 500205,3999845", "three for each place"},
             {"land.tif -o x.tif --mask none.tif --scale 2", "none.tif"},
             {"land.tif -o x.tif --mask region.tif --scale nan", "scale"}}) {
        Outcome const o = deform(place, arguments);
        EXPECT_EQ(o.code, 2) << arguments << "\n" << o.err;
        EXPECT_NE(o.err.find(words), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_FALSE(std::filesystem::exists(place / "x.tif")) << arguments;
    }
}
