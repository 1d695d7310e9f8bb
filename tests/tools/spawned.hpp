// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <sys/types.h>
#include <vector>

#include <gtest/gtest.h>

#include "command.hpp"

/// How a process that a test started came to its end.
struct Ended {
    int code = -1;     ///< its exit status, or minus the number of the signal it died of
    bool hung = false; ///< it was killed after the time it was given
    std::string out;
    std::string err;
};

/// A run of thalweg between fork and exec and its end. prepare: what the child does before it becomes thalweg (limits,
/// streams); standard output and error otherwise go to files.
class Spawned {
public:
    Spawned(std::vector<std::string> words, std::filesystem::path const& folder, std::function<void()> const& prepare,
            std::string const& program = THALWEG_EXE);
    ~Spawned();
    Spawned(Spawned const&) = delete;
    Spawned& operator=(Spawned const&) = delete;

    pid_t pid() const { return pid_; }
    /// Waits for the end, and kills it after that many seconds.
    Ended wait(double most_s = std::numeric_limits<double>::infinity());

private:
    pid_t pid_ = -1;
    std::filesystem::path aside_;
};

inline Ended spawn(
    std::vector<std::string> const& words, std::filesystem::path const& folder,
    std::function<void()> const& prepare = [] {}, std::string const& program = THALWEG_EXE) {
    return Spawned(words, folder, prepare, program).wait();
}

/// A make of a second, as words.
std::vector<std::string> small_make(std::string const& folder = "out");

/// Tests that share a folder in which "base" is what small_make wrote.
class MadeOnce : public testing::Test {
protected:
    static void SetUpTestSuite();
    static void TearDownTestSuite();
    static Workplace& place() { return *place_; }

private:
    static Workplace* place_;
};

/// Names in a folder, sorted.
std::vector<std::string> names_in(std::filesystem::path const& folder);

/// What differs between two folders that make wrote, report.* apart: "" for nothing.
std::string difference(std::filesystem::path const& folder, std::filesystem::path const& reference);
