// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/make.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/report/report.hpp>
#include <thalweg/surface/strata/strata.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>

namespace make_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;
using namespace thalweg::report;

namespace {

std::string const rivers_of = "[grid]\nwidth = 96\nheight = 96\n[network]\nsource = \"tokunaga\"\n"
                              "[network.tokunaga]\norder = 4\n";

Recipe recipe_of_text(std::string const& text) {
    return read_recipe(text, "r.toml");
}

/// Two terrains around rivers that are grown once, and as two runs make them.
void expect_rivers_serve_both(std::string const& one, std::string const& two) {
    Planform const rivers = make_planform(resolve(recipe_of_text(rivers_of + one)));
    for (std::string const& surface : {one, two}) {
        Recipe const recipe = recipe_of_text(rivers_of + surface);
        MakeResult const whole = make::make(recipe);
        Plan const plan = resolve(recipe);
        Terrain const terrain = make_terrain(plan, rivers);
        Assessment const assessment = assess(plan, rivers, terrain);
        EXPECT_TRUE(test::same_bits(terrain.ground.dem, whole.terrain.ground.dem));
        EXPECT_EQ(terrain.rivers.network.arc_z, whole.terrain.rivers.network.arc_z);
        EXPECT_EQ(write_recipe(recipe_of(plan, terrain)), write_recipe(whole.recipe));
        EXPECT_EQ(assessment.passed(), whole.assessment.passed());
        EXPECT_EQ(terrain.water.areas.ds_area_m2, whole.terrain.water.areas.ds_area_m2);
    }
}

} // namespace

// Law: stages keep nothing, so values may be used again.
TEST(Make, RiversServeTwoTerrains) {
    expect_rivers_serve_both("[surface]\nmean_slope = 15\n", "[surface]\nmean_slope = 30\n");
    expect_rivers_serve_both("[surface]\nmethod = \"dilate\"\n", "[surface]\nmethod = \"diffuse\"\n");
}

TEST(Make, RiversAloneHaveNoTerrain) {
    MakeResult const made = make::make(recipe_of_text(rivers_of));
    EXPECT_FALSE(made.terrain.has_surface());
    EXPECT_FALSE(made.terrain.has_surface());
    EXPECT_FALSE(made.assessment.given);
    EXPECT_GT(made.terrain.rivers.network.planform.arc_count(), 0U);
    EXPECT_TRUE(made.assessment.passed());
}

TEST(Make, LandAloneHasNoRivers) {
    MakeResult const made =
        make::make(recipe_of_text("[grid]\nwidth = 64\nheight = 48\n[statistics]\nmean = 100\nstd = 10\n"));
    EXPECT_EQ(made.planform.network.arc_count(), 0U);
    EXPECT_EQ(made.terrain.grid, made.plan.grid);
    EXPECT_TRUE(made.terrain.has_surface());
}

// Each value has its own timings; together they are those of the run.
TEST(Make, TimingsAreThoseOfTheValues) {
    MakeResult const made = make::make(recipe_of_text(rivers_of + "[surface]\n"));
    EXPECT_EQ(made.plan.timings_s.front().stage, "grow");
    EXPECT_EQ(made.planform.timings_s.front().stage, "embed");
    EXPECT_EQ(made.terrain.notes.timings_s.front().stage, "channels");
    EXPECT_EQ(made.assessment.timings_s.back().stage, "check");
    EXPECT_EQ(timings_of(made).size(), made.plan.timings_s.size() + made.planform.timings_s.size() +
                                           made.terrain.notes.timings_s.size() + made.assessment.timings_s.size());
}

namespace {

std::vector<std::string> files_in(std::string const& folder) {
    return files_of_report(test::bytes_of(folder + "/report.json"));
}

} // namespace

