// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/plan.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/make/make.hpp>
#include <thalweg/pipeline/plan/frame.hpp>

#include "old_recipes.hpp"

namespace forecast_test {

using namespace thalweg;
using namespace thalweg::pipeline;

namespace {

using test::message_of;

namespace fs = std::filesystem;

void expect_as_foretold(Recipe const& recipe, std::string const& name) {
    Forecast const said = forecast(recipe);
    Made const made = make(recipe);
    std::vector<std::string> stages;
    for (auto const& [stage, seconds] : timings_of(made)) {
        stages.push_back(stage);
    }
    EXPECT_EQ(said.stages, stages) << name;
    if (said.grid) {
        EXPECT_EQ(*said.grid, made.terrain.grid) << name;
        EXPECT_EQ(said.cells, made.terrain.grid.cells()) << name;
    }
    EXPECT_GT(said.cells, 0) << name;
    EXPECT_GT(said.memory_bytes, bytes_needed(said.cells)) << name;
    EXPECT_GT(said.seconds, 0.0) << name;
}

TEST(Forecast, RefusesWhatMakeRefuses) {
    EXPECT_THROW(forecast(Recipe{}), BadParameter); // no terrain
    Recipe recipe = cluster_recipe();
    set_key(recipe, "network.source=lines");
    EXPECT_THROW(forecast(recipe), BadParameter); // no file
    recipe = cluster_recipe();
    set_key(recipe, "surface.erodibility=nowhere.tif");
    EXPECT_EQ(message_of<BadInput>([&] { forecast(recipe); }),
              "surface.erodibility = \"nowhere.tif\": there is no such file");
    recipe = cluster_recipe();
    set_key(recipe, "patch.1.source=nowhere.tif");
    set_key(recipe, "patch.2.source=" + (old_recipes() / "detail_points/recipe.toml").string());
    EXPECT_EQ(message_of<BadInput>([&] { forecast(recipe); }),
              "patch.1.source = \"nowhere.tif\": there is no such file");
    recipe = cluster_recipe();
    set_key(recipe, "grid.width=1000000");
    set_key(recipe, "grid.height=1000000");
    EXPECT_THROW(forecast(recipe), BadInput); // more memory than any machine has
}

// The law: a run times these stages in this order, on this grid.
TEST(Forecast, IsWhatARunDoes) {
    int recipes = 0;
    for (fs::directory_entry const& entry : fs::directory_iterator(old_recipes())) {
        if (entry.is_directory()) {
            expect_as_foretold(recipe_in(entry.path()), entry.path().filename().string());
            ++recipes;
        }
    }
    EXPECT_GT(recipes, 20);
}

TEST(Forecast, OfSettingsThatAddStages) {
    for (std::vector<std::string> const& settings : std::vector<std::vector<std::string>>{
             {"network.fill_space=true", "output.accumulation=true"},
             {"network.heights=soft", "network.slope=0.01", "output.catchments=false"},
             {"surface.drain=none"},
             {"network.meander=0.5"}}) {
        Recipe recipe = recipe_in(old_recipes() / "equilibrium_lines");
        for (std::string const& setting : settings) {
            set_key(recipe, setting);
        }
        expect_as_foretold(recipe, settings.front());
    }
    Recipe recipe = recipe_in(old_recipes() / "equilibrium_lines");
    recipe.grid.cell_m = 0.0;
    expect_as_foretold(recipe, "a cell chosen from the rivers");
}

// A cluster's grid is known where it is given, and guessed within a factor of three elsewhere.
TEST(Forecast, OfAGridThatIsStillUnknown) {
    Recipe recipe = cluster_recipe();
    recipe.grid.width = 0;
    recipe.grid.height = 0;
    set_key(recipe, "network.dla.particles=20000");
    recipe.surface.reset();
    Forecast const said = forecast(recipe);
    EXPECT_FALSE(said.grid);
    auto const ratio = static_cast<double>(said.cells) / static_cast<double>(make(recipe).terrain.grid.cells());
    EXPECT_GT(ratio, 1.0 / 3.0);
    EXPECT_LT(ratio, 3.0);
}

} // namespace

} // namespace forecast_test
