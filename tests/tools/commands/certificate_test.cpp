// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include "command.hpp"
#include "report.hpp"

namespace certificate_test {

namespace {

using nlohmann::json;

// Rivers that stand above the land beside them here and there, and pits between them.
constexpr char const* recipe =
    "seed = 3\n"
    "[grid]\nwidth = 200\nheight = 200\ncell = 30\n"
    "[network]\nsource = \"dla\"\nprune = 10\nslope = 0.02\n"
    "[network.dla]\nparticles = 6000\n"
    "[surface]\nmethod = \"dilate\"\nincrement = \"rise_fall\"\nmetric = \"euclid\"\nrelief = 200\n";

json check_of(json const& report, std::string const& name) {
    for (json const& check : report["checks"]) {
        if (check["name"] == name) {
            return check;
        }
    }
    return nullptr;
}

bool has_finding(json const& checked, std::string const& kind) {
    auto const& findings = checked["findings"];
    return std::any_of(findings.begin(), findings.end(), [&](json const& f) { return f["kind"] == kind; });
}

} // namespace

TEST(Certificate, TellsALandThatDrainsFromOneThatDoesNot) {
    Workplace const work;
    work.write("valley.toml", recipe);
    for (std::string const method : {"carve", "fill", "none"}) {
        Outcome const made =
            thalweg_run("make valley.toml -q -o " + method + " --set surface.drain=" + method, work.path());
        EXPECT_EQ(made.code, 0) << made.err;
        json const report = report_of(work / method);
        EXPECT_EQ(check_of(report, "valley_cells_moved")["value"], 0);
        Outcome const check = thalweg_run("check " + method + " --dem " + method + "/dem.tif --json", work.path());
        json const checked = json::parse(check.out);
        json const& certificate = checked["certificate"];
        if (method == "none") {
            EXPECT_EQ(check.code, 3) << check.out;
            EXPECT_FALSE(report.contains("drained"));
            EXPECT_TRUE(check_of(report, "depressions").is_null()); // told, not judged
            EXPECT_GT(report["certificate"]["depressions"]["count"], 0);
            EXPECT_TRUE(has_finding(checked, "depression"));
            EXPECT_TRUE(has_finding(checked, "water_leaves"));
        } else {
            EXPECT_EQ(check.code, 0) << check.out;
            EXPECT_EQ(check_of(report, "depressions")["value"], 0);
            EXPECT_GT(report["drained"]["banks"]["raised_cells"], 0);
            EXPECT_EQ(report["drained"]["banks"]["cut_cells"], 0);
            EXPECT_EQ(report["drained"]["depressions"]["cut_cells"] == 0, method == "fill");
            EXPECT_EQ(certificate["sources"], certificate["sources_arriving"]);
            EXPECT_GE(certificate["traced"][0]["f"], 0.95);
            EXPECT_EQ(certificate["traced"], report["certificate"]["traced"]);
        }
        EXPECT_EQ(certificate["river_cells"], report["certificate"]["river_cells"]);
    }
}

TEST(Certificate, TheTableNamesWhatFails) {
    Workplace const work;
    work.write("valley.toml", recipe);
    ASSERT_EQ(thalweg_run("make valley.toml -q -o v --set surface.drain=none", work.path()).code, 0);
    Outcome const check = expect_run(work, "check v --dem v/dem.tif", 3);
    EXPECT_TRUE(test::has(check.out, "depressions", "traced within 1 cells"));
}

TEST(Certificate, RefusesAnotherCrsAndNoDem) {
    Workplace const work;
    work.write("valley.toml", recipe);
    ASSERT_EQ(thalweg_run("make valley.toml -q -o v", work.path()).code, 0);
    ASSERT_EQ(thalweg_run("make valley.toml -q -o w --set grid.crs=EPSG:32632", work.path()).code, 0);
    expect_run(work, "check v --dem w/dem.tif", 2, "EPSG:32632");
    EXPECT_EQ(thalweg_run("check v --dem nothing.tif", work.path()).code, 2);
    EXPECT_EQ(thalweg_run("check v --dem v/recipe.toml", work.path()).code, 2);
    expect_run(work, "make valley.toml -q -o x --set grid.origin=[900000,4000000]", 0);
    EXPECT_EQ(thalweg_run("check v --dem x/dem.tif", work.path()).code, 2);
}

} // namespace certificate_test
