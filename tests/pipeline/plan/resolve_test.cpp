// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/plan.hpp>

#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "old_recipes.hpp"

namespace resolve_test {

using namespace thalweg;
using namespace thalweg::pipeline;

namespace {

using test::on_threads;

namespace fs = std::filesystem;

void expect_same_lines(RiverLines const& a, RiverLines const& b) {
    ASSERT_EQ(a.lines.size(), b.lines.size());
    for (std::size_t i = 0; i < a.lines.size(); ++i) {
        EXPECT_EQ(a.lines[i].feature, b.lines[i].feature);
        EXPECT_TRUE(std::equal(a.lines[i].vertices.begin(), a.lines[i].vertices.end(), b.lines[i].vertices.begin(),
                               b.lines[i].vertices.end(),
                               [](Vec3 p, Vec3 q) { return p.x == q.x && p.y == q.y && !(p.z < q.z || p.z > q.z); }));
    }
}

} // namespace

TEST(Resolve, RefusesAnEmptyRecipeAndAMissingFile) {
    EXPECT_THROW(resolve(Recipe{}), BadParameter);
    Recipe recipe = cluster_recipe();
    set_key(recipe, "surface.mask=nowhere.tif");
    EXPECT_THROW(resolve(recipe), BadInput);
}

// The law: the same recipe and files give the same plan.
TEST(Resolve, TwiceGivesTheSamePlan) {
    thalweg::Run const alone = on_threads(1);
    int recipes = 0;
    for (fs::directory_entry const& entry : fs::directory_iterator(old_recipes())) {
        if (!entry.is_directory()) {
            continue;
        }
        SCOPED_TRACE(entry.path().filename().string());
        Recipe const recipe = recipe_in(entry.path());
        Plan const one = resolve(recipe);
        Plan const two = resolve(recipe, alone);
        EXPECT_EQ(write_recipe(one.recipe), write_recipe(two.recipe));
        EXPECT_EQ(one.grid, two.grid);
        EXPECT_EQ(one.heights_of_file, two.heights_of_file);
        expect_same_lines(one.lines, two.lines);
        EXPECT_EQ(one.tree ? one.tree->links.size() : 0U, two.tree ? two.tree->links.size() : 0U);
        EXPECT_EQ(one.forest ? one.forest->outlets : std::vector<Cell>{},
                  two.forest ? two.forest->outlets : std::vector<Cell>{});
        EXPECT_EQ(one.points.points, two.points.points);
        EXPECT_EQ(forecast(one).stages, forecast(two).stages);
        EXPECT_EQ(forecast(one).memory_bytes, forecast(two).memory_bytes);
        ++recipes;
    }
    EXPECT_GT(recipes, 20);
}

// The law: a plan's recipe is a recipe of its own, of which the plan is the same.
TEST(Resolve, APlansRecipeResolvesToItself) {
    for (fs::directory_entry const& entry : fs::directory_iterator(old_recipes())) {
        if (entry.is_directory()) {
            SCOPED_TRACE(entry.path().filename().string());
            Recipe planned = resolve(recipe_in(entry.path())).recipe;
            planned.set_at.clear(); // what follows from others need not have an effect of its own
            EXPECT_EQ(write_recipe(resolve(planned).recipe), write_recipe(planned));
        }
    }
}

TEST(Resolve, SettlesWhatTheRecipeLeavesOpen) {
    Recipe recipe = cluster_recipe();
    recipe.grid.width = 0;
    recipe.grid.height = 0;
    Plan const grown = resolve(recipe);
    EXPECT_FALSE(grown.grid); // it follows from a cluster
    EXPECT_EQ(grown.recipe.network->heights, Heights::graded);
    EXPECT_EQ(grown.recipe.network->meander, 1.0);
    EXPECT_TRUE(grown.recipe.network->rotate_deg);
    EXPECT_EQ(grown.recipe.surface->equilibrium.mean_slope_deg, 25.0);
    EXPECT_EQ(grown.recipe.surface->drain, flow::Conditioning::carve);
    EXPECT_FALSE(grown.recipe.grid.crs.empty());
    EXPECT_EQ(grown.recipe.network->dla.seed, recipe.seed);

    Recipe lines = recipe_in(old_recipes() / "equilibrium_lines");
    lines.grid.cell_m = 0.0;
    Plan const drawn = resolve(lines);
    ASSERT_TRUE(drawn.grid);
    EXPECT_GT(drawn.recipe.grid.cell_m, 0.0);
    EXPECT_EQ(drawn.grid->cell_m, drawn.recipe.grid.cell_m);
    EXPECT_EQ(drawn.grid->crs, drawn.recipe.grid.crs);
    EXPECT_FALSE(drawn.lines.lines.empty());
    EXPECT_EQ(drawn.timings_s.front().first, "read");
}

TEST(Resolve, AnIslandHasItsCoastBeforeItsRivers) {
    Plan const plan = resolve(read_recipe("[grid]\nwidth = 96\nheight = 96\n[network]\nsource = \"forest\"\n"
                                          "[network.forest]\nshape = \"island\"\n[surface]\n",
                                          "r.toml"));
    ASSERT_TRUE(plan.forest);
    EXPECT_TRUE(plan.forest->has_sea);
    EXPECT_FALSE(plan.forest->outlets.empty());
    EXPECT_EQ(plan.recipe.network->meander, 0.3); // short rivers bend less
}

} // namespace resolve_test
