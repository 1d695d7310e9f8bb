// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Terrain as a DEM of a file has it, and rivers laid on it.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <io/tiff.hpp>
#include <make/ascii_grid.hpp>
#include <support.hpp>

#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/make.hpp>
#include <thalweg/recipe/make_input.hpp>
#include <thalweg/report/report.hpp>

#include <make/made.hpp>

namespace raster_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;
using namespace thalweg::report;

namespace {

using test::has;
using test::made;

/// Hills and hollows on a slope to the south.
double hills(int col, int row) {
    return 200.0 - 2.0 * row + 30.0 * std::sin(col / 4.0) * std::cos(row / 3.0) + 0.123 * ((7 * col + 3 * row) % 5);
}

/// The same with a sea in the south-west, and one cell without data.
double coast(int col, int row) {
    return col + 40 - row < 20 || (col == 30 && row == 5) ? -9999.0 : hills(col, row);
}

double plane(int col, int row) {
    return 100.0 + 0.5 * col + 0.25 * row;
}

/// A river down the middle, with a tributary; their heights are from 9 to 3 m.
std::string const rivers = test::geojson(test::line("[500610,4999985,9],[500500,4999600,6],[500620,4999110,3]") + "," +
                                         test::line("[501100,4999900,8],[500500,4999600,6]"));

/// The lines of a file, with more keys of [network].
std::string lines(std::string const& more = "") {
    return "[network]\nsource = \"lines\"\n" + more + "[network.lines]\npath = \"rivers.geojson\"\n";
}

class Rasters : public testing::Test {
protected:
    Rasters() {
        auto const dem = [&](char const* name, Tiff const& tiff, auto const& value) {
            written(folder_ / name, tiff, value);
        };
        dem("hills.tif", {.epsg = 32631, .frame = place}, hills);
        dem("coast.tif", {.epsg = 32631, .frame = place, .nodata = -9999.0}, coast);
        dem("plane.tif", {.epsg = 32631, .frame = place}, plane);
        dem("degrees.tif", {.epsg = 4326, .frame = {10.0, 0.001, 0.0, 50.0, 0.0, -0.001}}, hills);
        dem("nowhere.tif", {.epsg = 0, .frame = {0.0, 10.0, 0.0, 300.0, 0.0, -10.0}}, hills);
        dem("empty.tif", {.epsg = 32631, .frame = place, .nodata = -9999.0}, [](int, int) { return -9999.0; });
        dem("photo.tif", {.bands = 3, .epsg = 32631, .frame = place}, hills);
        test::write(folder_ / "rivers.geojson", rivers);
    }

    MakeResult of(std::string const& source, std::string const& more = "", std::string const& before = "") {
        said_.clear();
        thalweg::Run run;
        run.log = [this](std::string_view line) { said_ += std::string(line) + "\n"; };
        return made(before + "[surface]\nmethod = \"raster\"\nsource = \"" + source + "\"\n" + more, folder(), run);
    }
    Raster<float> file(std::string const& name) const { return io::read_dem(folder_ / name); }
    std::string fault_of(std::string const& toml) const { return test::fault_of(toml, folder()); }
    std::string folder() const { return folder_.path().string(); }

    std::vector<double> const place{500000.0, 30.0, 0.0, 5000000.0, 0.0, -30.0};
    std::string const on_hills = "[surface]\nmethod = \"raster\"\nsource = \"hills.tif\"\n";
    ScratchFolder folder_;
    std::string said_;
};

/// As bits: two cells without data are the same.
void expect_same_bits(Raster<float> const& a, Raster<float> const& b) {
    ASSERT_EQ(a.grid(), b.grid());
    for (std::int64_t i = 0; i < a.cells(); ++i) {
        ASSERT_TRUE(std::bit_cast<std::uint32_t>(a[i]) == std::bit_cast<std::uint32_t>(b[i]) ||
                    (std::isnan(a[i]) && std::isnan(b[i])))
            << i;
    }
}

std::int64_t without_data(Raster<float> const& dem) {
    return std::ranges::count_if(dem.values(), [](float z) { return std::isnan(z); });
}

/// Rivers lie in the DEM or below, and it drains by them.
void expect_drained_by_rivers(MakeResult const& t) {
    EXPECT_TRUE(t.assessment.passed()) << checks_json(t.assessment.checks);
    EXPECT_EQ(t.assessment.pits, 0);
    ValleyCells const& valley = t.terrain.bed.valley;
    for (std::size_t i = 0; i < valley.cell.size(); ++i) {
        EXPECT_EQ(t.terrain.ground.dem[valley.cell[i]], valley.z[i]);
        EXPECT_LE(valley.z[i], t.plan.raster[valley.cell[i]]);
    }
    EXPECT_GT(valley.cell.size(), 30U);
    for (std::vector<double> const& z : t.terrain.rivers.network.arc_z) {
        EXPECT_TRUE(std::ranges::is_sorted(z, std::greater<>()));
        EXPECT_GT(z.front(), z.back());
    }
}

} // namespace

