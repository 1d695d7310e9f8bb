// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <functional>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"
#include "spawned.hpp"

namespace streams_test {

namespace {

using Words = std::vector<std::string>;

void fill(int stream) {
    int const full = open("/dev/full", O_WRONLY);
    dup2(full, stream);
    close(full);
}

/// Every command once, on a folder "base" that make wrote. Outputs are replaced.
std::vector<Words> every_command() {
    Words make = small_make("made");
    make.emplace_back("--overwrite");
    Words report = make;
    report.emplace_back("--json");
    return {make,
            report,
            {"make", "nothing.toml"},
            {"check", "base"},
            {"check", "base", "--json"},
            {"convert", "base", "-o", "c.gpkg", "--overwrite"},
            {"stats", "base/dem.tif"},
            {"stats", "base/dem.tif", "--json"},
            {"measure", "base/dem.tif", "-o", "measured", "--overwrite"},
            {"draw", "base", "-o", "drawn", "--what", "profile", "--overwrite"},
            {"export", "base", "-o", "e.png", "--overwrite"},
            {"tin", "base/dem.tif", "-o", "t.ply", "--overwrite"},
            {"points", "base/dem.tif", "-o", "p.las", "--overwrite"},
            {"blend", "base/dem.tif", "base/dem.tif", "-o", "b.tif", "--window", "20,20,20,20", "--overwrite"},
            {"grow"},
            {"replay", "base", "--verify"},
            {"recipe"},
            {"recipe", "--json"},
            {"help"},
            {"help", "make"},
            {"--help"},
            {"--version"},
            {"completion", "bash"},
            {"man"},
            {"nonsense"},
            {}};
}

std::string joined(Words const& words) {
    std::string text;
    for (std::string const& word : words) {
        text += word + " ";
    }
    return text;
}

class Streams : public MadeOnce {};

} // namespace

TEST_F(Streams, ResultsThatDoNotArriveAreAFailure) {
    for (Words const& words : every_command()) {
        Ended const usual = spawn(words, place().path());
        for (auto const& [how, prepare] :
             {std::pair<char const*, std::function<void()>>{"full", [] { fill(1); }}, {"closed", [] { close(1); }}}) {
            Ended const ended = spawn(words, place().path(), prepare);
            EXPECT_EQ(ended.code, usual.out.empty() ? usual.code : 1) << joined(words) << how << ended.err;
            if (!usual.out.empty()) {
                EXPECT_TRUE(test::has(ended.err, "error: cannot write to ")) << joined(words);
            }
        }
    }
}

TEST_F(Streams, MessagesThatDoNotArriveChangeNothing) {
    for (Words const& words : every_command()) {
        Ended const usual = spawn(words, place().path());
        for (auto const& [how, prepare] :
             {std::pair<char const*, std::function<void()>>{"full", [] { fill(2); }}, {"closed", [] { close(2); }}}) {
            Ended const ended = spawn(words, place().path(), prepare);
            EXPECT_EQ(ended.code, usual.code) << joined(words) << how;
            EXPECT_EQ(ended.out.size() > 0, usual.out.size() > 0) << joined(words) << how;
        }
    }
}

TEST_F(Streams, NoFileTakesTheNumberOfAClosedStream) {
    Workplace const here;
    Ended const ended = spawn(small_make(), here.path(), [] {
        close(0);
        close(1);
        close(2);
    });
    EXPECT_EQ(ended.code, 1) << "the name of the folder cannot be printed";
    EXPECT_EQ(difference(here / "out", place() / "base"), "");
}

TEST_F(Streams, AReaderThatLeavesLeavesNothingHalfDone) {
    Workplace const here;
    Ended const ended = spawn(small_make(), here.path(), [] {
        int ends[2];
        if (pipe(ends) == 0) {
            dup2(ends[1], 1);
            dup2(ends[1], 2);
            close(ends[0]);
            close(ends[1]);
        }
    });
    EXPECT_EQ(ended.code, 1);
    EXPECT_EQ(difference(here / "out", place() / "base"), "");
}

} // namespace streams_test
