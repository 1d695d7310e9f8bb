// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>
#include <regex>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include "command.hpp"

namespace manners_test {

namespace fs = std::filesystem;

namespace {

std::string const small = "make --set grid.width=64 --set grid.height=48 --set network.dla.particles=400 "
                          "--set network.prune=4 ";

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
               small + "-q -o out --set network.slope=0.087 --set grid.cell=0.1 --set "
                       "network.heights=straight_repaired --set surface.method=dilate",
               0);
    std::string const recipe = file_bytes(place / "out/recipe.toml");
    EXPECT_TRUE(test::has(recipe, "\nslope = 0.087\n", "\ncell = 0.1\n"));
}

TEST(Manners, NoEscapeCodesInAPipe) {
    Workplace const place;
    Outcome const o = expect_run(place, small + "-o out", 0);
    EXPECT_EQ((o.out + o.err).find('\033'), std::string::npos);
    EXPECT_EQ(o.out, "out\n");
}

TEST(Manners, JsonIsExactlyOneObject) {
    Workplace const place;
    Outcome const made = expect_run(place, small + "-o out --json -q", 0);
    auto const report = nlohmann::json::parse(made.out);
    EXPECT_EQ(report["recipe"]["grid"]["width"], 64);
    EXPECT_GT(report["network"]["arcs"], 0);
    EXPECT_TRUE(report["dem"]["max"].contains("col"));
    for (auto const& name : report["files"]) {
        EXPECT_TRUE(fs::exists(place / "out" / name.get<std::string>())) << name;
    }
    auto const check = nlohmann::json::parse(thalweg_run("check out --json", place.path()).out);
    EXPECT_EQ(check["ok"], true);
    auto const stats = nlohmann::json::parse(thalweg_run("stats out/dem.tif --json", place.path()).out);
    for (auto const& [key, value] : stats.items()) {
        EXPECT_EQ(value, report["dem"][key]) << key;
    }
    EXPECT_GT(stats["lx_cells"], 0.0);
    EXPECT_GT(stats["dimension"], 2.0);
    std::string const text = thalweg_run("stats out/dem.tif", place.path()).out;
    for (char const* word : {"shape ", "roughness ", "length ", "dimension "}) {
        EXPECT_TRUE(test::has(text, word));
    }
}

TEST(Manners, OverwriteReplacesOnlyItsOwn) {
    Workplace const place;
    ASSERT_EQ(thalweg_run(small + "-o out -q", place.path()).code, 0);
    std::string const before = file_bytes(place / "out/dem.tif");
    place.write("out/mine.txt", "mine");
    EXPECT_EQ(thalweg_run(small + "-o out -q", place.path()).code, 2);
    EXPECT_EQ(file_bytes(place / "out/dem.tif"), before);
    expect_run(place, small + "--seed 8 -o out -q --overwrite", 0);
    EXPECT_NE(file_bytes(place / "out/dem.tif"), before);
    EXPECT_EQ(file_bytes(place / "out/mine.txt"), "mine");
    EXPECT_EQ(entries(place.path()), 1U) << "nothing temporary stays";
}

TEST(Manners, StraightHeightsThatRiseFailTheCheckAndLeaveTheFiles) {
    Workplace const place;
    Outcome const o =
        thalweg_run("make --set grid.width=256 --set grid.height=256 --set network.dla.particles=6000 --set "
                    "network.prune=3 --set network.heights=straight --set surface.method=dilate -o out",
                    place.path());
    EXPECT_EQ(o.code, 3) << o.err;
    EXPECT_TRUE(fs::exists(place / "out/dem.tif"));
    EXPECT_TRUE(test::has(o.err, "uphill_arcs"));
    EXPECT_EQ(thalweg_run("check out", place.path()).code, 3);
}

TEST(Manners, ATamperedFileIsFoundByReplay) {
    Workplace const place;
    ASSERT_EQ(thalweg_run(small + "-o out -q", place.path()).code, 0);
    EXPECT_EQ(thalweg_run("replay out --verify", place.path()).code, 0);
    std::string bytes = file_bytes(place / "out/network.tif");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    place.write("out/network.tif", bytes);
    fs::remove(place / "out/map.png");
    Outcome const o = expect_run(place, "replay out --verify", 3);
    EXPECT_TRUE(test::has(o.out, "DIFFERS  network.tif", "MISSING  map.png"));
}

TEST(Manners, TheOpenClDeviceIsNamed) {
    Workplace const place;
    Outcome const there = expect_run(place, small + "-o out --device opencl", 0);
    EXPECT_TRUE(test::has(("\n" + there.err), "\ndevice "));
    EXPECT_EQ(thalweg_run("replay out --verify", place.path()).code, 0) << "a device is no part of a recipe";
}

} // namespace manners_test
