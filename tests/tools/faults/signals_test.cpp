// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "spawned.hpp"

#include <gtest/gtest.h>

#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace fs = std::filesystem;

namespace {

/// Grows for many seconds.
std::vector<std::string> long_make() {
    return {"make",  "-o",
            "out",   "-q",
            "--set", "network.dla.particles=50000000",
            "--set", "grid.width=4000",
            "--set", "grid.height=4000"};
}

std::string of_process(pid_t pid, char const* file) {
    std::ifstream in("/proc/" + std::to_string(pid) + "/" + file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

/// Whether a process holds or handles a signal.
bool is_ready_for(pid_t pid, int number) {
    std::string const status = of_process(pid, "status");
    for (char const* const field : {"SigBlk:\t", "SigCgt:\t"}) {
        std::size_t const at = status.find(field);
        if (at != std::string::npos &&
            (std::stoull(status.substr(at + 8, 16), nullptr, 16) >> (number - 1) & 1U) != 0) {
            return true;
        }
    }
    return false;
}

void wait_until_ready(pid_t pid, int number) {
    for (int i = 0; i < 20000 && !is_ready_for(pid, number); ++i) {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
}

std::string host() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    return name.data();
}

/// The number of a process that is no more.
pid_t dead_process() {
    pid_t const child = fork();
    if (child == 0) {
        _exit(0);
    }
    waitpid(child, nullptr, 0);
    return child;
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

TEST(Signals, AFileTooLargeIsAnErrorOfWriting) {
    for (rlim_t const bytes : {rlim_t{0}, rlim_t{4096}, rlim_t{20000}, rlim_t{60000}}) {
        Workplace const place;
        Ended const ended = spawn(small_make(), place.path(), [bytes] {
            rlimit const limit{bytes, bytes};
            setrlimit(RLIMIT_FSIZE, &limit);
        });
        EXPECT_EQ(ended.code, 1) << bytes << ended.err;
        EXPECT_TRUE(names_in(place.path()).empty()) << bytes;
    }
}

TEST(Signals, WhatTheDeadLeftIsSwept) {
    Workplace const place;
    std::string const dead = "thalweg-tmp-" + host() + "-" + std::to_string(dead_process());
    std::string const living = "thalweg-tmp-" + host() + "-" + std::to_string(getpid());
    std::string const elsewhere = "thalweg-tmp-elsewhere-" + std::to_string(dead_process());
    for (std::string const& folder : {"out." + dead, "other." + dead + "-2", "out." + living, "out." + elsewhere,
                                      "moved." + dead, "moved." + dead + "-old"}) {
        fs::create_directory(place / folder);
        place.write(folder + "/dem.tif", "half");
    }
    place.write("." + dead + "-b.tif", "half");
    place.write("mine." + dead + "a", "no mark of thalweg");
    ASSERT_EQ(spawn(small_make(), place.path()).code, 0);
    EXPECT_EQ(names_in(place.path()),
              (std::vector<std::string>{"mine." + dead + "a", "moved." + dead, "moved." + dead + "-old", "out",
                                        "out." + elsewhere, "out." + living}));
}
