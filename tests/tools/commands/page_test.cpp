// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <report/page_decoder.hpp>
#include <support.hpp>
#include <unpacked.hpp>

#include "command.hpp"

namespace page_test {

namespace fs = std::filesystem;

namespace {

nlohmann::json data_of(std::string const& page) {
    return nlohmann::json::parse(page_decoder::part(page, "@@DATA@@"));
}

} // namespace

TEST(ReportPage, EveryMakeLeavesOne) {
    Workplace const place;
    Outcome const o = expect_run(place, small + "out --json", 0);
    std::string const page = file_bytes(place / "out/report.html");
    for (char const* marker : {"@@TITLE@@", "@@DATA@@", "@@HEIGHTS@@", "@@LINES@@", "@@WATER@@", "@@STUDIO@@"}) {
        EXPECT_FALSE(test::has(page, marker));
    }
    auto const report = o.json();
    auto const& files = report["files"];
    EXPECT_EQ(std::count(files.begin(), files.end(), "report.html"), 1);
    auto const data = data_of(page);
    EXPECT_EQ(data["grid"]["width"], 64);
    EXPECT_EQ(data["rivers"]["arcs"]["id"].size(), report["network"]["arcs"]);
    EXPECT_EQ(data["recipe"], file_bytes(place / "out/recipe.toml"));
    for (auto const& row : data["laws"]["rows"]) {
        auto const key = row["key"].get<std::string>();
        EXPECT_EQ(row["network"]["value"], report["network"]["laws"][key]["value"]) << key;
        EXPECT_EQ(row["dem"]["value"], report["dem"]["laws"][key]["value"]) << key;
    }
    EXPECT_EQ(report["network"]["laws"]["bifurcation"]["value"], report["network"]["horton"]["bifurcation"]);
    EXPECT_EQ(data["laws"]["orders"].size(), report["network"]["strahler"]);
    EXPECT_EQ(data["hypsometry"]["integral"], report["dem"]["hypsometric_integral"]);
    EXPECT_EQ(data["relief"], report["dem"]["relief"]);
    EXPECT_TRUE(data["relief"]["figures"].contains("perched"));
    EXPECT_EQ(unpacked(page_decoder::part(page, "@@HEIGHTS@@")).size(), 48U + 2U * 64U * 48U);

    // Times differ: replay looks at neither report.
    place.write("out/report.html", page + "<!-- -->");
    expect_run(place, "replay out --verify", 0);

    // The command on the page makes the same land again.
    auto const command = data["command"].get<std::string>();
    ASSERT_EQ(command.rfind("thalweg ", 0), 0U) << command;
    Outcome const again = thalweg_run(command.substr(8), place / "out");
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(file_bytes(place / "out/again/dem.tif"), file_bytes(place / "out/dem.tif"));
}

TEST(ReportPage, ATitleCannotLeaveItsPlace) {
    Workplace const place;
    place.write("r.toml", "[grid]\nwidth = 64\nheight = 48\n[network]\nprune = 4\n[network.dla]\nparticles = 400\n"
                          "[surface]\n[output]\ntitle = '''</script><script>alert(1) \"q\" 'q' & 流域'''\n");
    expect_run(place, "make r.toml -o out -q", 0);
    std::string const page = file_bytes(place / "out/report.html");
    EXPECT_FALSE(test::has(page, "<script>alert"));
    EXPECT_EQ(page_decoder::part(page, "@@TITLE@@"),
              "&lt;/script&gt;&lt;script&gt;alert(1) &quot;q&quot; &#39;q&#39; &amp; 流域");
    EXPECT_EQ(data_of(page)["title"], "</script><script>alert(1) \"q\" 'q' & 流域");
}

TEST(ReportPage, TheSampleStaysBelowThreeMegabytes) {
    Workplace const place;
    expect_run(place, "make " + samples + "dla.toml -o out -q", 0);
    EXPECT_LT(fs::file_size(place / "out/report.html"), 3'000'000U);
}

} // namespace page_test
