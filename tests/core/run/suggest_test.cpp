// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/messages.hpp>

#include <gtest/gtest.h>

namespace suggest_test {

using thalweg::closest;

TEST(Suggest, NothingNear) {
    EXPECT_EQ(closest("", {}), "");
    EXPECT_EQ(closest("", {"dilate"}), "");
    EXPECT_EQ(closest("zebra", {"dilate", "diffuse"}), "");
    EXPECT_EQ(closest("x", {"uniform"}), "");
}

TEST(Suggest, TypingErrors) {
    std::vector<std::string> const known = {"uniform", "decreasing", "rise_fall"};
    EXPECT_EQ(closest("rise_fal", known), "rise_fall");
    EXPECT_EQ(closest("risefall", known), "rise_fall");
    EXPECT_EQ(closest("unifrom", known), "uniform");
    EXPECT_EQ(closest("decreasing", known), "decreasing");
    EXPECT_EQ(thalweg::did_you_mean("unifom", known), " Did you mean 'uniform'?");
}

TEST(Suggest, SwappedNeighboursAreOneSlip) {
    std::vector<std::string> const known = {"make", "check", "man"};
    EXPECT_EQ(closest("maek", known), "make");
    EXPECT_EQ(closest("mkae", known), "make");
    EXPECT_EQ(closest("chekc", known), "check");
    EXPECT_EQ(closest("ekam", known), "");
}

} // namespace suggest_test
