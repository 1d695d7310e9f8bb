// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Every reader of findings has the same ones, word for word: the terminal, report.json, report.html, --json,
// --progress, the forecast and the table of an ensemble. The studio: tests/studio; Python: tests/python; QGIS:
// tests/qgis.
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <command.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>
#include <zero_height.hpp>

namespace findings_test {

using nlohmann::json;

using Texts = std::vector<std::string>;

/// The sentences of a list of findings with a severity, as a line of the terminal has them.
Texts sentences(json const& findings, std::string const& severity = "warning") {
    Texts texts;
    for (json const& finding : findings) {
        if (finding["severity"] == severity) {
            std::string const remedy = finding.value("remedy", "");
            texts.push_back(finding["text"].get<std::string>() + "." + (remedy.empty() ? "" : " " + remedy + ".") +
                            " [" + finding["kind"].get<std::string>() + "]");
        }
    }
    return texts;
}

/// The lines that begin with a word, without it.
Texts lines_with(std::string const& text, std::string const& word) {
    Texts found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(word)) {
            found.push_back(line.substr(word.size()));
        }
    }
    return found;
}

TEST(Findings, AreTheSameForEveryReader) {
    Workplace const place;
    place.write("r.geojson", test::zero_height);
    std::string const grid = " --set grid.cell=50";
    Outcome const made = expect_run(place, "make r.geojson -o out" + grid, 0);
    json const report = report_of(place / "out");
    Texts const told = sentences(report["findings"]);
    ASSERT_GE(told.size(), 2U) << report["findings"].dump(1);
    EXPECT_TRUE(
        test::has(told[0], "heights of 0 in r.geojson count as missing (vertices: 1; ", "[placeholder_heights]"))
        << told[0];
    EXPECT_TRUE(test::has(told[1], "heights are missing in 1 of 3 lines of r.geojson (with some, which stay: 1)",
                          "[filled_heights]"))
        << told[1];
    EXPECT_EQ(lines_with(made.err, "warning: "), told);
    for (json const& finding : report["findings"]) {
        EXPECT_TRUE(finding.contains("unit") && finding.contains("amount")) << finding;
        if (finding["severity"] == "warning") {
            EXPECT_TRUE(test::has(file_bytes(place / "out/report.html"), finding["text"].get<std::string>()))
                << finding;
            EXPECT_TRUE(finding.contains("key")) << finding;
        }
    }

    // Programs get objects in place of lines.
    Outcome const watched = expect_run(place, "make r.geojson -o again --progress" + grid, 0);
    json objects = json::array();
    for (std::string const& line : lines_with(watched.err, "{\"finding\": ")) {
        objects.push_back(json::parse("{\"finding\": " + line)["finding"]);
    }
    EXPECT_EQ(sentences(objects), told);
    EXPECT_EQ(lines_with(watched.err, "warning: "), Texts{});

    // Planning finds what there is to find in the file.
    Outcome const planned = expect_run(place, "make r.geojson --dry-run --json" + grid, 0);
    EXPECT_EQ(sentences(planned.json()["findings"]), Texts(told.begin(), told.begin() + 2));
    EXPECT_EQ(lines_with(planned.err, "warning: "), Texts(told.begin(), told.begin() + 2));

    Outcome const many = expect_run(place, "make r.geojson --ensemble 2 --only table -o e --json" + grid, 0);
    std::string const table = file_bytes(place / "e/table.csv");
    std::istringstream rows(table);
    std::string head;
    std::getline(rows, head);
    for (std::string row; std::getline(rows, row);) {
        EXPECT_TRUE(test::has(row, ",ok,," + std::to_string(told.size()) + ",")) << head << "\n" << row;
    }
    json const of_members = many.json()["findings"];
    ASSERT_EQ(of_members.size(), 1U);
    EXPECT_EQ(of_members[0]["kind"], "members_warned");
    EXPECT_EQ(of_members[0]["amount"], 2.0);
}

// -q prints none; -v prints also those that list features.
TEST(Findings, QuietAndVerbose) {
    Workplace const place;
    place.write("r.geojson", test::zero_height);
    EXPECT_EQ(expect_run(place, "make r.geojson -o quiet -q --set grid.cell=50", 0).err, "");
    Outcome const said = expect_run(place, "make r.geojson -o talks --set grid.cell=50 --set network.lines.snap=30", 0);
    Outcome const all =
        expect_run(place, "make r.geojson -o verbose -v --set grid.cell=50 --set network.lines.snap=30", 0);
    json const findings = report_of(place / "verbose")["findings"];
    for (json const& finding : findings) {
        std::string const text = finding["text"];
        EXPECT_TRUE(test::has(all.err, text)) << text;
        if (finding["kind"] == "carried_outlet") {
            EXPECT_FALSE(test::has(said.err, text)) << text;
        }
    }
    EXPECT_GE(sentences(findings, "note").size(), 3U);
}

// --json of commands that read a DEM says how it was read.
TEST(Findings, AreInTheObjectOfEveryCommand) {
    Workplace const place;
    place.write("steps.asc", "ncols 8\nnrows 8\nxllcorner 500000\nyllcorner 5000000\ncellsize 30\n" +
                                 std::string("5 9 3 4 2 6 1 8 ") + "2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9 8 7 6 5 4 3 2 " +
                                 "3 3 4 4 5 5 6 6 1 3 5 7 9 7 5 3 2 4 6 8 6 4 2 1 9 1 8 2 7 3 6 4\n");
    place.write("steps.prj",
                "PROJCS[\"WGS 84 / UTM zone 33N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\","
                "6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
                "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],"
                "PARAMETER[\"central_meridian\",15],PARAMETER[\"scale_factor\",0.9996],"
                "PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]");
    for (std::string const& command :
         {std::string("stats steps.asc"), std::string("draw steps.asc -o pictures"),
          std::string("export steps.asc -o a.png"), std::string("measure steps.asc -o measures"),
          std::string("tin steps.asc -o a.2dm"), std::string("points steps.asc -o a.xyz"),
          std::string("blend steps.asc steps.asc -o blended.tif --window 2,2,4,4"),
          std::string("deform steps.asc -o bent.tif --mask mask.geojson --scale 2")}) {
        place.write("mask.geojson", R"({"type":"Polygon","coordinates":[[[15.0005,45.1536],[15.0020,45.1536],)"
                                    R"([15.0020,45.1546],[15.0005,45.1546],[15.0005,45.1536]]]})");
        Outcome const run = expect_run(place, command + " --nodata 9 --json", 0);
        if (run.code == 0) {
            json const object = run.json();
            std::set<std::string> kinds;
            for (json const& finding : object["findings"]) {
                kinds.insert(finding["kind"].get<std::string>());
            }
            EXPECT_TRUE(kinds.contains("named_nodata")) << command << "\n" << run.out << run.err;
        }
    }
}

} // namespace findings_test