// The files do not depend on how many are written at once, nor on whether the terrain is assessed meanwhile.
TEST(MakeFolder, WritesWhatWriteTerrainWrites) {
    ScratchFolder const scratch;
    Recipe const recipe = recipe_of_text(rivers_of + "[surface]\n");
    std::vector<std::string> const names = write_terrain(make::make(recipe), scratch / "one", io::Existing::refuse, {});
    for (int const threads : {1, 3}) {
        std::string const folder = scratch / std::to_string(threads);
        make_folder(recipe, folder, io::Existing::refuse, test::on_threads(threads));
        EXPECT_EQ(files_in(folder), names);
        for (std::string const& name : names) {
            if (!name.starts_with("report.")) { // times differ
                EXPECT_EQ(test::bytes_of(folder + "/" + name), test::bytes_of(scratch / ("one/" + name))) << name;
            }
        }
        auto const report = nlohmann::json::parse(test::bytes_of(folder + "/report.json"));
        for (char const* const stage : {"fill", "relief", "write_dem", "write_map", "write_page", "write_network"}) {
            EXPECT_GE(report["timings_s"].at(stage).get<double>(), 0.0);
            EXPECT_GE(report["cpu_s"].at(stage).get<double>(), 0.0);
            EXPECT_GT(report["peak_mb"].at(stage).get<double>(), 0.0);
            EXPECT_LE(report["peak_mb"].at(stage).get<double>(), 1.01 * report["peak_rss_mb"].get<double>());
        }
    }
}

TEST(MakeFolder, LeavesNothingWhenItIsStoppedWhileItWrites) {
    ScratchFolder const scratch;
    Recipe const recipe = recipe_of_text(rivers_of + "[surface]\n");
    for (int const threads : {1, 3}) {
        thalweg::Run run = test::on_threads(threads);
        run.progress = [](double, char const* what, void*) { return std::string(what) == "write" ? 0 : 1; };
        EXPECT_THROW(make_folder(recipe, scratch / "out", io::Existing::refuse, run), Cancelled);
        EXPECT_EQ(scratch.entries(), 0);
    }
}

// uplift.tif is the pattern times the raster that the terrain was made with, and 1 where uplift is the same everywhere.
TEST(OutputFiles, UpliftOfTheTerrain) {
    ScratchFolder const scratch;
    Recipe recipe = recipe_of_text(rivers_of + "[surface]\n[output]\nuplift = true\nfiles = [\"dem\"]\n");
    make_folder(recipe, scratch / "even");
    Raster<float> const even = io::read_dem(scratch / "even/uplift.tif");
    EXPECT_TRUE(std::all_of(even.values().begin(), even.values().end(), [](float u) { return u == 1.0F; }));
    set_key(recipe, "surface.uplift_pattern=seed");
    set_key(recipe, "surface.uplift_contrast=6");
    make_folder(recipe, scratch / "pattern");
    Raster<float> const found = io::read_dem(scratch / "pattern/uplift.tif");
    Raster<float> const asked =
        surface::uplift_pattern(found.grid(), {.pattern = surface::UpliftPattern::seed,
                                               .contrast = 6.0,
                                               .strike_deg = surface::random_strike_deg(recipe.seed),
                                               .seed = recipe.seed});
    EXPECT_TRUE(std::equal(found.values().begin(), found.values().end(), asked.values().begin()));
    set_key(recipe, "surface.method=dilate");
    EXPECT_TRUE(test::has(test::message_of([&] { check_recipe(recipe); }), "output.uplift"));
}

