// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/dilation/increment.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "valleys.hpp"

namespace increment_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

using test::full_message_of;

std::vector<double> sums(std::int64_t levels, IncrementParams const& params) {
    return heights_above_valley(increments(levels, params));
}

std::string refusal(std::string const& text) {
    return full_message_of<BadParameter>([&] { increments(10, {text}); });
}

TEST(Increments, NoLevels) {
    EXPECT_TRUE(increments(0).empty());
    EXPECT_EQ(heights_above_valley({}), std::vector<double>{0.0});
    EXPECT_THROW(increments(-1), BadParameter);
}

TEST(Increments, SumsOfTable1) {
    EXPECT_NEAR(sums(1000, {"uniform"})[1000], 100.0, 1e-9);
    auto const decreasing = sums(1000, {"decreasing"});
    EXPECT_NEAR(decreasing[300], 448.5, 1e-9);
    EXPECT_EQ(decreasing[1000], decreasing[300]);
    auto const rise_fall = sums(1000, {"rise_fall"});
    EXPECT_NEAR(rise_fall[150], 339.75, 1e-9);
    EXPECT_NEAR(rise_fall[600], 1350.0, 1e-9);
}

TEST(Increments, FallOnlyWhereAllowed) {
    EXPECT_EQ(sums(700, {"rise_fall"})[700], sums(700, {"rise_fall"})[600]);
    EXPECT_NEAR(sums(700, {"rise_fall", true})[700], 1299.5, 1e-9);
    EXPECT_EQ(increments(1, {"-x"}), std::vector<double>{0.0});
    EXPECT_EQ(increments(1, {"-x", true}), std::vector<double>{-1.0});
}

TEST(Increments, JumpsAreFoundWhereTheyAre) {
    for (char const* const name : {"uniform", "decreasing", "rise_fall", "3-0.01*x", "x<=150 ? 0.03*x : 6-0.01*x",
                                   "x<300 ? 3-0.01*x : 0", "x*x*x", "exp(-x/20)", "abs(x-30)"}) {
        EXPECT_TRUE(increment_jumps(700, {name}).empty()) << name;
        EXPECT_TRUE(increment_jumps(700, {name, true}).empty()) << name;
    }
    EXPECT_TRUE(increment_jumps(0, {"x<10 ? 1 : 5"}).empty());
    EXPECT_TRUE(increment_jumps(9, {"x<10 ? 1 : 5"}).empty());
    auto const jumps = increment_jumps(200, {"x<=100 ? 0.03*x : 6-0.01*x"}); // a D = 3, K - b D = 5
    ASSERT_EQ(jumps.size(), 1U);
    EXPECT_NEAR(jumps[0].x, 100.0, 1e-6);
    EXPECT_NEAR(jumps[0].from, 3.0, 1e-6);
    EXPECT_NEAR(jumps[0].to, 5.0, 1e-6);
    EXPECT_EQ(increment_jumps(100, {"rint(x/10)"}).size(), 10U);
    EXPECT_TRUE(increment_jumps(200, {"x<=100 ? 0-x : 0-2*x"}).empty()); // all below 0, which count as 0
    EXPECT_EQ(increment_jumps(200, {"x<=100 ? 0-x : 0-2*x", true}).size(), 1U);
    EXPECT_THROW(increment_jumps(10, {"nonsense"}), BadParameter);
}

TEST(Increments, NamesWrittenOutAreTheSameTo32Bits) {
    for (auto const& [name, written] : {std::pair{"uniform", "0.1"},
                                        {"decreasing", "x<300 ? 3-0.01*x : 0"},
                                        {"rise_fall", "x<=150 ? 0.03*x : 6-0.01*x"}}) {
        auto named = increments(1000, {name, true});
        std::transform(named.begin(), named.end(), named.begin(),
                       [](double v) { return std::floor(v * 0x1p32 + 0.5) * 0x1p-32; });
        EXPECT_EQ(named, increments(1000, {written, true})) << name;
    }
}

TEST(Increments, ExpressionsAreRoundedTo32Bits) {
    for (double const v : increments(200, {"1+sin(x)/3"})) {
        EXPECT_EQ(v * 0x1p32, std::floor(v * 0x1p32));
    }
    double const large = increments(1, {"1e6*sqrt(2)"})[0];
    EXPECT_NEAR(large, 1414213.5623730951, 0x1p-16);
    EXPECT_EQ(large * 0x1p15, std::floor(large * 0x1p15));
}

TEST(Increments, DidYouMean) {
    EXPECT_TRUE(test::has(refusal("rise_fal"), "'rise_fal'"));
    EXPECT_TRUE(test::has(refusal("rise-fall"), "Did you mean 'rise_fall'?"));
    EXPECT_TRUE(test::has(refusal("Uniform"), "Did you mean 'uniform'?"));
    EXPECT_FALSE(test::has(refusal("3-0.01*y"), "Did you mean"));
}

TEST(Increments, WhatIsNoExpressionIsRefused) {
    for (std::string const& text : {std::string(), std::string("3-"), std::string("(x"), std::string("x)"),
                                    std::string("y"), std::string("x=5"), std::string("3*(x=5)"), std::string("x,2"),
                                    std::string("\"x\""), std::string("x<3 ? 1"), std::string(900, '(')}) {
        EXPECT_TRUE(test::has(refusal(text), "is not an increment"));
    }
    EXPECT_TRUE(test::has(refusal(std::string("x\0x", 3)), "character 2"));
    EXPECT_TRUE(test::has(refusal("\xff"), "character 1"));
    EXPECT_EQ(increments(4, {"(x==2)+(x>=3)+(x!=4)+(x<=1)"}), (std::vector<double>{2, 2, 2, 1}));
    EXPECT_TRUE(test::has(refusal(std::string(1001, '1')), "1001 characters"));
}

TEST(Increments, ANumberThatIsNotFiniteNamesItsX) {
    EXPECT_TRUE(test::has(refusal("1/(x-7)"), "not finite at x = 7"));
    EXPECT_TRUE(test::has(refusal("sqrt(3-x)"), "not finite at x = 4"));
    EXPECT_NO_THROW(increments(6, {"1/(x-7)"}));
}

TEST(Increments, AFunctionGivesTheBytesOfTheExpressionItComputes) {
    IncrementParams const written{"x<=100 ? 0.03*x : 6.3-0.01*x", true};
    IncrementParams given{.increment = "nonsense that is not read", .allow_negative = true};
    given.function = [](double x) { return x <= 100.0 ? 0.03 * x : 6.3 - 0.01 * x; };
    EXPECT_EQ(increments(700, given), increments(700, written));
    auto const jumps = increment_jumps(700, given);
    ASSERT_EQ(jumps.size(), 1U);
    EXPECT_EQ(jumps[0].x, increment_jumps(700, written)[0].x);
    given.allow_negative = false;
    EXPECT_EQ(increments(700, given)[650], 0.0);
}

TEST(Increments, AFunctionThatIsNotFiniteOrThrows) {
    IncrementParams given;
    given.function = [](double x) { return 1.0 / (x - 7.0); };
    EXPECT_NO_THROW(increments(6, given));
    EXPECT_TRUE(test::has(full_message_of<BadParameter>([&] { increments(10, given); }), "x = 7"));
    given.function = [](double) -> double { throw std::out_of_range("a table of its own"); };
    EXPECT_THROW(increments(10, given), std::out_of_range);
}

} // namespace

} // namespace increment_test
