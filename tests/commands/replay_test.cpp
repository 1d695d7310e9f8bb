// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What make leaves needs no other file: every key that names one.
#include <thalweg/commands/replay.hpp>

#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <make/walk_files.hpp>
#include <support.hpp>

#include <thalweg/make/make.hpp>
#include <thalweg/report/report.hpp>

namespace replay_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;
using namespace thalweg::report;
using namespace thalweg::commands;

namespace {

namespace fs = std::filesystem;

struct Case {
    std::string toml;
    std::string copy; ///< in the output
};

std::string const grid = "[grid]\nwidth = 64\nheight = 64\n";
std::string const dla = grid + "[network]\nprune = 5\n[network.dla]\nparticles = 1500\n";
std::string const patch = dla + "[surface]\n[[patch]]\nat = [501000, 4999000]\n";

std::map<std::string, Case> const cases = {
    {"network.tokunaga.region",
     {grid + "[network]\nsource = \"tokunaga\"\n[network.tokunaga]\norder = 3\nregion = \"region.geojson\"\n",
      "inputs/region/region.geojson"}},
    {"network.tokunaga.strokes",
     {"[grid]\nwidth = 96\nheight = 96\n[network]\nsource = \"tokunaga\"\n[network.tokunaga]\norder = 3\n"
      "strokes = \"strokes.geojson\"\n",
      "inputs/strokes/strokes.geojson"}},
    {"network.forest.region",
     {grid + "[network]\nsource = \"forest\"\nprune = 6\n[network.forest]\nregion = \"region.geojson\"\n",
      "inputs/region/region.geojson"}},
    {"network.forest.outlets",
     {grid + "[network]\nsource = \"forest\"\nprune = 6\n[network.forest]\noutlets = \"outlets.csv\"\n",
      "inputs/outlets/outlets.csv"}},
    {"network.lines.path",
     {grid + "[network]\nsource = \"lines\"\n[network.lines]\npath = \"rivers.geojson\"\n[surface]\n",
      "inputs/rivers.geojson"}},
    {"network.lines.dem",
     {grid +
          "[network]\nsource = \"lines\"\n[network.lines]\npath = \"rivers.geojson\"\ndem = \"north.asc\"\n[surface]\n",
      "inputs/dem/north.asc"}},
    {"skeleton.points", {grid + "[skeleton]\npoints = \"points.csv\"\n", "inputs/points/points.csv"}},
    {"skeleton.ridge_lines",
     {dla + "[skeleton]\nridge_lines = \"crests.geojson\"\n[surface]\n", "inputs/ridge_lines/crests.geojson"}},
    {"surface.source", {"[surface]\nmethod = \"raster\"\nsource = \"hills.asc\"\n", "inputs/source/hills.asc"}},
    {"surface.mask", {dla + "[surface]\nmask = \"mask.asc\"\n", "inputs/mask/mask.asc"}},
    {"surface.uplift", {dla + "[surface]\nuplift = \"uplift.asc\"\n", "inputs/uplift/uplift.asc"}},
    {"surface.erodibility",
     {dla + "[surface]\nerodibility = \"erodibility.asc\"\n", "inputs/erodibility/erodibility.asc"}},
    {"surface.lakes", {dla + "[surface]\nlakes = \"lakes.geojson\"\n", "inputs/lakes/lakes.geojson"}},
    {"surface.like", {dla + "[surface]\nlike = \"hills.asc\"\n", "inputs/like/hills.asc"}},
    {"output.against", {dla + "[surface]\n[output]\nagainst = \"hills.asc\"\n", "inputs/against/hills.asc"}},
    {"patch.source", {patch + "source = \"patch.asc\"\n", "inputs/patch1/patch.asc"}},
    {"patch.mask",
     {patch + "source = \"patch.asc\"\nmask = \"patch_mask.geojson\"\n", "inputs/patch1/mask/patch_mask.geojson"}},
};

/// Makes a recipe beside its files, removes these, and makes what was left again.
void expect_replayed(std::string const& toml, std::string const& copy) {
    ScratchFolder const folder;
    std::string const out = folder / "out";
    {
        WalkFiles const files;
        Recipe recipe = read_recipe(toml, "r.toml");
        recipe.folder = files.folder();
        write_terrain(make::make(recipe), out, io::Existing::refuse);
        EXPECT_EQ(bytes_of(out + "/" + copy), bytes_of(files / fs::path(copy).filename().string()));
    }
    ReplayResult const again = run_replay({out});
    EXPECT_TRUE(again.verified()) << copy << " " << again.differ.size() << " differ, " << again.missing.size()
                                  << " are missing";
    EXPECT_GT(again.same.size(), 3U);
}

} // namespace

TEST(Replay, EveryFileKeyIsCopied) {
    for (KeyHelp const& key : recipe_keys()) {
        if (key.is_file) {
            auto const at = cases.find(key.path);
            ASSERT_NE(at, cases.end()) << "give a recipe with " << key.path;
            SCOPED_TRACE(key.path);
            expect_replayed(at->second.toml, at->second.copy);
        }
    }
}

TEST(Replay, EstimatedDetailIsWrittenAsItWasUsed) {
    for (std::string const adaptation : {"global", "local"}) {
        std::string const toml =
            grid + "[skeleton]\npoints = \"points.csv\"\n[detail]\nlevels = 3\nadaptation = \"" + adaptation + "\"\n";
        ScratchFolder const folder;
        WalkFiles const files;
        Recipe recipe = read_recipe(toml, "r.toml");
        recipe.folder = files.folder();
        MakeResult const t = make::make(recipe);
        ASSERT_TRUE(t.recipe.detail->midpoint.hurst && t.recipe.detail->midpoint.sigma);
        Recipe const resolved = read_recipe(write_recipe(t.recipe), "again.toml");
        EXPECT_EQ(resolved.detail->midpoint.hurst, t.recipe.detail->midpoint.hurst);
        EXPECT_EQ(resolved.detail->midpoint.sigma, t.recipe.detail->midpoint.sigma);
        expect_replayed(toml, "inputs/points/points.csv");
    }
    std::string const rivers =
        write_recipe(make::make(read_recipe(dla + "[surface]\n[detail]\nsigma = 10\nlevels = 3\n", "r.toml")).recipe);
    EXPECT_TRUE(test::has(rivers, "hurst = 0.6"));
}

TEST(Replay, DefaultsThatAreReckonedAreWritten) {
    std::string const text = write_recipe(make::make(read_recipe(dla + "[surface]\n", "r.toml")).recipe);
    for (char const* line : {"mean_slope = 25.0\n", "heights = 'graded'\n", "edge = 'open'\n", "drain = 'carve'\n",
                             "meander = 1.0\n", "rotate = "}) {
        EXPECT_TRUE(test::has(text, line));
    }
}

} // namespace replay_test
