// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Five recipe.toml files that version 0.1.0 wrote: they list every key of their sections, used or not.
#include <thalweg/make/make.hpp>

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <golden.hpp>
#include <gtest/gtest.h>
#include <house/fnv.hpp>
#include <recipe/old_recipes.hpp>

#include <thalweg/recipe/check_recipe.hpp>

namespace recipes_0_1_0_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;

namespace {

std::string hash_of(Raster<float> const& raster) {
    Fnv hash;
    hash.add_all(raster.values());
    return fmt::format("{:016x}", hash.hash());
}

} // namespace

TEST(Recipes010, RunAndGiveTheirOldTerrain) {
    std::string text;
    for (std::string const& name : old_recipe_names()) {
        MakeResult const t = make::make(old_recipe(name));
        for (Check const& c : t.assessment.checks) { // of 64 x 64 cells full of rivers, some side by side
            bool const crowded = name == "tin_rivers" && c.name == "trace_f_same_cell" && c.value > 0.975;
            EXPECT_TRUE(c.ok || crowded) << name << " " << c.name << " " << c.value;
        }
        text += fmt::format("{} {}\n", name,
                            hash_of(t.terrain.has_surface() ? t.terrain.ground.dem : t.terrain.bed.valley.raster()));
    }
    expect_golden("recipes_0_1_0/hashes.txt", text); // made of dem.tif as 0.1.0 wrote it; a network alone: its valley
}

TEST(Recipes010, AreWrittenWithTheKeysTheyUseAlone) {
    for (std::string const& name : old_recipe_names()) {
        Recipe const recipe = old_recipe(name);
        EXPECT_TRUE(unused_keys(recipe).empty()) << name;
        std::string const written = write_recipe(recipe);
        EXPECT_EQ(write_recipe(read_recipe(written, name)), written) << name;
        EXPECT_LT(written.size(), std::filesystem::file_size(old_recipes / name / "recipe.toml")) << name;
    }
}

} // namespace recipes_0_1_0_test
