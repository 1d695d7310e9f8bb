// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/relief/relief.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/relief.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/measure/relief/geomorphons.hpp>

namespace reference_dems_test {

using namespace thalweg;
using measure::Relief;
using namespace thalweg::make;

namespace {

struct Land {
    char const* name;
    char const* file;
    char const* source;
};

constexpr std::array<Land, 2> lands = {{
    {"Big Tujunga", "bigtujunga_srtm1_utm11.tif", "NASA/USGS SRTM 1 arcsec, San Gabriel Mountains, California"},
    {"Jacksboro", "jacksboro_utm16.tif", "SRTM 3 arcsec, Jacksboro fault, Tennessee and Kentucky, in UTM"},
}};

struct Measured {
    Relief relief;
    double cell_m = 0.0;
};

Measured measured(Land const& land) {
    Raster<float> const dem = io::read_dem(std::string(THALWEG_SOURCE_DIR "/samples/") + land.file);
    return {make::relief_of_dem(dem).land, dem.grid().cell_m};
}

template <class Numbers> std::string listed(Numbers const& numbers) {
    std::string out;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        out += fmt::format("{}{:.6g}", i == 0 ? "" : i % 8 == 0 ? ",\n      " : ", ", numbers[i]);
    }
    return out;
}

std::array<double, measure::relief_metric_count> figures_of(Relief const& relief) {
    std::array<double, measure::relief_metric_count> out{};
    for (std::size_t f = 0; f < out.size(); ++f) {
        out[f] = measure::relief_metrics()[f].of(relief);
    }
    return out;
}

void write_anew() {
    std::ofstream out(THALWEG_SOURCE_DIR "/lib/thalweg/measure/relief/internal/reference_dems.inc");
    out << "// SPDX-FileCopyrightText: the thalweg authors\n// SPDX-License-Identifier: GPL-3.0-or-later\n"
           "// Measured from samples/ by tests/make/reference_dems_test.cpp, which writes this file under "
           "THALWEG_RENEW=1.\n";
    std::string table;
    for (std::size_t l = 0; l < lands.size(); ++l) {
        Measured const m = measured(lands[l]);
        auto const& bins = m.relief.slope_area->bins;
        out << fmt::format("constexpr std::array<AreaBin, {}> bins_{} = {{{{\n", bins.size(), l);
        for (measure::AreaBin const& bin : bins) {
            out << fmt::format("    {{{:.6g}, {:.6g}, {}}},\n", bin.area_m2, bin.value, bin.places);
        }
        out << "}};\n";
        table +=
            fmt::format("    {{\"{}\",\n     \"{}\",\n     \"{}\",\n     {},\n     {{{{{}}}}},\n     {{{{{}}}}},\n     "
                        "{{{{{}}}}},\n     bins_{}}},\n",
                        lands[l].name, lands[l].file, lands[l].source, m.cell_m, listed(figures_of(m.relief)),
                        listed(m.relief.slopes.shares), listed(m.relief.forms), l);
    }
    out << fmt::format("constexpr std::array<ReferenceDem, {}> lands = {{{{\n{}}}}};\n", lands.size(), table);
}

void expect_near(double found, double committed, std::string const& what) {
    EXPECT_NEAR(found, committed, 1e-5 * std::fabs(committed) + 1e-12) << what;
}

/// tests/data/grass_forms_NAME.txt: what GRASS 8.2.1 writes for samples/FILE (r.geomorphon search=15 skip=0 flat=1) in
/// 120 rows of 120 columns from a corner on: one character a cell, ':' for 10.
std::int64_t cells_that_differ(std::string const& name, std::string const& file, Cell corner) {
    std::string const sources = THALWEG_SOURCE_DIR;
    measure::Geomorphons const found = measure::geomorphons(io::read_dem(sources + "/samples/" + file));
    std::ifstream in(sources + "/tests/data/grass_forms_" + name + ".txt");
    std::int64_t differing = 0;
    std::int64_t compared = 0;
    std::string line;
    for (std::int64_t row = corner.row; std::getline(in, line); ++row) {
        for (std::size_t c = 0; c < line.size(); ++c) {
            ++compared;
            std::int64_t const col = corner.col + static_cast<std::int64_t>(c);
            differing += found.form[Cell{col, row}] != line[c] - '0' ? 1 : 0;
        }
    }
    EXPECT_EQ(compared, 120 * 120) << name;
    return differing;
}

TerrainRelief relief_of_sample(char const* name) {
    return relief_of_dem(io::read_dem(std::string(THALWEG_SOURCE_DIR "/samples/") + name));
}

ReliefRow const& row_of(std::vector<ReliefRow> const& rows, std::string_view key) {
    return *std::find_if(rows.begin(), rows.end(), [&](ReliefRow const& r) { return r.key == key; });
}

} // namespace

