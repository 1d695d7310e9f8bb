// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/run.hpp>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace parallel_test {

using thalweg::parallel_ranges;

TEST(ParallelRanges, nothing_to_do_calls_nothing) {
    for (std::int64_t const count : {0, -1}) {
        parallel_ranges({}, count, 1, [](std::int64_t, std::int64_t) { FAIL(); });
    }
}

// Law: the ranges tile [0, count), each index once.
TEST(ParallelRanges, ranges_tile_the_whole) {
    ASSERT_TRUE(rc::check([] {
        auto const count = *rc::gen::inRange<std::int64_t>(0, 5000);
        auto const grain = *rc::gen::inRange<std::int64_t>(0, 700);
        thalweg::Run const run = test::on_threads(*rc::gen::inRange(0, 4));
        std::vector<std::atomic<int>> seen(static_cast<std::size_t>(count));
        parallel_ranges(run, count, grain, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
                ++seen[static_cast<std::size_t>(i)];
            }
        });
        RC_ASSERT(std::ranges::all_of(seen, [](auto const& times) { return times == 1; }));
    }));
}

TEST(ParallelRanges, hands_on_what_the_body_throws) {
    for (int const threads : {1, 2}) {
        thalweg::Run const run = test::on_threads(threads);
        EXPECT_THROW(parallel_ranges(run, 1000, 10,
                                     [](std::int64_t begin, std::int64_t end) {
                                         if (begin <= 500 && 500 < end) {
                                             throw std::out_of_range("500");
                                         }
                                     }),
                     std::out_of_range);
    }
}

TEST(ParallelRanges, stops_when_asked) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    EXPECT_THROW(parallel_ranges(run, 10, 1, [](std::int64_t, std::int64_t) { FAIL(); }), thalweg::Cancelled);
}

} // namespace parallel_test