TEST_F(Rasters, AreTheTerrainBitForBit) {
    for (std::string const name : {"hills.tif", "coast.tif"}) {
        MakeResult const t = of(name);
        expect_same_bits(t.terrain.ground.dem, file(name));
        EXPECT_TRUE(t.assessment.passed());
        EXPECT_FALSE(t.terrain.water.is_conditioned);
        EXPECT_FALSE(has(said_, "resampled"));
        EXPECT_EQ(t.recipe.grid.cell_m, 30.0);
        EXPECT_EQ(t.recipe.grid.crs, "EPSG:32631");
        EXPECT_EQ(t.recipe.grid.origin, (std::array<double, 2>{500000.0, 5000000.0}));
        EXPECT_EQ(t.assessment.statistics->nodata, without_data(file(name)));
    }
}

TEST_F(Rasters, AWindowOfTheSameCellsIsCutOut) {
    MakeResult const t = of("hills.tif", "", "[grid]\nwidth = 10\nheight = 8\norigin = [500090, 4999880]\n");
    Raster<float> const all = file("hills.tif");
    for (std::int64_t i = 0; i < t.terrain.grid.cells(); ++i) {
        Cell const c = t.terrain.grid.at(i);
        EXPECT_EQ(t.terrain.ground.dem[i], (all[Cell{c.col + 3, c.row + 4}]));
    }
    EXPECT_FALSE(has(said_, "resampled"));
    MakeResult const wider = of("hills.tif", "", "[grid]\nwidth = 42\nheight = 30\norigin = [499970, 5000000]\n");
    EXPECT_EQ(without_data(wider.terrain.ground.dem), 2 * 30);
    MakeResult const rest = of("hills.tif", "", "[grid]\norigin = [500090, 4999880]\n");
    EXPECT_EQ(rest.terrain.grid.width, 37);
    EXPECT_EQ(rest.terrain.grid.height, 26);
}

TEST_F(Rasters, OtherCellsAreResampled) {
    struct Case {
        std::string grid;
        std::int64_t width;
        std::int64_t height;
    };
    for (auto const& [grid, width, height] :
         {Case{"cell = 60\n", 20, 15}, Case{"cell = 7\n", 171, 128}, Case{"origin = [500010, 4999990]\n", 39, 29},
          Case{"width = 20\nheight = 10\norigin = [500011, 4999900]\n", 20, 10}}) {
        MakeResult const t = of("plane.tif", "", "[grid]\n" + grid);
        EXPECT_EQ(t.terrain.grid.width, width) << grid;
        EXPECT_EQ(t.terrain.grid.height, height) << grid;
        EXPECT_TRUE(has(said_, "plane.tif is resampled from 40x30 cells of 30 in EPSG:32631 to ")) << grid;
        EXPECT_EQ(without_data(t.terrain.ground.dem), 0) << grid;
        for (std::int64_t i = 0; i < t.terrain.grid.cells(); ++i) {
            Vec2 const p = t.terrain.grid.centre(t.terrain.grid.at(i));
            double const asked = plane(0, 0) + (p.x - 500015.0) / 60.0 + (4999985.0 - p.y) / 120.0;
            ASSERT_NEAR(t.terrain.ground.dem[i], asked, 0.5) << grid; // beyond the outer centres it is level
        }
    }
}

TEST_F(Rasters, OtherCoordinateSystemsAreReprojected) {
    MakeResult const degrees = of("degrees.tif");
    EXPECT_EQ(degrees.terrain.grid.crs, "EPSG:32632");
    EXPECT_NEAR(degrees.terrain.grid.cell_m, 89.3, 1.0);
    EXPECT_TRUE(has(said_, "reprojected into EPSG:32632", "resampled from 40x30 cells of 0.001 in EPSG:4326 to"));
    MakeResult const zone = of("hills.tif", "", "[grid]\ncrs = \"EPSG:32632\"\ncell = 30\n");
    EXPECT_EQ(zone.terrain.grid.crs, "EPSG:32632");
    EXPECT_GT(zone.terrain.grid.cells(), 40 * 30);
    EXPECT_NEAR(zone.assessment.statistics->mean, of("hills.tif").assessment.statistics->mean, 2.0);
    MakeResult const nowhere = of("nowhere.tif");
    EXPECT_EQ(nowhere.terrain.grid, (Grid{40, 30, 10.0, 0.0, 300.0, "EPSG:32631"}));
    EXPECT_TRUE(has(said_, "nowhere.tif has no coordinate system"));
}

