// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/recipe/presets.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace presets_test {

using namespace thalweg;
using namespace thalweg::recipe;

namespace {

using test::has;
using test::message_of;

std::map<std::string, std::optional<std::string>> values_of(Recipe const& recipe) {
    std::map<std::string, std::optional<std::string>> values;
    for (KeyValue const& key : key_values(recipe)) {
        values[key.path] = key.text;
    }
    return values;
}

Recipe recipe_of(std::string const& surface) {
    return read_recipe("[grid]\nwidth = 64\nheight = 64\n[network]\nsource = \"forest\"\n[surface]\n" + surface,
                       "r.toml");
}

std::string fault_of(Recipe const& recipe, std::string const& name) {
    return message_of<BadParameter>([&] { with_preset(recipe, name); });
}

} // namespace

TEST(Presets, ChangeWhatTheyNameAndNothingElse) {
    auto const before = values_of(default_recipe());
    for (Preset const& preset : presets()) {
        Recipe const recipe = with_preset(default_recipe(), preset.name);
        EXPECT_NO_THROW(check_recipe(recipe)) << preset.name;
        Recipe keyed = default_recipe();
        for (KeyValue const& key : preset.keys) {
            EXPECT_FALSE(key.path.starts_with("network.") && key.path != "network.concavity") << "rivers may be given";
            ASSERT_NO_THROW(set_key(keyed, key.path, key.text.value())) << key.path;
            EXPECT_NO_THROW(require_effect(keyed, key.path)) << preset.name;
        }
        auto const after = values_of(recipe);
        EXPECT_EQ(after, values_of(keyed)) << preset.name;
        for (KeyValue const& key : preset.keys) {
            EXPECT_TRUE(!before.contains(key.path) || before.at(key.path) != after.at(key.path))
                << preset.name << ": " << key.path << " has its default";
        }
        EXPECT_EQ(write_recipe(read_recipe(write_recipe(recipe), "again")), write_recipe(recipe)) << preset.name;
        EXPECT_FALSE(preset.meaning.empty() || preset.not_meant.empty()) << preset.name;
    }
}

TEST(Presets, GoBehindWhatIsSet) {
    Recipe recipe = recipe_of("mean_slope = 17\nhillslope = 15\n"); // its default, but set
    set_key(recipe, "surface.lake_share=0");
    auto const values = values_of(with_preset(recipe, "hills"));
    EXPECT_EQ(values.at("surface.mean_slope"), "17.0");
    EXPECT_EQ(values.at("surface.hillslope"), "15.0");
    EXPECT_EQ(values.at("surface.lake_share"), "0.0");
    EXPECT_EQ(values.at("surface.uplift_pattern"), "domes");
}

TEST(Presets, LeaveOutWhatOtherKeysDecide) {
    EXPECT_FALSE(values_of(with_preset(recipe_of("relief = 300\n"), "hills")).contains("surface.mean_slope"));
    auto const flat = values_of(with_preset(recipe_of("uplift_pattern = \"none\"\nlakes = \"a.gpkg\"\n"), "hills"));
    EXPECT_FALSE(flat.contains("surface.uplift_contrast"));
    EXPECT_EQ(flat.at("surface.lake_share"), "0.0");
    Recipe const even = with_preset(recipe_of("roughness = 0\nlike = \"a.tif\"\n"), "hills");
    EXPECT_EQ(even.surface->equilibrium.grain, EquilibriumRecipe{}.grain) << "without an effect: the default";
    EXPECT_EQ(even.surface->equilibrium.mean_slope_deg, std::nullopt) << "it is that of the DEM";
    for (Recipe const& recipe : {with_preset(recipe_of("relief = 300\n"), "hills"),
                                 with_preset(recipe_of("uplift_pattern = \"none\"\n"), "basin-and-range"),
                                 with_preset(recipe_of("roughness = 0\n"), "dissected-plateau")}) {
        EXPECT_NO_THROW(check_recipe(recipe));
    }
}

TEST(Presets, LeaveLayersAsTheyAreSet) {
    Recipe const own = recipe_of("[[layer]]\nstrength = 2\n");
    auto const values = values_of(with_preset(own, "canyonlands"));
    EXPECT_EQ(values.at("layer.1.strength"), "2.0");
    EXPECT_FALSE(values.contains("layer.2.strength") || values.contains("strata.base"));
    EXPECT_EQ(values.at("surface.roughness"), "0.35");
    Recipe const steep = with_preset(recipe_of("mean_slope = 12\n"), "canyonlands");
    EXPECT_EQ(steep.layers.size(), 5U);
    EXPECT_EQ(steep.strata->cap_share, std::nullopt) << "the mean slope is set";
    EXPECT_EQ(with_preset(recipe_of("relief = 300\n"), "mesa").strata->cap_share, std::nullopt);
    EXPECT_EQ(with_preset(default_recipe(), "mesa").strata->cap_share, 0.35);
    EXPECT_NO_THROW(check_recipe(steep));
    Recipe added = with_preset(default_recipe(), "mesa");
    set_key(added, "layer.3.strength=9");
    EXPECT_EQ(added.layers[2].strength, 9.0);
}

TEST(Presets, AreOfEquilibriumTerrain) {
    EXPECT_TRUE(has(fault_of(recipe_of("method = \"dilate\"\n"), "hills"), "preset 'hills' is of equilibrium terrain",
                    "it needs surface.method = \"equilibrium\" (here it is \"dilate\")"));
    EXPECT_TRUE(has(fault_of(read_recipe("[network]\n", "r.toml"), "hills"), "it needs"));
    EXPECT_TRUE(has(fault_of(read_recipe("", "r.toml"), "hills"), "it needs"));
}

TEST(Presets, AreKnownByTheirNames) {
    EXPECT_TRUE(has(fault_of(default_recipe(), "hill"), "no preset is called 'hill'",
                    "hills, basin-and-range, dissected-plateau", "Did you mean 'hills'?"));
    Recipe const made = read_recipe(write_recipe(with_preset(default_recipe(), "hills")), "recipe.toml");
    EXPECT_TRUE(has(fault_of(made, "hills"), "has no effect: the recipe sets every key of it"));
}

} // namespace presets_test
