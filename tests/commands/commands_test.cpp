// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Commands called without the command line.
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/commands/blend.hpp>
#include <thalweg/commands/deform.hpp>
#include <thalweg/commands/grow.hpp>
#include <thalweg/commands/make.hpp>
#include <thalweg/commands/stats.hpp>
#include <thalweg/commands/tin.hpp>
#include <thalweg/io/mesh/tin.hpp>

namespace commands_test {

using namespace thalweg;
using namespace thalweg::commands;

namespace {

std::string const samples = THALWEG_SOURCE_DIR "/samples/";

} // namespace

TEST(Commands, StatsOfADemInDegreesAreInMetres) {
    std::vector<std::string> log;
    thalweg::Run run;
    run.log = [&](std::string_view line) { log.emplace_back(line); };
    StatsResult const found = run_stats({.path = samples + "jacksboro_srtm3.tif", .laws = true, .relief = true}, run);
    ASSERT_EQ(log.size(), 1U);
    EXPECT_TRUE(test::has(log[0], "jacksboro_srtm3.tif", "UTM zone 16N"));
    EXPECT_EQ(found.grid.crs, "EPSG:32616");
    EXPECT_GT(found.statistics.std, 10.0);
    EXPECT_TRUE(found.laws && found.relief && !found.recipe);
    StatsResult const alike = run_stats({.path = samples + "jacksboro_srtm3.tif", .recipe = true});
    ASSERT_TRUE(alike.recipe);
    EXPECT_EQ(alike.recipe->recipe.grid.width, alike.grid.width);
    EXPECT_EQ(alike.grid, found.grid);
    EXPECT_EQ(alike.recipe->recipe.grid.cell_m, found.grid.cell_m);
    // Heights are those of the file's own cells.
    EXPECT_EQ(found.statistics.cells, 403 * 344);
    EXPECT_EQ(found.statistics.min.z, 236.0);
    EXPECT_EQ(found.statistics.max.z, 1076.0);
}

TEST(Commands, GrowCountsWritesWordsAndDrawsRules) {
    GrowResult const counted = run_grow({.tree = {.order = 3}});
    EXPECT_EQ(counted.streams.streams, (std::vector<std::int64_t>{11, 3, 1}));
    EXPECT_EQ(counted.side_law, (std::vector<double>{1.0, 2.0}));
    EXPECT_EQ(counted.bifurcation, (std::vector<double>{11.0 / 3.0, 3.0}));
    EXPECT_EQ(run_grow({.tree = {.order = 2}, .word = true}).word, "F[--G]F[-G][+G]");

    ScratchFolder const folder;
    folder.write("koch.txt", "axiom F\niterations 1\nangle 60\nF -> F+F--F+F\n");
    GrowParams params{.rules = folder / "koch.txt", .output = folder / "koch.svg"};
    GrowResult const drawn = run_grow(params);
    EXPECT_EQ(drawn.word, "F+F--F+F");
    EXPECT_EQ(drawn.lines, 1);
    EXPECT_TRUE(test::has(test::bytes_of(params.output), "<svg"));
    EXPECT_NE(test::message_of<BadInput>([&] { run_grow(params); }), "");
    params.existing = io::Existing::replace;
    EXPECT_EQ(run_grow(params).word, drawn.word);
    params.output = folder / "koch.txt";
    EXPECT_TRUE(test::refused<BadParameter>(
        "commands.run_grow", [&] { run_grow(params); }, "not a picture"));
}

TEST(Commands, MeshesAreWrittenWholeOrNotAtAll) {
    ScratchFolder const folder;
    folder.write("land.xyz", "0 0 1\n90 0 1\n90 90 1\n0 90 1\n45 45 9\n");
    TinParams params{.path = folder / "land.xyz", .output = folder / "land.obj"};
    EXPECT_EQ(run_tin(params).tin.triangles.size(), 4U);
    EXPECT_EQ(io::read_tin(params.output).tin.vertices.size(), 5U);
    params.output = folder / "bad.obj";
    params.error_m = 1.0;
    EXPECT_TRUE(test::refused<BadParameter>(
        "commands.run_tin", [&] { run_tin(params); }, "a DEM only"));
    EXPECT_FALSE(std::filesystem::exists(params.output));

    BlendParams paste{.patch = {.target = folder / "land.obj", .source = folder / "land.obj"}, .output = params.output};
    paste.patch.at = Vec2{45.0, 45.0};
    paste.patch.scale = 0.5;
    EXPECT_GT(std::get<BlendedTin>(run_blend(paste)).fused.tin.vertices.size(), 5U);
    paste.patch.feather_cells = 3.0;
    EXPECT_TRUE(test::refused<BadParameter>(
        "commands.run_blend", [&] { run_blend(paste); }, "is for DEMs"));
    DeformParams const turn{.target = samples + "jacksboro_utm16.tif", .output = folder / "a.tif", .rotate_deg = 3.0};
    EXPECT_TRUE(test::refused<BadParameter>(
        "commands.run_deform", [&] { run_deform(turn); }, "turn meshes"));
}

TEST(Commands, MakeTakesKeysAndFieldsOfRivers) {
    MakeParams params{.input = samples + "walker_nhdplus.gpkg", .set = {"grid.cell=500"}};
    EXPECT_EQ(forecast_make(params).grid.value().cell_m, 500.0);
    EXPECT_EQ(recipe_for(params.input).network->lines.path, samples + "walker_nhdplus.gpkg");
    params.fields = {{"depth", "D"}};
    EXPECT_TRUE(test::has(test::message_of<BadParameter>([&] { forecast_make(params); }), "depth=D"));
}

} // namespace commands_test
