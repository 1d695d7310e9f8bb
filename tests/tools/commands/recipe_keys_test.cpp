// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

namespace recipe_keys_test {

using nlohmann::json;

namespace {

using test::has;

Outcome recipe(std::string const& arguments) {
    return thalweg_run("recipe " + arguments, std::filesystem::temp_directory_path());
}

} // namespace

TEST(RecipeKeys, ASectionOrANameGivesItsKeys) {
    std::string const section = recipe("network.dla").out;
    EXPECT_EQ(section.rfind("[network.dla]\n", 0), 0U) << section;
    EXPECT_TRUE(has(section, "\nparticles "));
    EXPECT_FALSE(has(section, "[network.tokunaga]"));
    EXPECT_EQ(recipe("'[network.dla]'").out, section);
    std::string const all_of_network = recipe("network").out;
    EXPECT_TRUE(has(all_of_network, "[network]\n") && has(all_of_network, "[network.forest]\n")) << all_of_network;
    EXPECT_FALSE(has(all_of_network, "[surface]"));
    std::string const sticking = recipe("sticking").out; // of clusters and of forests
    EXPECT_TRUE(has(sticking, "[network.dla]\n") && has(sticking, "[network.forest]\n")) << sticking;
    EXPECT_TRUE(has(recipe("prune").out, "network.prune\n"));
}

TEST(RecipeKeys, AnUnknownOneIsRefused) {
    Workplace const place;
    expect_refused(place, "recipe", {"network.prun", "wombat", "'[]'", "grid network"});
}

TEST(RecipeKeys, AsJson) {
    json const all = recipe("--json").json();
    EXPECT_GT(all["keys"].size(), 100U);
    json const one = recipe("network.source --json").json();
    ASSERT_EQ(one["keys"].size(), 1U);
    EXPECT_EQ(one["keys"][0]["key"], "network.source");
    EXPECT_EQ(one["keys"][0]["choices"].size(), 4U);
    for (char const* field : {"meaning", "type", "unit", "range", "default"}) {
        EXPECT_TRUE(one["keys"][0][field].is_string()) << field;
    }
}

} // namespace recipe_keys_test
