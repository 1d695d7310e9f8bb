// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/refuse.hpp>

#include <string>
#include <string_view>
#include <type_traits>

#include <gtest/gtest.h>

namespace error_test {

using namespace thalweg;

namespace {

TEST(Error, KeepsTheFunctionAndTheMessageApart) {
    BadInput const e("network.prune", "L is 3: too short");
    EXPECT_STREQ(e.where(), "network.prune");
    EXPECT_STREQ(e.what(), "L is 3: too short");
}

TEST(Error, TakesTextsAsTheyAre) {
    for (std::string const text : {"", "network.prune: x", "io.read_dem: a\nio.read_dem: b\n", ": ", "grid: 3 cells"}) {
        BadInput const e("network.prune", text);
        EXPECT_STREQ(e.where(), "network.prune");
        EXPECT_EQ(e.what(), text);
        EXPECT_EQ(BadInput(text, "x").where(), text);
    }
}

TEST(Error, WhatIsThrownAgainKeepsItsFunction) {
    try {
        try {
            throw BadInput("network.from_file", "arc 3 has no length");
        } catch (Error const& e) {
            throw BadInput(e.where(), std::string(e.what()) + "; mend it");
        }
    } catch (Error const& e) {
        EXPECT_STREQ(e.where(), "network.from_file");
        EXPECT_STREQ(e.what(), "arc 3 has no length; mend it");
    }
}

TEST(Error, ARefusalThrowsOnlyWhereSomethingIsWrong) {
    refuse_if<BadInput>(false, "network.prune", "{} cells", 3);
    for (std::string const where : {"network.prune", "io.read_dem"}) {
        try {
            refuse_if<BadParameter>(true, where, "{{{}}} of {:.1f}", std::string("a"), 2.25);
            FAIL();
        } catch (BadParameter const& e) {
            EXPECT_EQ(e.where(), where);
            EXPECT_STREQ(e.what(), "{a} of 2.2");
        }
    }
    EXPECT_THROW(refuse_if<IoError>(true, std::string_view("io.read_dem"), "no file"), IoError);
    EXPECT_THROW(refuse_if<IoError>(true, "io.read_dem", "no file"), IoError);
}

static_assert(!std::is_constructible_v<Error, std::string>); // no text from which the function would have to be guessed
static_assert(std::is_nothrow_copy_constructible_v<BadInput>);

} // namespace

} // namespace error_test
