// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>
#include <signal.h>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "command.hpp"
#include "long_make.hpp"
#include "spawned.hpp"

namespace fs = std::filesystem;

namespace {

void wait_until_ready(pid_t pid, int number) {
    for (int i = 0; i < 20000 && !is_ready_for(pid, number); ++i) {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
}

} // namespace

// The libraries take the linker 15 to 80 ms: whoever interrupts then must find a process that is ready.
TEST(Signals, AreHeldBeforeLibrariesAreLoaded) {
    for (int const number : {SIGINT, SIGTERM, SIGHUP}) {
        Workplace const place;
        Spawned run(long_make(), place.path(), [] {});
        while (of_process(run.pid(), "comm") != "thalweg\n") { // still a copy of this test
        }
        bool is_loaded = false;
        for (int i = 0; i < 20000 && !is_loaded; ++i) {
            is_loaded = of_process(run.pid(), "maps").find("libgdal") != std::string::npos;
        }
        ASSERT_TRUE(is_loaded);
        EXPECT_TRUE(is_ready_for(run.pid(), number)) << number;
    }
}

TEST(Signals, AHundredEarlyInterruptsEndInOrder) {
    Workplace const place;
    for (int i = 0; i < 100; ++i) {
        Spawned run(long_make(), place.path(), [] {});
        wait_until_ready(run.pid(), SIGINT);
        std::this_thread::sleep_for(std::chrono::microseconds(900 * i));
        kill(run.pid(), SIGINT);
        Ended const ended = run.wait(30.0);
        ASSERT_EQ(ended.code, 130) << i << " " << ended.err;
        ASSERT_TRUE(names_in(place.path()).empty()) << i;
    }
}

TEST(Signals, EachHasItsExitStatus) {
    for (auto const& [number, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}, {SIGHUP, 129}}) {
        Workplace const place;
        Spawned run(long_make(), place.path(), [] {});
        wait_until_ready(run.pid(), number);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        kill(run.pid(), number);
        EXPECT_EQ(run.wait(30.0).code, code);
        EXPECT_TRUE(names_in(place.path()).empty());
    }
}

TEST(Signals, AnIgnoredHangUpStaysIgnored) {
    Workplace const place;
    Spawned run(small_make(), place.path(), [] { signal(SIGHUP, SIG_IGN); });
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    kill(run.pid(), SIGHUP);
    EXPECT_EQ(run.wait().code, 0) << "nohup thalweg make";
}
