// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>

namespace toml_depth_test {

using thalweg::pipeline::line_deeper_than;

namespace {

using test::has;
using test::message_of;

/// The least number of levels that is enough.
std::size_t depth_of(std::string const& toml) {
    std::size_t most = 0;
    while (line_deeper_than(toml, most)) {
        ++most;
    }
    return most;
}

} // namespace

TEST(TomlDepth, EachWayToNestCountsOne) {
    EXPECT_EQ(depth_of(""), 0U);
    EXPECT_EQ(depth_of("a = 1\n"), 1U);
    EXPECT_EQ(depth_of("a.b.c = 1\nd = 2\n"), 3U);
    EXPECT_EQ(depth_of("[a.b]\nc = 1\n"), 3U);
    EXPECT_EQ(depth_of("[[a]]\nb = 1\n[c]\nd.e = 1\n"), 3U);
    EXPECT_EQ(depth_of("a = [[1, 2], [3]]\n"), 3U);
    EXPECT_EQ(depth_of("a.b = {c.d = [1]}\n"), 5U);
    EXPECT_EQ(depth_of("a = [1, 2,\n 3]\nb = [4]\n"), 2U) << "a line does not add to the next";
}

TEST(TomlDepth, StringsAndCommentsHaveNone) {
    for (char const* const toml : {"a = '[[[[...'\n", "a = \"[[[[\\\"...\"\n", "a = '''[[[\n...''' # [[[...\n",
                                   "a = \"\"\"[[[\n\\\"\"\"...\"\"\"\n", "# [[[[....\na = 1\n", "'a.b.c.d' = 1\n"}) {
        EXPECT_LE(depth_of(toml), 2U) << toml;
    }
}

TEST(TomlDepth, NamesTheLine) {
    EXPECT_EQ(line_deeper_than("a = '''\n\n'''\n[b.c]\nd = [[1]]\n", 4), 5U);
    EXPECT_EQ(line_deeper_than("a = [\n[\n[\n", 2), 2U);
}

TEST(TomlDepth, WhatIsNoTomlEnds) {
    for (char const* const toml : {"]]]]", "}}}\n[", "'", "\"", "\"\"\"", "'''\n", "\"\\", "[", "a = \"\n", "#"}) {
        EXPECT_LE(depth_of(toml), 3U) << toml;
    }
}

// 120 inline tables in arrays, each under a key of 3500 parts: toml++ reads them and gives 420 000 frames back at once.
TEST(TomlDepth, ARecipeOfNestedTablesIsRefusedWithItsLine) {
    std::string part = "{a";
    for (int i = 1; i < 3500; ++i) {
        part += ".a";
    }
    std::string text = "seed = 1\na = [";
    std::string end;
    for (int i = 0; i < 120; ++i) {
        text += part + "=[\n";
        end += "]}";
    }
    text += end + "]\n";
    ASSERT_LT(text.size(), std::size_t{1} << 20U);
    EXPECT_TRUE(has(message_of<thalweg::BadParameter>([&] { thalweg::pipeline::read_recipe(text, "deep.toml"); }),
                    "deep.toml: line 2: "));
}

} // namespace toml_depth_test
