// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/parameters.hpp>

#include <string>
#include <type_traits>

#include <gtest/gtest.h>

namespace required_test {

using namespace thalweg;

namespace {

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

} // namespace required_test
