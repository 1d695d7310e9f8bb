// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <regex>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include "command.hpp"

namespace spoken_test {

namespace {

using test::has;

std::string const small = "make -o out --set grid.width=64 --set grid.height=48 --set network.dla.particles=400 --set "
                          "network.prune=4 ";

} // namespace

TEST(Spoken, MakeEndsWithTheTotalTime) {
    Workplace const place;
    Outcome const o = expect_run(place, small, 0);
    EXPECT_TRUE(std::regex_search(o.err, std::regex("\ntotal +[0-9]+\\.[0-9] s\n$"))) << o.err;
    EXPECT_FALSE(has(o.err, "time by stage")) << o.err;
    // Stage names have a column of their own.
    EXPECT_TRUE(std::regex_search(o.err, std::regex("(^|\n)grow       400 particles"))) << o.err;
    EXPECT_TRUE(std::regex_search(o.err, std::regex("\nmeander    [0-9]+ vertices"))) << o.err;
}

TEST(Spoken, VerboseShowsEveryStageAndTheMemory) {
    Workplace const place;
    Outcome const o = expect_run(place, small + "-v", 0);
    std::size_t const table = o.err.find("time by stage\n");
    ASSERT_NE(table, std::string::npos) << o.err;
    for (char const* stage : {"\nthalweg ", "\ngrow ", "\ncertify ", "\nmemory ", "\ntotal "}) {
        EXPECT_TRUE(has("\n" + o.err, stage)) << stage << "\n" << o.err;
    }
    EXPECT_TRUE(has(o.err.substr(table), "\ncertify ")) << o.err;
    Outcome const check = expect_run(place, "check out -v", 0, "\ntotal ");
    EXPECT_EQ(thalweg_run("check out -v -q", place.path()).code, 2) << "-q and -v contradict each other";
}

TEST(Spoken, CheckEndsWithAVerdict) {
    Workplace const place;
    ASSERT_EQ(thalweg_run(small + "-q", place.path()).code, 0);
    Outcome const good = thalweg_run("check out --dem out/dem.tif", place.path());
    EXPECT_TRUE(std::regex_search(good.out, std::regex("\nout: ok, [0-9]+ checks\n$"))) << good.out;
    EXPECT_TRUE(good.err.empty()) << good.err;
    ASSERT_EQ(
        thalweg_run(small + "-q --overwrite --set surface.drain=none --set surface.method=dilate", place.path()).code,
        0);
    Outcome const bad = expect_run(place, "check out --dem out/dem.tif", 3);
    EXPECT_TRUE(std::regex_search(bad.out, std::regex("\nout: FAILED, [0-9]+ of [0-9]+ checks\n$"))) << bad.out;
    EXPECT_TRUE(has(bad.out, "FAILED (at most 0)", "FAILED (at least 0.9"));
}

TEST(Spoken, MessagesNameNoFunction) {
    Workplace const place;
    place.write("bad.csv", "x,y,z\n1,2,three\n");
    for (std::string const words :
         {"check none.gpkg", "stats none.tif", "tin bad.csv -o a.2dm", "make none.toml", "draw none -o out",
          "convert none.gpkg -o a.gpkg", "make --set surface.mask=none.tif", "make --set grid.cell=0", "replay none"}) {
        Outcome const o = expect_run(place, words, 2);
        EXPECT_TRUE(has(("\n" + o.err), "\nerror: "));
        EXPECT_FALSE(std::regex_search(
            o.err, std::regex("\\b(core|geometry|solver|network|skeleton|surface|detail|blend|measure|draw|io|pipeline)"
                              "\\.[a-z_]+: ")))
            << words << "\n"
            << o.err;
    }
}

TEST(Spoken, ADryRunWritesNothing) {
    Workplace const place;
    Outcome const o = expect_run(place, small + "--dry-run", 0);
    EXPECT_TRUE(has(o.out, "stages     grow, thin, trace, prune, meander, channels, fill, carve, ",
                    "grid       64 x 48 cells of 30 m, "));
    EXPECT_TRUE(has(o.out, "\nmemory     at most ") && has(o.out, "\ntime       about 1 s on one core\n")) << o.out;
    EXPECT_FALSE(std::filesystem::exists(place / "out"));
    EXPECT_TRUE(o.err.empty()) << o.err;
    nlohmann::json const json = nlohmann::json::parse(thalweg_run(small + "--dry-run --json", place.path()).out);
    EXPECT_EQ(json["grid"]["width"], 64);
    EXPECT_EQ(json["stages"][0], "grow");
    EXPECT_EQ(json["cells"], 64 * 48);
    expect_run(place, small + "--dry-run --set network.source=lines", 2);
    EXPECT_TRUE(std::filesystem::is_empty(place.path()));
}

} // namespace spoken_test
