// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

/// What a run of the command line gave.
struct Outcome {
    int code = -1;
    std::string out;
    std::string err;
};

/// Runs thalweg with arguments (shell syntax), in a folder.
Outcome thalweg_run(std::string const& arguments, std::filesystem::path const& folder);

/// A new empty folder, removed with its content at the end.
class Workplace {
public:
    Workplace();
    ~Workplace();
    Workplace(Workplace const&) = delete;
    Workplace& operator=(Workplace const&) = delete;
    std::filesystem::path const& path() const { return path_; }
    std::filesystem::path operator/(std::string const& name) const { return path_ / name; }
    void write(std::string const& name, std::string const& text) const;

private:
    std::filesystem::path path_;
};

std::string file_bytes(std::filesystem::path const& path);

/// Runs thalweg in the place: it ends with the code, and its messages have all of the words.
inline Outcome expect_run(Workplace const& place, std::string const& arguments, int code, auto const&... words) {
    Outcome run = thalweg_run(arguments, place.path());
    EXPECT_EQ(run.code, code) << arguments << "\n" << run.err;
    if constexpr (sizeof...(words) > 0) {
        EXPECT_TRUE(test::has(run.err, words...)) << arguments;
    }
    return run;
}
