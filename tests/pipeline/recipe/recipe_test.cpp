// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace recipe_test {

namespace {

using namespace thalweg;
using namespace thalweg::pipeline;
using test::bytes_of;
using test::has;
using test::message_of;

std::string fault_of(std::string const& toml) {
    return message_of<BadParameter>([&] { check_recipe(read_recipe(toml, "r.toml")); });
}

std::string sample(std::string const& name) {
    return bytes_of(THALWEG_SOURCE_DIR "/samples/" + name);
}

} // namespace

TEST(Recipe, EmptyHasNoStages) {
    Recipe const recipe = read_recipe("", "r.toml");
    EXPECT_FALSE(recipe.network);
    EXPECT_FALSE(recipe.surface);
    EXPECT_TRUE(has(fault_of(""), "the recipe describes no terrain: give [network]"));
}

TEST(Recipe, SectionLeftOutIsStageLeftOut) {
    Recipe const recipe = read_recipe("[network]\n", "r.toml");
    EXPECT_TRUE(recipe.network);
    EXPECT_FALSE(recipe.surface);
}

TEST(Recipe, WrittenRecipeReadsBack) {
    Recipe recipe = default_recipe();
    recipe.grid.origin = {1.0 / 3.0, -2.5e6};
    recipe.network->prune_cells = 0.1;
    recipe.output.title = "quotes \" and \\ and 谷";
    std::string const text = write_recipe(recipe);
    EXPECT_EQ(write_recipe(read_recipe(text, "again")), text);
    EXPECT_EQ(read_recipe(text, "again").grid.origin, recipe.grid.origin);
}

TEST(Recipe, DefaultIsTheSample) {
    EXPECT_EQ(write_recipe(read_recipe(sample("relief.toml"), "relief.toml")), write_recipe(default_recipe()));
    EXPECT_EQ(write_recipe(read_recipe(sample("relief_dla.toml"), "relief_dla.toml")), write_recipe(cluster_recipe()));
}

TEST(Recipe, UnknownKeysAreNamedWithTheNearestOne) {
    EXPECT_TRUE(
        has(fault_of("[network]\nprun = 3\n"), "line 2: unknown key 'network.prun'. Did you mean 'network.prune'?"));
    EXPECT_TRUE(has(fault_of("[netwrk]\nprune = 3\n"), "netwrk"));
    EXPECT_TRUE(has(fault_of("particles = 3\n"), "Did you mean 'network.dla.particles'?"));
    EXPECT_TRUE(has(fault_of("[network]\nsource = \"dlaa\"\n"), "Did you mean 'dla'?"));
    EXPECT_TRUE(has(fault_of("[network]\n[surface]\nincrement = \"rise_fal\"\n"), "Did you mean 'rise_fall'?"));
}

TEST(Recipe, AllFaultsAtOnce) {
    std::string const fault = fault_of("[grid]\ncell = 0\nwidth = \"wide\"\n[network.dla]\nsticking = 2\nvisits = 0\n");
    for (char const* part : {"grid.cell: 0 is outside", "grid.width: an integer is required", "sticking: 2 is outside",
                             "visits: 0 is outside"}) {
        EXPECT_TRUE(has(fault, part)) << fault;
    }
}

TEST(Recipe, RangesAreKept) {
    for (char const* bad : {"[grid]\nwidth = 0\nheight = 4\n",
                            "[grid]\nwidth = -5\n",
                            "[grid]\ncell = -1\n",
                            "[grid]\ncell = nan\n",
                            "[grid]\ncell = inf\n",
                            "[network.dla]\nsticking = 0.0\n",
                            "[network.dla]\nsticking = 1.0000001\n",
                            "[network.dla]\nsticking = nan\n",
                            "[network.dla]\nparticles = 0\n",
                            "[network.dla]\nparticles = 1.5\n",
                            "[network.dla]\nvisits = 1000\n",
                            "[network]\nslope = 0\n",
                            "[network]\nprune = -1\n",
                            "seed = -1\n",
                            "[surface]\nrelief = -1\n",
                            "[grid]\norigin = [1]\n",
                            "[grid]\norigin = [1, nan]\n",
                            "[grid]\nclip = 1\n",
                            "[surface]\nincrement = \"x=5\"\n",
                            "[surface]\nincrement = \"3-\"\n",
                            "[grid]\nwidth = 10\n[network]\n",
                            "[network]\nsource = \"lines\"\n",
                            "[network]\nheights = \"file\"\n",
                            "network = 5\n",
                            "[[network]]\n",
                            "[network]\n[network]\n",
                            "a = [[[[1]]]]\n",
                            "= 3\n",
                            "[network\n"}) {
        EXPECT_NE(fault_of(bad), "") << bad;
    }
}

