// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <signal.h>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "command.hpp"
#include "long_make.hpp"
#include "spawned.hpp"

namespace signals_test {

namespace fs = std::filesystem;

namespace {

std::string host() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    return name.data();
}

/// The number of a process that cannot be: beyond the kernel's largest limit of 2^22.
constexpr pid_t dead_process = (1 << 22) + 1;

} // namespace

TEST(Signals, AnInterruptLeavesNothing) {
    Workplace const place;
    Spawned run(long_make(), place.path(), [] {});
    while (!is_ready_for(run.pid(), SIGINT)) {
        std::this_thread::yield();
    }
    kill(run.pid(), SIGINT);
    Ended const ended = run.wait();
    EXPECT_EQ(ended.code, 130) << ended.err;
    EXPECT_TRUE(names_in(place.path()).empty());
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
    std::string const dead = "thalweg-tmp-" + host() + "-" + std::to_string(dead_process);
    std::string const living = "thalweg-tmp-" + host() + "-" + std::to_string(getpid());
    std::string const elsewhere = "thalweg-tmp-elsewhere-" + std::to_string(dead_process);
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

} // namespace signals_test
