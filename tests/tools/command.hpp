// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

/// What a run of the command line gave.
struct Outcome {
    int code = -1;
    std::string out;
    std::string err;

    nlohmann::json json() const { return nlohmann::json::parse(out); }
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
    /// Runs another program, which must succeed.
    void shell(std::string const& command) const;

private:
    std::filesystem::path path_;
};

std::string file_bytes(std::filesystem::path const& path);

/// A folder of the sources with samples.
inline std::string const samples = THALWEG_SOURCE_DIR "/samples/";

/// A make of a second; the name of its folder follows.
inline std::string const small = "make --set grid.width=64 --set grid.height=48 --set network.dla.particles=400 "
                                 "--set network.prune=4 -q -o ";

/// Runs thalweg in the place: it ends with the code, and its messages have all of the words.
inline Outcome expect_run(Workplace const& place, std::string const& arguments, int code, auto const&... words) {
    Outcome run = thalweg_run(arguments, place.path());
    EXPECT_EQ(run.code, code) << arguments << "\n" << run.err;
    if constexpr (sizeof...(words) > 0) {
        EXPECT_TRUE(test::has(run.err, words...)) << arguments;
    }
    return run;
}

/// Everything below a folder, with the bytes of the files.
std::map<std::string, std::string> content(std::filesystem::path const& folder);

/// Each command line ends with exit 2 and an error, prints no result and writes nothing.
void expect_refused(Workplace const& place, std::string const& command, std::vector<std::string> const& arguments);

/// The report.json of a folder.
nlohmann::json report_of(std::filesystem::path const& folder);

/// Every check of a report holds.
void expect_checks_hold(nlohmann::json const& report, std::string const& words = "");