TEST(Recipe, HostileSizesAreRefusedBeforeParsing) {
    std::string deep;
    for (int i = 0; i < 200000; ++i) {
        deep += "a.";
    }
    EXPECT_TRUE(has(fault_of(deep + "a = 1\n"), "longer than"));
    EXPECT_TRUE(has(fault_of(std::string(5 << 20, '\n')), "at most"));
    std::string many;
    for (int i = 0; i < 20000; ++i) {
        many += "k" + std::to_string(i) + " = 1\n";
    }
    EXPECT_LT(fault_of(many).size(), 10000U);
}

TEST(Recipe, SetTakesBareWordsAndNumbers) {
    Recipe recipe = cluster_recipe();
    set_key(recipe, "surface.increment=3-0.01*x");
    set_key(recipe, "network.dla.branch=west");
    set_key(recipe, "network.prune=35");
    set_key(recipe, "grid.origin=[1000, 2000]");
    set_key(recipe, "grid.clip=true");
    EXPECT_EQ(recipe.surface->dilate.increment.increment, "3-0.01*x");
    EXPECT_EQ(recipe.network->branch, network::BranchChoice::west);
    EXPECT_EQ(recipe.network->prune_cells, 35.0);
    EXPECT_EQ((*recipe.grid.origin)[1], 2000.0);
    EXPECT_TRUE(recipe.grid.clip);
    for (char const* bad : {"", "=", "surface", "surface.increment=rise_fal", "network.prune=x", "grid.width=1.5",
                            "nothing.here=1", "grid.cell=1; rm", "grid.cell=\n[a]\nb=1"}) {
        EXPECT_THROW(set_key(recipe, bad), BadParameter) << bad;
    }
}

TEST(Recipe, PatchesAreReadInTheirOrderAndWrittenBack) {
    Recipe const recipe = read_recipe("[network]\n[surface]\n[[patch]]\nsource = \"a.tif\"\nwindow = [0, 1, 20, 30]\n"
                                      "[[patch]]\nsource = \"b.tif\"\nrotate = 30\nat = [1, 2]\n",
                                      "r.toml");
    ASSERT_EQ(recipe.patches.size(), 2U);
    EXPECT_EQ(recipe.patches[0].source, "a.tif");
    EXPECT_EQ((*recipe.patches[0].window)[3], 30.0);
    EXPECT_EQ(recipe.patches[1].rotate_deg, 30.0);
    std::string const text = write_recipe(recipe);
    EXPECT_EQ(write_recipe(read_recipe(text, "again")), text);
    EXPECT_EQ(read_recipe(text, "again").patches.size(), 2U);
}

TEST(Recipe, PatchesAreSetByNumber) {
    Recipe recipe = cluster_recipe();
    set_key(recipe, "patch.source=a.tif");
    recipe.patches.push_back({.source = "b.tif"});
    set_key(recipe, "patch.1.rotate=45");
    set_key(recipe, "patch.2.scale=2");
    EXPECT_EQ(recipe.patches[0].rotate_deg, 45.0);
    EXPECT_EQ(recipe.patches[1].scale, 2.0);
    Recipe with_a_third = recipe;
    set_key(with_a_third, "patch.3.source=c.tif");
    EXPECT_EQ(with_a_third.patches.at(2).source, "c.tif");
    for (char const* bad : {"patch.4.scale=2", "patch.0.scale=2", "patch.x.scale=2", "patch.2.scale=0", "patch=3",
                            "patch.window=[1,2,3]", "patch.window=[0,0,0,1]"}) {
        EXPECT_THROW(set_key(recipe, bad), BadParameter) << bad;
    }
    EXPECT_TRUE(has(fault_of("[network]\n[surface]\n[[patch]]\nrotate = 1\n"), "patch 1: source is missing"));
    EXPECT_TRUE(has(fault_of("[network]\n[surface]\n[[patch]]\nsorce = \"a\"\n"), "Did you mean 'patch.source'?"));
}

TEST(Recipe, HoldsNoFunction) {
    Recipe recipe = cluster_recipe();
    EXPECT_NO_THROW(check_recipe(recipe));
    ASSERT_TRUE(recipe.surface);
    recipe.surface->dilate.increment.function = [](double x) { return x; };
    EXPECT_TRUE(has(message_of<BadParameter>([&] { check_recipe(recipe); }),
                    "surface.increment is a function, which no recipe can hold"));
}

TEST(Recipe, EveryKeyHasAMeaning) {
    for (KeyHelp const& key : recipe_keys()) {
        EXPECT_FALSE(key.meaning.empty()) << key.path;
        EXPECT_FALSE(key.type.empty()) << key.path;
    }
}

} // namespace recipe_test