// strata.tif says which layer lies at the surface; what the rivers and the land are checked for holds in layers, too.
TEST(OutputFiles, StrataAtTheSurface) {
    ScratchFolder const scratch;
    Recipe const recipe = recipe_of_text(
        rivers_of + "[surface]\nrelief = 150\n[strata]\nbase = -10\ndip = 4\nstrike = 30\n[[layer]]\nthickness = 60\n"
                    "strength = 0.5\ncliff = 0.5\n[[layer]]\nthickness = 40\nstrength = 8\ncliff = 5\n[[layer]]\n"
                    "strength = 0.2\ncliff = 0.4\n[output]\nfiles = [\"dem\"]\n");
    MakeResult const made = make_folder(recipe, scratch / "out");
    Raster<float> const codes = io::read_dem(scratch / "out/strata.tif");
    auto const report = nlohmann::json::parse(test::bytes_of(scratch / "out/report.json"));
    surface::Strata strata;
    strata.layers = {{60.0, 0.5, 0.5}, {40.0, 8.0, 5.0}, {100.0, 0.2, 0.4}};
    strata.base_m = -10.0;
    strata.dip_deg = 4.0;
    strata.strike_deg = 30.0;
    Raster<float> const dem = io::read_dem(scratch / "out/dem.tif");
    Raster<float> const bed =
        surface::bed_heights(dem.grid(), strata, report["equilibrium"]["strata_shift_m"].get<double>());
    Raster<float> const written = io::read_dem(scratch / "out/strata_bed.tif");
    EXPECT_TRUE(std::equal(bed.values().begin(), bed.values().end(), written.values().begin()));
    Raster<std::uint8_t> const asked = surface::layers_at(dem, bed, strata);
    std::array<std::int64_t, 4> cells{};
    for (std::int64_t i = 0; i < codes.cells(); ++i) {
        EXPECT_EQ(codes[i], static_cast<float>(asked[i])) << i;
        ++cells.at(asked[i]);
    }
    EXPECT_EQ(cells[0], 0);
    EXPECT_GT(std::min({cells[1], cells[2], cells[3]}), codes.cells() / 100);
    EXPECT_DOUBLE_EQ(report["equilibrium"]["layer_shares"][1].get<double>(),
                     static_cast<double>(cells[2]) / static_cast<double>(codes.cells()));
    for (Check const& check : made.assessment.checks) {
        EXPECT_TRUE(check.ok) << check.name << " " << check.value;
    }
}

TEST(OutputFiles, AreThoseThatAreAskedFor) {
    ScratchFolder const scratch;
    std::string const surface = "[surface]\n[output]\naccumulation = true\nfiles = ";
    Recipe recipe = recipe_of_text(rivers_of + surface + "[\"network\", \"dem\"]\n");
    MakeResult const made = make_folder(recipe, scratch / "two");
    EXPECT_FALSE(made.assessment.catchments);
    EXPECT_EQ(made.terrain.water.drainage.area_cells.cells(), 0);
    EXPECT_EQ(made.terrain.water.drainage.direction.cells(), made.terrain.grid.cells());
    EXPECT_FALSE(made.assessment.water_areas);
    EXPECT_EQ(files_in(scratch / "two"),
              (std::vector<std::string>{"dem.tif", "network.gpkg", "network.tif", "network_arcs.cpg",
                                        "network_arcs.dbf", "network_arcs.prj", "network_arcs.shp", "network_arcs.shx",
                                        "network_nodes.cpg", "network_nodes.dbf", "network_nodes.prj",
                                        "network_nodes.shp", "network_nodes.shx", "recipe.toml", "report.json"}));
    EXPECT_TRUE(test::has(test::bytes_of(scratch / "two/recipe.toml"), "files = [ 'dem', 'network' ]"));
    set_key(recipe, "output.files=areas, qgis, page");
    make_folder(recipe, scratch / "three");
    EXPECT_EQ(files_in(scratch / "three"),
              (std::vector<std::string>{"area_d8.qml", "area_d8.tif", "area_dinf.qml", "area_dinf.tif", "project.qgz",
                                        "recipe.toml", "report.html", "report.json"}));
    set_key(recipe, "output.files=tin");
    EXPECT_TRUE(test::has(test::message_of([&] { check_recipe(recipe); }), "skeleton.tin = true"));
    unset_key(recipe, "output.files");
    EXPECT_FALSE(test::has(write_recipe(recipe), "files"));
    EXPECT_TRUE(test::has(test::message_of([&] { set_key(recipe, "output.files=dem,netwrk"); }),
                          "'netwrk' is not one of its values. Did you mean 'network'?"));
    for (std::string const wrong : {"[]", "7", "[1, 2]", "[\"dem\", 2]", "\"\""}) {
        EXPECT_THROW(recipe_of_text(rivers_of + "[output]\nfiles = " + wrong + "\n"), BadParameter) << wrong;
    }
}

} // namespace make_test
