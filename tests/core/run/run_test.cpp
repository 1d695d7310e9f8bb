// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/run/run.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/beside.hpp>
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

namespace beside_test {

using thalweg::Beside;

TEST(Beside, runs_every_job_once) {
    for (int const threads : {1, 2, 4}) {
        thalweg::Run const run = test::on_threads(threads);
        std::vector<std::atomic<int>> seen(20);
        Beside jobs(run, "write");
        for (std::size_t i = 0; i < seen.size(); ++i) {
            jobs.add([&seen, i](thalweg::Run const& of_job) {
                EXPECT_EQ(of_job.threads, 1);
                ++seen[i];
            });
        }
        jobs.wait();
        EXPECT_TRUE(std::ranges::all_of(seen, [](auto const& times) { return times == 1; }));
        jobs.wait();
    }
}

// Whatever the number of threads, the error is that of the job which fails when they run one after another.
TEST(Beside, throws_what_the_first_job_that_fails_has_thrown) {
    for (int const threads : {1, 2, 4}) {
        thalweg::Run const run = test::on_threads(threads);
        auto const all = [&] {
            Beside jobs(run, "write");
            for (int i = 0; i < 8; ++i) {
                jobs.add([i](thalweg::Run const&) {
                    if (i == 2 || i == 3) {
                        std::this_thread::sleep_for(std::chrono::milliseconds(i == 2 ? 20 : 0));
                        throw thalweg::IoError("test.job", "job " + std::to_string(i));
                    }
                });
            }
            jobs.wait();
        };
        EXPECT_EQ(test::message_of(all), "job 2") << threads;
    }
}

TEST(Beside, stops_with_the_run_and_when_it_ends) {
    for (int const threads : {1, 2}) {
        std::stop_source source;
        thalweg::Run run = test::on_threads(threads);
        run.stop = source.get_token();
        auto const all = [&] {
            Beside jobs(run, "write");
            jobs.add([&source](thalweg::Run const& of_job) {
                source.request_stop();
                of_job.check();
            });
            jobs.wait();
        };
        EXPECT_THROW(all(), thalweg::Cancelled);
    }
    std::atomic<bool> is_stopped = false;
    thalweg::Run const run = test::on_threads(2);
    {
        Beside jobs(run, "write");
        std::atomic<bool> is_running = false;
        jobs.add([&](thalweg::Run const& of_job) {
            is_running = true;
            while (!of_job.stop.stop_requested()) {
                std::this_thread::yield();
            }
            is_stopped = true;
        });
        while (!is_running) {
            std::this_thread::yield();
        }
    }
    EXPECT_TRUE(is_stopped);
}

TEST(CpuSeconds, counts_the_workers_of_parallel_ranges) {
    thalweg::Run const run = test::on_threads(4);
    double const begin_s = thalweg::cpu_seconds();
    thalweg::parallel_ranges(run, 4, 1, [](std::int64_t, std::int64_t) {
        double const before_s = thalweg::cpu_seconds();
        while (thalweg::cpu_seconds() - before_s < 0.01) {
        }
    });
    EXPECT_GE(thalweg::cpu_seconds() - begin_s, 0.01);
    EXPECT_LT(thalweg::cpu_seconds() - begin_s, 1.0);
}

} // namespace beside_test
