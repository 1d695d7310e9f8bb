// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/parameters.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace parameters_test {

using namespace thalweg;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Number> std::string refused(Number value, Range const& range, char const* unit = "") {
    return test::full_message_of<BadParameter>([&] { require_in("core.test", "size", value, range, unit); });
}

TEST(Range, NoRangeHasNaN) {
    for (Range const& range : {Range::finite(), Range::above(0), Range::at_least(0), Range::between(0, 1),
                               Range::inside(0, 1), Range::above(0).or_infinite()}) {
        EXPECT_FALSE(range.contains(std::nan("")));
    }
}

TEST(Range, InfinityOnlyWhereItIsAskedFor) {
    for (Range const& range :
         {Range::finite(), Range::above(0), Range::at_least(0), Range::between(0, 1), Range::inside(0, 1)}) {
        EXPECT_FALSE(range.contains(infinity));
        EXPECT_FALSE(range.contains(-infinity));
    }
    EXPECT_TRUE(Range::above(0).or_infinite().contains(infinity));
    EXPECT_FALSE(Range::above(0).or_infinite().contains(-infinity));
}

TEST(Range, BoundsBelongAsTheirNamesSay) {
    EXPECT_FALSE(Range::above(2).contains(2));
    EXPECT_TRUE(Range::above(2).contains(std::nextafter(2.0, 3.0)));
    EXPECT_TRUE(Range::at_least(2).contains(2));
    EXPECT_FALSE(Range::at_least(2).contains(std::nextafter(2.0, 1.0)));
    EXPECT_TRUE(Range::between(2, 3).contains(2) && Range::between(2, 3).contains(3));
    EXPECT_FALSE(Range::between(2, 3).contains(std::nextafter(3.0, 4.0)));
    EXPECT_FALSE(Range::inside(2, 3).contains(2) || Range::inside(2, 3).contains(3));
    EXPECT_TRUE(Range::finite().contains(-std::numeric_limits<double>::max()));
}

TEST(Range, MessagesSayValueUnitAndRange) {
    EXPECT_EQ(refused(0.0, Range::above(0), "m"), "core.test: size is 0 m; it must be greater than 0");
    EXPECT_EQ(refused(-0.5, Range::at_least(0)), "core.test: size is -0.5; it must be at least 0");
    EXPECT_EQ(refused(9001, Range::between(200, 8000), "pixels"),
              "core.test: size is 9001 pixels; it must be between 200 and 8000");
    EXPECT_EQ(refused(3.0, Range::inside(2, 3)), "core.test: size is 3; it must be greater than 2 and less than 3");
    EXPECT_EQ(refused(0.0, Range{0, 1000, false, true}),
              "core.test: size is 0; it must be greater than 0 and at most 1000");
    EXPECT_EQ(refused(std::nan(""), Range::finite()), "core.test: size is nan; it must be a finite number");
    EXPECT_EQ(refused(std::int64_t{9007199254740993}, Range::between(0, 1)),
              "core.test: size is 9007199254740993; it must be between 0 and 1");
    EXPECT_EQ(refused(0.5, Range::between(0, 1)), "");
}

struct Params {
    double share = 0.5;
    Required<double> cell_m;
};

template <class P>
concept WithoutCell = requires { P{.share = 0.1}; };

template <class P>
concept Empty = requires { P{}; };

template <class P>
concept Whole = requires { P{.share = 0.1, .cell_m = 30.0}; };

static_assert(!WithoutCell<Params> && !Empty<Params> && !std::is_default_constructible_v<Params>);

static_assert(Whole<Params> && std::is_aggregate_v<Params>);

} // namespace

TEST(Required, ReadsAsItsValue) {
    Params params{.cell_m = 30};
    EXPECT_EQ(params.cell_m * 2.0, 60.0);
    params.cell_m = 10.0;
    double const cell_m = params.cell_m;
    EXPECT_EQ(cell_m, 10.0);
    Required<std::string> const name = std::string("by hand");
    std::string const& held = name;
    EXPECT_EQ(held, "by hand");
}

} // namespace parameters_test
