// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

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
    Workplace const place;
    place.write("valley.toml", recipe);
    for (std::string const method : {"carve", "fill", "none"}) {
        expect_run(place, "make valley.toml -q -o " + method + " --set surface.drain=" + method, 0);
        json const report = report_of(place / method);
        EXPECT_EQ(check_of(report, "valley_cells_moved")["value"], 0);
        Outcome const check = thalweg_run("check " + method + " --dem " + method + "/dem.tif --json", place.path());
        json const checked = check.json();
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

TEST(Certificate, RefusesAnotherCrsAndNoDem) {
    Workplace const place;
    place.write("valley.toml", recipe);
    expect_run(place, "make valley.toml -q -o v", 0);
    expect_run(place, "make valley.toml -q -o w --set grid.crs=EPSG:32632", 0);
    expect_run(place, "make valley.toml -q -o x --set grid.origin=[900000,4000000]", 0);
    expect_refused(place, "check v --dem", {"w/dem.tif", "nothing.tif", "v/recipe.toml", "x/dem.tif"});
}

} // namespace certificate_test