// The committed values of reference DEMs are those that the code finds in the committed files.
TEST(ReferenceDems, AsMeasuredFromTheirFiles) {
    if (std::getenv("THALWEG_RENEW") != nullptr) {
        write_anew();
        FAIL() << "lib/thalweg/measure/relief/internal/reference_dems.inc is written anew; build again and look at it";
    }
    ASSERT_EQ(measure::reference_dems().size(), lands.size());
    for (std::size_t l = 0; l < lands.size(); ++l) {
        measure::ReferenceDem const& committed = measure::reference_dems()[l];
        EXPECT_EQ(committed.name, lands[l].name);
        EXPECT_EQ(committed.file, lands[l].file);
        Measured const m = measured(lands[l]);
        EXPECT_EQ(committed.cell_m, m.cell_m);
        auto const figures = figures_of(m.relief);
        for (std::size_t f = 0; f < figures.size(); ++f) {
            expect_near(figures[f], committed.figures[f], std::string(measure::relief_metrics()[f].key));
        }
        ASSERT_EQ(m.relief.slopes.shares.size(), committed.slopes.size());
        for (std::size_t s = 0; s < committed.slopes.size(); ++s) {
            expect_near(m.relief.slopes.shares[s], committed.slopes[s], fmt::format("slope {}", s));
        }
        for (std::size_t f = 0; f < measure::form_count; ++f) {
            expect_near(m.relief.forms[f], committed.forms[f], fmt::format("form {}", f));
        }
        ASSERT_EQ(m.relief.slope_area->bins.size(), committed.slope_area.size());
        for (std::size_t b = 0; b < committed.slope_area.size(); ++b) {
            expect_near(m.relief.slope_area->bins[b].value, committed.slope_area[b].value, fmt::format("bin {}", b));
            expect_near(m.relief.slope_area->bins[b].area_m2, committed.slope_area[b].area_m2,
                        fmt::format("bin {}", b));
        }
    }
}

// What GRASS 8.2.1 finds in the same files: r.geomorphon search=15 skip=0 flat=1, fifteen cells of border left out.
TEST(ReferenceDems, FormsAsGrassHasThem) {
    constexpr std::array<std::array<double, measure::form_count>, 2> grass = {{
        {0.0, 0.0116, 0.0964, 0.0, 0.2174, 0.3608, 0.1913, 0.0001, 0.1136, 0.0089},
        {0.0, 0.0470, 0.1554, 0.0, 0.1882, 0.2514, 0.1486, 0.0001, 0.1530, 0.0562},
    }};
    for (std::size_t l = 0; l < grass.size(); ++l) {
        EXPECT_LT(measure::total_variation(measure::reference_dems()[l].forms, grass[l]), 0.0005);
    }
}

// Every reference DEM lies in the range that terrains are compared with.
TEST(ReferenceDems, LieInTheirOwnRange) {
    for (measure::ReferenceDem const& land : measure::reference_dems()) {
        for (std::size_t f = 0; f < measure::relief_metric_count; ++f) {
            if (measure::relief_metrics()[f].judges == measure::Judges::no) {
                continue;
            }
            measure::ReliefRange const range = measure::relief_range(f);
            EXPECT_GE(land.figures[f], range.low);
            EXPECT_LE(land.figures[f], range.high);
            if (measure::relief_metrics()[f].judges != measure::Judges::large_values) {
                EXPECT_GT(range.low, 0.0);
            }
        }
    }
}

// Cell by cell, ties among whole metres too.
TEST(GrassForms, CellByCell) {
    EXPECT_EQ(cells_that_differ("bigtujunga", "bigtujunga_srtm1_utm11.tif", {500, 250}), 0);
    EXPECT_EQ(cells_that_differ("jacksboro", "jacksboro_utm16.tif", {110, 120}), 0);
}

// A part of a reference DEM lies in the range of every metric but those that follow its extent.
TEST(ReliefRows, APartOfRealLandIsLand) {
    auto const rows = relief_rows(relief_of_sample("bigtujunga_srtm1.tif"));
    EXPECT_EQ(rows.size(), measure::relief_metric_count + 1); // no rivers are drawn on it
    for (ReliefRow const& row : rows) {
        EXPECT_EQ(row.beside.size(), measure::reference_dems().size()) << row.key;
        EXPECT_TRUE(row.value) << row.key;
        bool const by_extent = row.key.starts_with("length") || row.key == "gradient_anisotropy" ||
                               row.key == "level_patch" || row.key == "slope_spread" || row.key == "gentle_away" ||
                               row.key == "half_way_height";
        if (!by_extent && row.key != "peaks") { // one peak in a thousand
            EXPECT_TRUE(row.ok()) << row.key << " " << *row.value;
        }
    }
}

// Cells of degrees are measured on the ground: nearly as the same terrain in metres.
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
    UnlikeRealLand const unlike = unlike_real_land(rows, {});
    EXPECT_TRUE(test::has(unlike.text, "hillsides are rougher", "gradient_correlation_720 ", "form_distance "));
    EXPECT_EQ(unlike.text.find("hillsides"), unlike.text.rfind("hillsides")); // told once for both lags
    EXPECT_TRUE(test::has(unlike.remedy, "lower surface.roughness"));
    EXPECT_FALSE(test::has(unlike.text, "peaks"));
    EXPECT_FALSE(test::has(unlike_real_land(rows, {.has_texture = false}).text, "hillsides"));
    EXPECT_EQ(unlike_real_land(relief_rows(relief_of_sample("jacksboro_utm16.tif")), {}).text, "");
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

} // namespace reference_dems_test
