// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <grp.h>
#include <string>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"
#include "spawned.hpp"

namespace fs = std::filesystem;

namespace {

bool has_sanitizer() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return true;
#else
    return false;
#endif
}

void limit(__rlimit_resource resource, rlim_t most) {
    rlimit const both{most, most};
    setrlimit(resource, &both);
}

/// What a shortage may lead to: the whole result, or exit 1 in words; and nothing beside it.
void expect_whole_or_refused(Ended const& ended, fs::path const& folder, fs::path const& reference,
                             std::string const& about) {
    EXPECT_FALSE(ended.hung) << about;
    if (ended.code == 0) {
        EXPECT_EQ(difference(folder / "out", reference), "") << about;
    } else {
        EXPECT_EQ(ended.code, 1) << about << ended.err;
        EXPECT_TRUE(test::has(ended.err, "error: ")) << about;
        EXPECT_FALSE(fs::exists(folder / "out")) << about;
    }
}

/// Threads and processes of the user that runs the tests.
rlim_t tasks_of_user() {
    rlim_t count = 0;
    for (auto const& process : fs::directory_iterator("/proc")) {
        struct stat about {};
        std::error_code ignored;
        if (stat(process.path().c_str(), &about) == 0 && about.st_uid == getuid()) {
            fs::directory_iterator task(process.path() / "task", ignored);
            for (; !ignored && task != fs::directory_iterator(); task.increment(ignored)) {
                ++count;
            }
        }
    }
    return count;
}

/// A limit on processes does not bind root: as root the program runs, copied to where everyone may read, as a user that
/// nobody is.
struct LimitedUser {
    bool is_other = geteuid() == 0;
    std::string program = THALWEG_EXE;
    Workplace copy;

    LimitedUser() {
        if (!is_other) {
            return;
        }
        fs::path const bin = fs::path(THALWEG_EXE).parent_path();
        for (char const* const name : {"bin/thalweg", "libexec/thalweg/thalweg"}) {
            fs::path const from = bin.parent_path() / name;
            if (fs::exists(from)) {
                fs::create_directories((copy / name).parent_path());
                fs::copy_file(from, copy / name);
            }
        }
        open_to_all(copy.path());
        program = copy / "bin/thalweg";
    }
    static void open_to_all(fs::path const& folder) { fs::permissions(folder, fs::perms(0777)); }
    void become_with(rlim_t processes) const {
        constexpr uid_t nobodys = 61187;
        rlim_t const others = is_other ? 0 : tasks_of_user();
        bool const changed = !is_other || (setgroups(0, nullptr) == 0 && setgid(nobodys) == 0 && setuid(nobodys) == 0);
        if (!changed) {
            _exit(98);
        }
        limit(RLIMIT_NPROC, others + processes);
    }
};

class Limits : public MadeOnce {};

/// The least address space [MB] in which the program is loaded at all; below it speaks the linker.
rlim_t least_megabytes(fs::path const& folder) {
    rlim_t low = 8;
    rlim_t high = 4096;
    while (high - low > 1) {
        rlim_t const middle = (low + high) / 2;
        Ended const ended = spawn({"--version"}, folder, [middle] { limit(RLIMIT_AS, middle << 20U); });
        (ended.code == 0 ? high : low) = middle;
    }
    return high;
}

void walk_memory(fs::path const& base, rlim_t step_kb, int steps) {
    if (has_sanitizer()) {
        GTEST_SKIP() << "a sanitizer takes address space without bound";
    }
    Workplace const place;
    rlim_t const least = least_megabytes(place.path()) << 10U;
    int refused = 0;
    for (int i = 0; i < steps; ++i) {
        rlim_t const most = least + static_cast<rlim_t>(i) * step_kb;
        Ended const ended = spawn(small_make(), place.path(), [most] { limit(RLIMIT_AS, most << 10U); });
        expect_whole_or_refused(ended, place.path(), base, std::to_string(most) + " KB: ");
        refused += ended.code == 0 ? 0 : 1;
        fs::remove_all(place / "out");
    }
    EXPECT_GT(refused, 0) << "no step was short of memory";
    EXPECT_EQ(spawn(small_make(), place.path()).code, 0);
    EXPECT_EQ(names_in(place.path()), std::vector<std::string>{"out"}) << "what was left is swept";
}

/// Refuses every allocation from one of the run's on, in places spread evenly from this share of them.
void exhaust_memory(fs::path const& base, int trials, double share = 0.0) {
    if (has_sanitizer()) {
        GTEST_SKIP() << "a sanitizer has allocations of its own";
    }
    Workplace const place;
    setenv("SPY_COUNT", (place / "count").c_str(), 1);
    auto const preload = [] { setenv("LD_PRELOAD", SPY, 1); };
    ASSERT_EQ(spawn(small_make(), place.path(), preload).code, 0);
    unsetenv("SPY_COUNT");
    long const all = std::atol(file_bytes(place / "count").c_str());
    ASSERT_GT(all, 10000);
    fs::remove(place / "count");
    fs::remove_all(place / "out");
    long const first = std::lround(share * static_cast<double>(all));
    for (int i = 0; i < trials; ++i) {
        std::string const from = std::to_string(first + (all - first) * i / trials + i);
        Ended const ended = spawn(small_make(), place.path(), [&] {
            setenv("SPY_MEMORY", from.c_str(), 1);
            setenv("LD_PRELOAD", SPY, 1);
        });
        expect_whole_or_refused(ended, place.path(), base, "from allocation " + from + " on: ");
        fs::remove_all(place / "out");
    }
}

} // namespace

TEST_F(Limits, OneToEightProcesses) {
    LimitedUser const user;
    for (rlim_t processes = 1; processes <= 8; ++processes) {
        Workplace const place;
        LimitedUser::open_to_all(place.path());
        Ended const ended = Spawned(
                                small_make(), place.path(), [&] { user.become_with(processes); }, user.program)
                                .wait(60.0);
        EXPECT_EQ(ended.code, 0) << processes << ended.err;
        expect_whole_or_refused(ended, place.path(), MadeOnce::place() / "base",
                                std::to_string(processes) + " processes: ");
    }
}

TEST_F(Limits, AddressSpaceInTwentySteps) {
    walk_memory(place() / "base", 2500, 20);
}

TEST_F(Limits, MemoryExhaustedForGood) {
    exhaust_memory(place() / "base", 12);
}

TEST_F(Limits, AddressSpaceInHundredSteps) {
    walk_memory(place() / "base", 500, 100);
}

TEST_F(Limits, MemoryExhaustedForGoodInManyPlaces) {
    exhaust_memory(place() / "base", 115);
}

TEST_F(Limits, MemoryExhaustedWhilePicturesAreDrawn) {
    exhaust_memory(place() / "base", 150, 0.8);
}