TEST_F(Rasters, AreDrainedWhereThatIsAskedFor) {
    EXPECT_GT(of("hills.tif").assessment.pits, 0);
    for (std::string const name : {"hills.tif", "coast.tif"}) {
        for (std::string const drain : {"carve", "fill"}) {
            MakeResult const t = of(name, "drain = \"" + drain + "\"\n");
            EXPECT_EQ(t.assessment.pits, 0) << name << drain;
            EXPECT_TRUE(t.assessment.passed()) << name << drain;
            EXPECT_EQ(without_data(t.terrain.ground.dem), without_data(file(name)));
        }
    }
}

TEST_F(Rasters, RiversAreCutIntoThem) {
    MakeResult const t = of("hills.tif", "", lines());
    expect_drained_by_rivers(t);
    EXPECT_EQ(t.recipe.network->heights, Heights::automatic);
    EXPECT_EQ(t.recipe.surface->drain, flow::Conditioning::carve);
    EXPECT_GT(std::ranges::min(t.terrain.rivers.network.node_z), 20.0) << "not the heights of the file";
    EXPECT_GT(t.terrain.bed.heights.lowered_cells, 0);
    MakeResult const bare = of("hills.tif", "drain = \"none\"\n", lines());
    for (std::int64_t i = 0; i < bare.terrain.grid.cells(); ++i) {
        EXPECT_TRUE(has_river(bare.terrain.bed.valley, i) || bare.terrain.ground.dem[i] == bare.plan.raster[i]);
    }
    MakeResult const of_file = of("hills.tif", "", lines("heights = \"file\"\n"));
    EXPECT_LE(std::ranges::max(of_file.terrain.rivers.network.node_z), 9.0);
}

TEST_F(Rasters, GrownRiversAreLaidOnThem) {
    std::string const forest = "[network]\nsource = \"forest\"\nprune = 4\n";
    expect_drained_by_rivers(of("hills.tif", "", forest));
    MakeResult const t = of("coast.tif", "", forest);
    expect_drained_by_rivers(t);
    EXPECT_EQ(without_data(t.terrain.ground.dem), without_data(file("coast.tif"))) << "the sea stays sea";
    expect_drained_by_rivers(of("hills.tif", "", "[network]\nprune = 3\n[network.dla]\nparticles = 400\n"));
    expect_drained_by_rivers(of("hills.tif", "", "[network]\nsource = \"tokunaga\"\n[network.tokunaga]\norder = 2\n"));
    MakeResult const bends = of("hills.tif", "", "[network]\nsource = \"forest\"\nprune = 4\nmeander = 0.5\n");
    expect_drained_by_rivers(bends);
}

TEST_F(Rasters, TakeMasksPatchesAndDetail) {
    write_ascii_grid(folder_ / "mask.asc", {40, 30, 30, 500000, 4999100}, [](int c, int) { return c < 30 ? 1 : 0; });
    write_ascii_grid(folder_ / "patch.asc", {10, 10, 30, 500300, 4999400}, [](int c, int r) { return 5 * c * r; });
    EXPECT_EQ(without_data(of("hills.tif", "mask = \"mask.asc\"\n").terrain.ground.dem), 10 * 30);
    MakeResult const patched = of("hills.tif", "[[patch]]\nsource = \"patch.asc\"\n");
    EXPECT_EQ(patched.terrain.ground.patches.at(0).cells, 8 * 8) << "but for its border";
    for (std::string const name : {"hills.tif", "coast.tif"}) {
        MakeResult const fine = of(name, "[detail]\nlevels = 2\n");
        Raster<float> const given = file(name);
        EXPECT_EQ(without_data(fine.terrain.ground.dem), without_data(given));
        std::int64_t other = 0;
        for (std::int64_t i = 0; i < given.cells(); ++i) {
            Cell const c = given.grid().at(i);
            bool const is_same = std::isnan(given[i]) || fine.terrain.ground.dem[i] == given[i];
            EXPECT_TRUE(is_same || c.col % 4 != 0 || c.row % 4 != 0) << "every fourth cell stays";
            other += is_same ? 0 : 1;
        }
        EXPECT_GT(other, 500);
    }
    expect_drained_by_rivers(of("hills.tif", "[detail]\nsigma = 5\nlevels = 2\n", lines()));
}

TEST_F(Rasters, StagesAreAsForecast) {
    for (std::string const& network :
         {std::string(), lines(), std::string("[network]\nsource = \"forest\"\nprune = 4\n")}) {
        Recipe recipe = read_recipe(network + on_hills, "r.toml");
        recipe.folder = folder();
        MakeResult const t = make::make(recipe);
        std::vector<std::string> stages;
        for (StageTime const& time : timings_of(t)) {
            stages.push_back(time.stage);
        }
        EXPECT_EQ(forecast(recipe).stages, stages);
        EXPECT_EQ(forecast(recipe).grid, t.terrain.grid);
    }
}

