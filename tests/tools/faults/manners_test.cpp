// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include "command.hpp"

namespace manners_test {

namespace fs = std::filesystem;

namespace {

std::size_t entries(fs::path const& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

} // namespace

TEST(Manners, HelpAndVersionGoToStdout) {
    Workplace const place;
    Outcome const help = expect_run(place, "--help", 0);
    EXPECT_TRUE(test::has(help.out, "make"));
    Outcome const version = expect_run(place, "--version", 0);
    EXPECT_EQ(version.out.rfind("thalweg 0.", 0), 0U) << version.out;
    Outcome const of_make = expect_run(place, "make --help", 0);
    EXPECT_TRUE(test::has(of_make.out, "Examples:\n  thalweg make"));
    EXPECT_EQ(thalweg_run("help make", place.path()).out, of_make.out);
    EXPECT_EQ(thalweg_run("help", place.path()).out, help.out);
    EXPECT_EQ(thalweg_run("help make", place.path()).err, "");
}

TEST(Manners, WithoutAWordHelpGoesToStderr) {
    Workplace const place;
    Outcome const o = expect_run(place, "", 2);
    EXPECT_EQ(o.out, "");
    EXPECT_EQ(o.err, thalweg_run("--help", place.path()).out);
}

TEST(Manners, RecipeListsKeysAndItsDumpCanBeMade) {
    Workplace const place;
    Outcome const keys = expect_run(place, "recipe", 0);
    EXPECT_TRUE(test::has(keys.out, "sticking"));
    Outcome const dump = thalweg_run("recipe --dump", place.path());
    place.write("r.toml", dump.out);
    Outcome const made = expect_run(place, "make r.toml --set grid.width=256 --set grid.height=256 -o out -q", 0);
    EXPECT_EQ(made.err, "");
}

TEST(Manners, NumbersAreWrittenAsTheyWereGiven) {
    Workplace const place;
    std::regex const drawn_out("[0-9]*\\.[0-9]{12,}");
    EXPECT_FALSE(std::regex_search(thalweg_run("recipe --dump", place.path()).out, drawn_out));
    expect_run(place,
               small + "out --set network.slope=0.087 --set grid.cell=0.1 --set "
                       "network.heights=straight_repaired --set surface.method=dilate",
               0);
    std::string const recipe = file_bytes(place / "out/recipe.toml");
    EXPECT_TRUE(test::has(recipe, "\nslope = 0.087\n", "\ncell = 0.1\n"));
}

TEST(Manners, NoEscapeCodesInAPipe) {
    Workplace const place;
    Outcome const o = expect_run(place, small.substr(0, small.size() - 6) + "-o out", 0); // without -q
    EXPECT_FALSE(test::has(o.out + o.err, "\033"));
    EXPECT_EQ(o.out, "out\n");
}

TEST(Manners, JsonIsExactlyOneObject) {
    Workplace const place;
    auto const report = expect_run(place, small + "out --json", 0).json();
    EXPECT_EQ(report["recipe"]["grid"]["width"], 64);
    EXPECT_GT(report["network"]["arcs"], 0);
    EXPECT_TRUE(report["dem"]["max"].contains("col"));
    for (auto const& name : report["files"]) {
        EXPECT_TRUE(fs::exists(place / "out" / name.get<std::string>())) << name;
    }
    auto const check = thalweg_run("check out --json", place.path()).json();
    EXPECT_EQ(check["ok"], true);
    auto const stats = thalweg_run("stats out/dem.tif --json", place.path()).json();
    for (auto const& [key, value] : stats.items()) {
        EXPECT_EQ(value, key == "findings" ? nlohmann::json::array() : report["dem"][key]) << key;
    }
    EXPECT_GT(stats["lx_cells"], 0.0);
    EXPECT_GT(stats["dimension"], 2.0);
}

TEST(Manners, ProgressForOtherPrograms) {
    Workplace const place;
    Outcome const o = expect_run(place, small + "out --progress", 0); // with -q
    std::set<std::string> ended;
    std::vector<std::string> planned;
    std::istringstream lines(o.err);
    for (std::string line; std::getline(lines, line);) {
        auto const said = nlohmann::json::parse(line); // nothing else is there
        if (said.contains("stages")) {                 // once
            EXPECT_TRUE(planned.empty() && said.size() == 1) << line;
            for (auto const& one : said["stages"]) {
                planned.push_back(one["stage"]);
                EXPECT_GT(one["seconds"], 0.0) << line;
            }
            continue;
        }
        EXPECT_EQ(said.size(), 2U) << line;
        EXPECT_GE(said["share"], 0.0);
        EXPECT_LE(said["share"], 1.0);
        if (said["share"] == 1.0) {
            ended.insert(said["stage"]);
        }
    }
    for (char const* stage : {"grow", "thin", "meander", "write"}) {
        EXPECT_TRUE(ended.contains(stage)) << stage;
        EXPECT_EQ(std::ranges::count(planned, std::string(stage)), 1) << stage;
    }
    EXPECT_EQ(planned.back(), "write");
    Outcome const mixed = expect_run(place, "check out --progress", 0);
    EXPECT_TRUE(test::has(mixed.err, "{\"stage\": \"", "\n"));
}

TEST(Manners, ADryRunWritesNothing) {
    Workplace const place;
    Outcome const o = expect_run(place, small + "out --dry-run", 0);
    EXPECT_TRUE(test::has(o.out, "grow, thin, trace, prune, meander, channels, fill, carve, "));
    EXPECT_TRUE(o.err.empty()) << o.err;
    auto const json = expect_run(place, small + "out --dry-run --json", 0).json();
    EXPECT_EQ(json["grid"]["width"], 64);
    EXPECT_EQ(json["stages"][0], "grow");
    EXPECT_EQ(json["cells"], 64 * 48);
    expect_refused(place, small + "out --dry-run", {"--set network.source=lines", "-v"}); // -q and -v
    EXPECT_TRUE(fs::is_empty(place.path()));
}

TEST(Manners, VerboseShowsEveryStageAndTheMemory) {
    Workplace const place;
    std::string const verbose = small.substr(0, small.size() - 6) + "-v -o out"; // without -q
    Outcome const o = expect_run(place, verbose, 0);
    for (char const* stage : {"\nthalweg ", "\ngrow ", "\ncertify ", "\nmemory ", "\ntotal "}) {
        EXPECT_TRUE(test::has("\n" + o.err, stage));
    }
}

TEST(Manners, OverwriteReplacesOnlyItsOwn) {
    Workplace const place;
    expect_run(place, small + "out", 0);
    std::string const before = file_bytes(place / "out/dem.tif");
    place.write("out/mine.txt", "mine");
    expect_run(place, small + "out", 2);
    EXPECT_EQ(file_bytes(place / "out/dem.tif"), before);
    expect_run(place, small + "out --seed 8 --overwrite", 0);
    EXPECT_NE(file_bytes(place / "out/dem.tif"), before);
    EXPECT_EQ(file_bytes(place / "out/mine.txt"), "mine");
    EXPECT_EQ(entries(place.path()), 1U) << "nothing temporary stays";
}

TEST(Manners, StraightHeightsThatRiseFailTheCheckAndLeaveTheFiles) {
    Workplace const place;
    expect_run(place,
               "make --set grid.width=256 --set grid.height=256 --set network.dla.particles=6000 --set "
               "network.prune=3 --set network.heights=straight --set surface.method=dilate -o out",
               3, "uphill_arcs");
    EXPECT_TRUE(fs::exists(place / "out/dem.tif"));
    Outcome const check = expect_run(place, "check out", 3);
    EXPECT_TRUE(test::has(check.out, "FAILED"));
    EXPECT_TRUE(test::has(expect_run(place, "check out --json", 3).out, "\"ok\":false"));
}

TEST(Manners, ATamperedFileIsFoundByReplay) {
    Workplace const place;
    expect_run(place, small + "out", 0);
    expect_run(place, "replay out --verify", 0);
    std::string bytes = file_bytes(place / "out/network.tif");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    place.write("out/network.tif", bytes);
    fs::remove(place / "out/map.png");
    Outcome const o = expect_run(place, "replay out --verify", 3);
    EXPECT_TRUE(test::has(o.out, "DIFFERS  network.tif", "MISSING  map.png"));
}

TEST(Manners, TheOpenClDeviceIsNamed) {
    Workplace const place;
    Outcome const there = expect_run(place, small.substr(0, small.size() - 6) + "-o out --device opencl", 0);
    EXPECT_TRUE(test::has(("\n" + there.err), "\ndevice "));
    EXPECT_EQ(thalweg_run("replay out --verify", place.path()).code, 0) << "a device is no part of a recipe";
}

} // namespace manners_test
