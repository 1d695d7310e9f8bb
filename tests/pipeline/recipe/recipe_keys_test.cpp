// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

namespace recipe_keys_test {

using namespace thalweg;
using namespace thalweg::pipeline;

TEST(RecipeKeys, PathsDiffer) {
    std::set<std::string> paths;
    for (Key const& key : all_keys()) {
        EXPECT_TRUE(paths.insert(key.help.path).second) << key.help.path;
        EXPECT_EQ(find_key(key.help.path), &key);
    }
}

TEST(RecipeKeys, DefaultsGoThroughTheirOwnChecks) {
    Recipe const standard = with_all_sections();
    for (Key const& key : all_keys()) {
        if (auto const value = key.take(standard)) {
            Recipe recipe = standard;
            EXPECT_NO_THROW(key.put(recipe, *value)) << key.help.path;
            EXPECT_EQ(key.take(recipe), value) << key.help.path;
        }
    }
}

TEST(RecipeKeys, NumbersHaveARange) {
    for (Key const& key : all_keys()) {
        bool const is_number = key.help.type == "number" || key.help.type == "integer";
        EXPECT_EQ(key.range.has_value(), is_number) << key.help.path;
        EXPECT_FALSE(key.help.range.empty()) << key.help.path;
    }
}

TEST(RecipeKeys, AValueThatIsRefusedChangesNothing) {
    Recipe recipe;
    EXPECT_THROW(find_key("statistics.std")->put(recipe, -1.0), BadParameter);
    EXPECT_FALSE(recipe.statistics);
    EXPECT_THROW(find_key("patch.gain")->put(recipe, std::string("much")), BadParameter);
    EXPECT_TRUE(recipe.patches.empty());
}

TEST(RecipeKeys, ThoseOfAnArrayReachEachItem) {
    Recipe recipe;
    Key const& gain = *find_key("patch.gain");
    EXPECT_EQ(gain.take(recipe), std::nullopt);
    gain.put(recipe, 2.0);
    gain.put(recipe, 3.0, 1);
    gain.put(recipe, 4.0); // the last
    EXPECT_EQ(gain.take(recipe, 0), Value(2.0));
    EXPECT_EQ(gain.take(recipe, 1), Value(4.0));
    EXPECT_EQ(gain.place(1), "patch.2.gain");
    EXPECT_EQ(find_key("network.slope")->place(0), "network.slope");
}

TEST(RecipeKeys, FilesAreThoseOfEverySectionAndItem) {
    Recipe recipe;
    recipe.network.emplace().lines.path = "a.gpkg";
    recipe.network->lines.layer = "rivers";
    recipe.patches = {{.source = "b.tif"}, {.source = "c.tif", .mask = "d.gpkg"}};
    std::vector<std::string> found;
    for (NamedFile const& file : files_of(recipe)) {
        found.push_back(file.key->place(file.item) + " " + file.name + " " + file.layer);
    }
    EXPECT_EQ(found, (std::vector<std::string>{"network.lines.path a.gpkg rivers", "patch.1.source b.tif ",
                                               "patch.2.source c.tif ", "patch.2.mask d.gpkg "}));
}

} // namespace recipe_keys_test
