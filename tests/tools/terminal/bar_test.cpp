// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include "terminal/progress.hpp"
#include "terminal/terminal.hpp"

namespace bar_test {

using namespace thalweg::tools;

namespace {

BarState half() {
    BarState state;
    state.what = "grow";
    state.share = 0.5;
    state.per_second = 0.025;
    state.left_s = 19.2;
    state.amount = 2e6;
    state.unit = "particles";
    return state;
}

} // namespace

TEST(Bar, NothingKnownYet) {
    EXPECT_EQ(bar_text({}, 80, Colour::none), "           [..............................]   0 %");
    EXPECT_EQ(bar_text({}, 0, Colour::none), " ");
    EXPECT_LE(bar_text(half(), -5, Colour::none).size(), 1U);
}

TEST(Bar, ShareRateAndTimeLeft) {
    EXPECT_EQ(bar_text(half(), 80, Colour::none),
              "grow       [##############...............]  50 %  50.0 k particles/s  20 s left");
    BarState state = half();
    state.amount = 0.0;
    EXPECT_EQ(bar_text(state, 80, Colour::none),
              "grow       [###############...............]  50 %  2.5 %/s  20 s left");
    state.left_s = 4000.0;
    EXPECT_TRUE(test::has(bar_text(state, 80, Colour::none), "  1 h 06 min left"));
    state.left_s = 65.0;
    EXPECT_TRUE(test::has(bar_text(state, 80, Colour::none), "  1 min 05 s left"));
}

TEST(Bar, NarrowTerminalsLoseTheRateThenTheBarThenTheTime) {
    EXPECT_EQ(bar_text(half(), 50, Colour::none), "grow       [#########..........]  50 %  20 s left");
    EXPECT_EQ(bar_text(half(), 30, Colour::none), "grow        50 %  20 s left");
    EXPECT_EQ(bar_text(half(), 20, Colour::none), "grow        50 %");
    EXPECT_EQ(bar_text(half(), 6, Colour::none), "grow ");
    // A name as long as its column still keeps a space before the bar.
    BarState longest = half();
    longest.what = "catchments";
    EXPECT_EQ(bar_text(longest, 80, Colour::none).rfind("catchments [", 0), 0U);
    longest.what = "catchments2";
    EXPECT_EQ(bar_text(longest, 80, Colour::none).rfind("catchments2 [", 0), 0U);
}

TEST(Bar, NeverAsWideAsTheTerminalAndPlainAscii) {
    EXPECT_TRUE(rc::check([] {
        BarState state = half();
        state.share = *rc::gen::inRange(-10, 1100) / 1000.0;
        state.per_second = *rc::gen::inRange(0, 1000000) / 1e5;
        state.left_s = *rc::gen::inRange(-1, 2000000);
        state.amount = *rc::gen::inRange(0, 2000000000);
        int const columns = *rc::gen::inRange(2, 200);
        std::string const text = bar_text(state, columns, Colour::none);
        RC_ASSERT(static_cast<int>(text.size()) < columns);
        for (char const c : text) {
            RC_ASSERT((c >= ' ' && c <= '~'));
        }
    }));
}

TEST(Bar, ColourAddsNothingButEscapes) {
    std::string text = bar_text(half(), 80, Colour::ansi);
    for (std::string const escape : {"\033[34m", "\033[0m"}) {
        auto const at = text.find(escape);
        ASSERT_NE(at, std::string::npos);
        text.erase(at, escape.size());
    }
    EXPECT_EQ(text, bar_text(half(), 80, Colour::none));
}

TEST(Pace, UnknownAtFirst) {
    Pace pace;
    EXPECT_LT(pace.left_s(), 0.0);
    pace.at(0.5, 0.0);
    pace.at(0.001, 0.3);
    EXPECT_LT(pace.left_s(), 0.0);
    pace.at(0.0, 5.0);
    EXPECT_LT(pace.left_s(), 0.0) << "nothing was done since";
}

TEST(Pace, SteadyWorkCountsDown) {
    Pace pace;
    for (int i = 1; i <= 190; ++i) { // 5 % a second
        double const elapsed = i * 0.1;
        pace.at(elapsed * 0.05, elapsed);
        if (i >= 6) {
            EXPECT_NEAR(pace.left_s(), 20.0 - elapsed, 1e-6);
            EXPECT_NEAR(pace.per_second(), 0.05, 1e-9);
        }
    }
}

TEST(Pace, JerksDoNotJump) {
    Pace pace;
    double before = -1.0;
    for (int i = 1; i <= 300; ++i) { // 2 % a second, in a step each second
        double const elapsed = i * 0.1;
        pace.at(std::floor(elapsed) * 0.02, elapsed);
        if (elapsed > 8.0) {
            if (before >= 0.0) {
                EXPECT_LT(std::abs(pace.left_s() - before), 2.0) << elapsed;
            }
            before = pace.left_s();
            EXPECT_NEAR(before, 50.0 - elapsed, 15.0) << elapsed;
        }
    }
}

TEST(Abilities, FollowTerminalTermAndNoColor) {
    EXPECT_FALSE(abilities(false, "xterm", nullptr).moves);
    EXPECT_FALSE(abilities(false, "xterm", nullptr).colours);
    EXPECT_TRUE(abilities(true, "xterm", nullptr).moves);
    EXPECT_TRUE(abilities(true, "xterm", nullptr).colours);
    EXPECT_TRUE(abilities(true, "xterm", "").colours) << "an empty NO_COLOR says nothing";
    EXPECT_TRUE(abilities(true, "xterm", "1").moves);
    EXPECT_FALSE(abilities(true, "xterm", "1").colours);
    for (char const* term : {"dumb", "", static_cast<char const*>(nullptr)}) {
        EXPECT_FALSE(abilities(true, term, nullptr).moves);
        EXPECT_FALSE(abilities(true, term, nullptr).colours);
    }
}

} // namespace bar_test
