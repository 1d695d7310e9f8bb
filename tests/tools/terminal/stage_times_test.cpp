// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "terminal/progress.hpp"

namespace stage_times_test {

using thalweg::tools::StageTimes;

namespace {

using Times = std::vector<std::pair<std::string, double>>;

TEST(StageTimes, NothingRan) {
    StageTimes times;
    EXPECT_EQ(times.until(3.0), Times{});
    times.at("grow", true, 4.0); // an end without a beginning took no time
    EXPECT_EQ(times.until(9.0), (Times{{"grow", 0.0}}));
}

TEST(StageTimes, OneAfterAnother) {
    StageTimes times;
    times.at("grow", false, 1.0);
    times.at("grow", false, 2.0);
    times.at("grow", true, 4.0);
    times.at("fill", false, 5.0); // nothing ran from 4 to 5
    EXPECT_EQ(times.until(7.0), (Times{{"grow", 3.0}, {"fill", 2.0}}));
    times.at("grow", false, 8.0);
    EXPECT_EQ(times.until(9.0), (Times{{"grow", 4.0}, {"fill", 3.0}})); // within fill
}

TEST(StageTimes, AStageWithinAnotherTakesItsTimeFromIt) {
    StageTimes times;
    times.at("fill", false, 0.0);
    times.at("solve", false, 1.0);
    times.at("solve", true, 4.0);
    times.at("fill", true, 6.0);
    EXPECT_EQ(times.until(9.0), (Times{{"fill", 3.0}, {"solve", 3.0}}));
    times.at("fill", false, 10.0);
    times.at("solve", false, 11.0);
    times.at("fill", false, 13.0); // solve did not say that it ended
    times.at("fill", true, 14.0);
    EXPECT_EQ(times.until(20.0), (Times{{"fill", 5.0}, {"solve", 5.0}}));
}

// Whatever is reported, no second is counted twice.
RC_GTEST_PROP(StageTimes, CountsNoSecondTwice, (std::vector<std::pair<int, bool>> const& reports)) {
    StageTimes times;
    double now = 0.0;
    for (auto const& [stage, done] : reports) {
        times.at(std::to_string(stage % 3), done, now);
        now += 1.0;
    }
    double sum = 0.0;
    for (auto const& [stage, seconds] : times.until(now)) {
        RC_ASSERT(seconds >= 0.0);
        sum += seconds;
    }
    RC_ASSERT(sum <= now);
}

} // namespace

} // namespace stage_times_test
