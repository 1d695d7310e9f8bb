// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/refuse.hpp>

#include <string>
#include <type_traits>

#include <gtest/gtest.h>

namespace error_test {

using namespace thalweg;

namespace {

struct Parts {
    std::string where;
    std::string what;
};

Parts parts(std::string const& text) {
    BadInput const e(text);
    return {e.where(), e.what()};
}

TEST(Error, ATextWithoutAModuleIsTheMessage) {
    for (std::string const text :
         {"", "no prefix", "grid: 3 cells", "grid.origin: beyond", "network: x", "networks.prune: x", "network.: x",
          "network.prune", "network.prune:x", "network.lines.path: x", "network.a b: x", "line 3: network.prune: x"}) {
        EXPECT_EQ(parts(text).where, "") << text;
        EXPECT_EQ(parts(text).what, text);
    }
}

TEST(Error, TheFunctionIsKeptApart) {
    EXPECT_EQ(parts("network.prune: L is 3: too short").where, "network.prune");
    EXPECT_EQ(parts("network.prune: L is 3: too short").what, "L is 3: too short");
    EXPECT_EQ(parts("io.UnchangedFile: ").where, "io.UnchangedFile");
    EXPECT_EQ(parts("io.UnchangedFile: ").what, "");
}

TEST(Error, AFileNamedLikeAFunctionStays) {
    EXPECT_EQ(parts("recipe.read_recipe: network.toml: line 1: x\nnetwork.toml: line 2: y").what,
              "network.toml: line 1: x\nnetwork.toml: line 2: y");
}

TEST(Error, EveryLineIsFreedOfTheSamePrefix) {
    EXPECT_EQ(parts("io.read_dem: a\nio.read_dem: b\n\n  c\nio.read: d\n").what, "a\nb\n\n  c\nio.read: d\n");
}

TEST(Error, WhatIsThrownAgainKeepsItsFunction) {
    try {
        try {
            throw BadInput("network.from_file: arc 3 has no length");
        } catch (Error const& e) {
            throw BadInput(std::string(e.where()) + ": " + e.what() + "; mend it");
        }
    } catch (Error const& e) {
        EXPECT_STREQ(e.where(), "network.from_file");
        EXPECT_STREQ(e.what(), "arc 3 has no length; mend it");
    }
}

TEST(Error, ARefusalThrowsOnlyWhereSomethingIsWrong) {
    refuse_if<BadInput>(false, "network.prune: {} cells", 3);
    try {
        refuse_if<BadParameter>(true, "network.prune: {{{}}} of {:.1f}", std::string("a"), 2.25);
        FAIL();
    } catch (BadParameter const& e) {
        EXPECT_STREQ(e.where(), "network.prune");
        EXPECT_STREQ(e.what(), "{a} of 2.2");
    }
}

static_assert(std::is_nothrow_copy_constructible_v<BadInput>);

} // namespace

} // namespace error_test