TEST_F(Rasters, ARecipeSettlesToTheSameTerrain) {
    for (std::string const& grid :
         {std::string(), std::string("[grid]\ncell = 45\n"), std::string("[grid]\ncrs = \"EPSG:32632\"\n")}) {
        MakeResult const first = of("coast.tif", "", grid);
        Recipe recipe = read_recipe(write_recipe(first.recipe), "again.toml");
        recipe.folder = folder();
        MakeResult const again = make::make(recipe);
        expect_same_bits(first.terrain.ground.dem, again.terrain.ground.dem);
        EXPECT_EQ(write_recipe(again.recipe), write_recipe(first.recipe));
    }
}

TEST_F(Rasters, AFileIsARecipe) {
    Recipe const recipe = recipe_from(folder_ / "hills.tif");
    EXPECT_EQ(recipe.output.title, "hills");
    expect_same_bits(make::make(recipe).terrain.ground.dem, file("hills.tif"));
    Recipe const settled = settled_recipe(recipe);
    EXPECT_EQ(settled.grid.width, 40);
    EXPECT_EQ(settled.grid.cell_m, 30.0);
    EXPECT_TRUE(has(test::message_of([&] { recipe_from(folder_ / "nowhere.gpkg"); }), "does not exist", "a DEM"));
}

TEST_F(Rasters, TheCellIsTheirsUntilAKeyGivesIt) {
    Recipe recipe = read_recipe(on_hills, "r.toml");
    EXPECT_EQ(recipe.grid.cell_m, 0.0);
    EXPECT_FALSE(has(write_recipe(recipe), "cell ="));
    set_key(recipe, "grid.cell=15");
    EXPECT_EQ(recipe.grid.cell_m, 15.0);
    unset_key(recipe, "grid.cell");
    EXPECT_EQ(recipe.grid.cell_m, 0.0);
    set_key(recipe, "surface.method=tin");
    EXPECT_EQ(recipe.grid.cell_m, 30.0);
}

TEST_F(Rasters, WhatDoesNotFitIsRefusedInWords) {
    std::string const raster = "[surface]\nmethod = \"raster\"\n";
    auto const source = [&](std::string const& name) { return raster + "source = \"" + name + "\"\n"; };
    test::expect_faults(
        {{raster, "surface.source is missing"},
         {source("none.tif"), "surface.source = \"none.tif\": there is no such file"},
         {source("rivers.geojson"), "rivers.geojson"},
         {source("empty.tif"), "holds no heights"},
         {source("photo.tif"), "has 3 bands"},
         {source("degrees.tif") + "[grid]\ncrs = \"EPSG:4326\"\n", "geographic"},
         {source("hills.tif") + "[grid]\norigin = [600000, 5000000]\n", "holds no cell"},
         {source("hills.tif") + "[grid]\norigin = [600000, 5000000]\nwidth = 9\nheight = 9\n", "has no height within"},
         {source("hills.tif") + "[grid]\ncell = 1e-300\n", "larger grid.cell"},
         {source("degrees.tif") + "[grid]\ncell = 1e-300\n", "more than memory"},
         {source("hills.tif") + "[statistics]\nmean = 5\n", "[statistics] and surface.method = \"raster\""},
         {source("hills.tif") + "[skeleton]\nscatter = 9\n", "skeleton.scatter = 9"},
         {source("hills.tif") + "noise = 3\n", "surface.noise = 3.0"},
         {source("hills.tif") + lines("heights = \"graded\"\n"), "network.heights does not go with"},
         {"[surface]\nsource = \"hills.tif\"\n" + lines(), "surface.source = 'hills.tif'"},
         {source("hills.tif") + "[grid]\nwidth = 9\nheight = 9\n" + lines(), "grid.clip = true"}},
        folder());
    written(folder_ / "hole.tif", {.epsg = 32631, .frame = place, .nodata = -9999.0},
            [](int c, int r) { return c > 10 && c < 25 && r == 20 ? -9999.0 : hills(c, r); });
    EXPECT_TRUE(has(fault_of(source("hole.tif") + lines()), "has no height at", "grid.clip = true"));
    MakeResult const t = of("hole.tif", "", "[grid]\nclip = true\n" + lines());
    expect_drained_by_rivers(t);
    EXPECT_EQ(without_data(t.terrain.ground.dem), 14);
    EXPECT_EQ(t.terrain.rivers.network.planform.outlets().size(), 2U);
}

} // namespace raster_test
