// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/relief.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/make/terrain.hpp>

namespace relief_rows_test {

using namespace thalweg;
using namespace thalweg::pipeline;

namespace {

TerrainRelief relief_of_sample(char const* name) {
    return relief_of_dem(io::read_dem(std::string(THALWEG_SOURCE_DIR "/samples/") + name));
}

ReliefRow const& row_of(std::vector<ReliefRow> const& rows, std::string_view key) {
    return *std::find_if(rows.begin(), rows.end(), [&](ReliefRow const& r) { return r.key == key; });
}

} // namespace

// A part of a reference DEM is taken for land by every figure but those that follow its extent.
TEST(ReliefRows, APartOfRealLandIsLand) {
    auto const rows = relief_rows(relief_of_sample("bigtujunga_srtm1.tif"));
    EXPECT_EQ(rows.size(), measure::relief_metric_count + 1); // no rivers are drawn on it
    for (ReliefRow const& row : rows) {
        EXPECT_EQ(row.beside.size(), measure::reference_dems().size()) << row.key;
        EXPECT_TRUE(row.value) << row.key;
        bool const by_extent =
            row.key.starts_with("length") || row.key == "gradient_anisotropy" || row.key == "level_patch";
        if (!by_extent && row.key != "peaks") { // one peak in a thousand
            EXPECT_TRUE(row.ok()) << row.key << " " << *row.value;
        }
    }
}

// Cells of degrees are measured on the ground: nearly as the same land in metres.
TEST(ReliefRows, GeographicLandHasItsSlopes) {
    TerrainRelief const degrees = relief_of_sample("jacksboro_srtm3.tif");
    EXPECT_NEAR(degrees.land.slopes.mean_deg, relief_of_sample("jacksboro_utm16.tif").land.slopes.mean_deg, 0.7);
}

TEST(ReliefRows, NoiseIsNotLand) {
    Grid const grid{200, 200, 30.0, 0.0, 6000.0, ""};
    Raster<float> noise(grid);
    for (std::int64_t i = 0; i < noise.cells(); ++i) {
        noise[i] = static_cast<float>((i * 7919) % 1009);
    }
    auto const rows = relief_rows(relief_of_dem(noise));
    EXPECT_FALSE(row_of(rows, "slope_mean").ok());
    EXPECT_FALSE(row_of(rows, "form_distance").ok());
    EXPECT_FALSE(row_of(rows, "peaks").ok());
    EXPECT_TRUE(row_of(rows, "pits_over_peaks").ok()); // judges nothing
    EXPECT_GT(*row_of(rows, "pits_over_peaks").value, 0.8);
    std::string const told = unusual_relief(rows, false);
    EXPECT_NE(told.find("gradient_correlation_720 "), std::string::npos) << told;
    EXPECT_NE(told.find("form_distance "), std::string::npos) << told;
    EXPECT_EQ(told.find("peaks"), std::string::npos) << told;
    EXPECT_EQ(unusual_relief(relief_rows(relief_of_sample("jacksboro_utm16.tif")), false), "");
}

// What cannot be known is null, not a number and not a fault.
TEST(ReliefRows, UnknownIsNull) {
    auto const out =
        nlohmann::json::parse(relief_json(relief_of_dem(Raster<float>({3, 3, 30.0, 0.0, 90.0, ""}, 7.0F))));
    EXPECT_TRUE(out["figures"]["theta"]["value"].is_null());
    EXPECT_TRUE(out["figures"]["theta"]["in_range"]);
    EXPECT_TRUE(out["figures"]["form_distance"]["value"].is_null());
    EXPECT_TRUE(out["slope_area"].is_null());
    EXPECT_TRUE(out["chi"].is_null());
    EXPECT_FALSE(out["figures"].contains("perched"));
    EXPECT_EQ(out["figures"]["slope_mean"]["value"], 0.0);
    EXPECT_EQ(out["beside"].size(), 2U);
    EXPECT_EQ(out["beside"][0]["slopes"].size(), 45U);
}

// River cells are counted where there are rivers, and none may stand perched.
TEST(ReliefRows, PerchedOnlyWithRivers) {
    TerrainRelief relief = relief_of_dem(Raster<float>({40, 40, 30.0, 0.0, 1200.0, ""}, 7.0F));
    EXPECT_EQ(relief_rows(relief).back().key, "form_distance");
    relief.perched = 0;
    EXPECT_TRUE(relief_rows(relief).back().ok());
    relief.perched = 1;
    ReliefRow const row = relief_rows(relief).back();
    EXPECT_EQ(row.key, "perched");
    EXPECT_FALSE(row.ok());
    EXPECT_EQ(*row.value, 1.0);
}

} // namespace relief_rows_test
