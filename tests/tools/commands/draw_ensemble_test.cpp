// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <io/tiff.hpp>
#include <io/vector_files.hpp>
#include <support.hpp>

#include "command.hpp"

namespace draw_ensemble_test {

namespace fs = std::filesystem;

namespace {

std::string const header = "member,seed,surface.mean_slope,network.source,status,reason,check.nan,dem.mean,dem.cells,"
                           "law.hack,law.area,relief.perched,relief.of_later\n";

/// A table of members and their DEMs: the fourth failed, the last has no DEM.
void make_ensemble(Workplace const& place, int members, bool with_dems = true) {
    std::string table = header;
    fs::create_directory(place / "many");
    for (int m = 0; m < members; ++m) {
        if (m == 3) {
            table += "3,103,19.5,dla,failed,\"the relief \"\"<b>\"\" is too high, lower it\",,,,,,,\n";
            continue;
        }
        table += std::to_string(m) + "," + std::to_string(100 + m) + "," + std::to_string(10 + m) + ".5," +
                 (m % 2 == 0 ? "dla" : "forest") + (m == 1 ? ",check_failed,nan" : ",ok,") + ",0," +
                 std::to_string(200 + m * m) + ".25,1200,0." + std::to_string(50 + m) + ",,0,1\n";
        if (with_dems && m + 1 < members) {
            std::string const folder = "many/member_0000" + std::to_string(m);
            fs::create_directory(place / folder);
            written((place / (folder + "/dem.tif")).string(), {.epsg = 32631, .nodata = NAN},
                    [m](int x, int y) { return m + std::sin(0.3 * x) * (10.0 + m) + y; });
        }
    }
    place.write("many/table.csv", table);
}

std::string names_in(fs::path const& folder) {
    std::string text;
    for (auto const& [name, bytes] : content(folder)) {
        text += (text.empty() ? "" : " ") + name;
    }
    return text;
}

} // namespace

TEST(DrawEnsemble, PicturesSheetAndPageOfATable) {
    Workplace const place;
    make_ensemble(place, 8);
    auto const said =
        expect_run(place, "draw many/table.csv --what ensemble -o out --title 'A & <b>' --json", 0).json();
    EXPECT_EQ(names_in(place / "out"), "contact_sheet.png distributions.svg ensemble.html responses_network.source.svg "
                                       "responses_surface.mean_slope.svg");
    EXPECT_EQ(said["files"].size(), 5U);
    std::string const notes = said["notes"].dump();
    EXPECT_TRUE(test::has(notes, "no member has a number: law.area", "the same number: relief.of_later, dem.cells",
                          "all 8 members; empty frames: 1 failed"))
        << notes;
    std::string const page = file_bytes(place / "out/ensemble.html");
    EXPECT_TRUE(test::has(page, "<title>A &amp; &lt;b&gt;</title>",
                          "8 members, 1 of them with failed checks, 1 not made", "Hack’s exponent h", "0.52 to 0.6",
                          "data:image/png;base64,", "the relief &quot;&lt;b&gt;&quot; is too high", "dla, forest",
                          "thalweg draw many/table.csv --what ensemble -o out --title"));
    EXPECT_FALSE(test::has(page, "<script") || test::has(page, " style=") || test::has(page, " src=\"http"));
    // Five members have an exponent of 0.52 to 0.6, of seven that were made.
    std::string const row = page.substr(page.find("<th scope=\"row\">Hack"));
    EXPECT_TRUE(test::has(row.substr(0, row.find("</tr>")), "<td>7</td>", "71&nbsp;%", ">1.00<"));
    // The folder means the table in it.
    expect_run(place, "draw many --what ensemble -o out2 --title 'A & <b>' -q --threads 1", 0);
    for (std::string const name : {"distributions.svg", "contact_sheet.png", "responses_network.source.svg"}) {
        EXPECT_TRUE(file_bytes(place / ("out2/" + name)) == file_bytes(place / ("out/" + name))) << name;
    }
}

TEST(DrawEnsemble, WhatMakeLeft) {
    Workplace const place;
    expect_run(place,
               "make --set grid.width=64 --set grid.height=48 --ensemble 3 --vary surface.mean_slope=10..30 --only dem "
               "-q -o made",
               0);
    auto const said = expect_run(place, "draw made --what ensemble -o made --json", 0).json();
    EXPECT_TRUE(test::has(said["files"].dump(), "made/contact_sheet.png", "made/responses_surface.mean_slope.svg"));
    EXPECT_TRUE(test::has(said["notes"].dump(), "all 3 members"));
    EXPECT_TRUE(test::has(file_bytes(place / "made/ensemble.html"), ">length of all rivers <", ">slope, mean <"));
}

TEST(DrawEnsemble, ThePolicyOfThePageAllowsItsStyle) {
    Workplace const place;
    make_ensemble(place, 5);
    expect_run(place, "draw many/table.csv --what ensemble -o page.html -q", 0);
    std::string const check =
        "/usr/bin/python3 -c 'import base64,hashlib,re,sys; t=open(sys.argv[1]).read(); "
        "h=base64.b64encode(hashlib.sha256(re.search(\"<style>(.*?)</style>\",t,re.S)[1].encode()).digest()).decode(); "
        "sys.exit(f\"style-src \\x27sha256-{h}\\x27;\" not in t)' ";
    EXPECT_EQ(std::system((check + (place / "page.html").string()).c_str()), 0);
}

TEST(DrawEnsemble, OneFileAndFormats) {
    Workplace const place;
    make_ensemble(place, 30, false);
    for (std::string const ending : {"png", "svg", "pdf"}) {
        EXPECT_EQ(expect_run(place, "draw many --what ensemble -o one." + ending + " -q", 0).out,
                  "one." + ending + "\n");
    }
    EXPECT_EQ(file_bytes(place / "one.pdf").substr(0, 5), "%PDF-");
    auto const said =
        expect_run(place, "draw many --what ensemble -o out --format png,pdf --width 500 --json", 0).json();
    EXPECT_TRUE(test::has(said["notes"].dump(), "there is no contact sheet: no folder member_00000"));
    EXPECT_EQ(names_in(place / "out"), "distributions.pdf distributions.png ensemble.html responses_network.source.pdf "
                                       "responses_network.source.png responses_surface.mean_slope.pdf "
                                       "responses_surface.mean_slope.png");
    EXPECT_EQ(opened(place / "out/distributions.png")->GetRasterXSize(), 500);
    place.write("many/shard-000000.tar", "");
    EXPECT_TRUE(test::has(expect_run(place, "draw many --what ensemble -o x.html --json", 0).json()["notes"].dump(),
                          "the members are in tar files"));
}

TEST(DrawEnsemble, BadInputIsRefusedAndNothingOverwritten) {
    Workplace const place;
    make_ensemble(place, 5);
    place.write("ragged.csv", "member,law.hack\n0\n");
    place.write("no_member.csv", "seed,law.hack\n0,1\n");
    place.write("no_rows.csv", header);
    place.write("no_numbers.csv", "member,law.hack\n0,\n");
    fs::create_directories(place / "damaged/member_00000");
    place.write("damaged/table.csv", "member,law.hack\n0,0.5\n");
    place.write("damaged/member_00000/dem.tif", "no raster");
    expect_refused(place, "draw --what ensemble -o out",
                   {"ragged.csv", "no_member.csv", "no_rows.csv", "no_numbers.csv", "nowhere.csv", "damaged",
                    "many/member_00000/dem.tif"});
    expect_refused(place, "draw many -o out --what",
                   {"ensemble,map", "ensemble,page", "ensembl", "ensemble --network x.gpkg", "ensemble --azimuth 3",
                    "ensemble --format gif"});
    expect_refused(place, "draw many --what ensemble -o", {"x.svg --format png", "x.html --format png"});
    EXPECT_TRUE(
        test::has(thalweg_run("draw many -o out --what ensembl", place.path()).err, "Did you mean 'ensemble'?"));
    fs::create_directory(place / "out");
    place.write("out/contact_sheet.png", "mine");
    place.write("out/letter.txt", "mine");
    expect_refused(place, "draw many --what ensemble -o", {"out"});
    expect_run(place, "draw many --what ensemble -o out --overwrite -q", 0);
    EXPECT_EQ(file_bytes(place / "out/contact_sheet.png").substr(1, 3), "PNG");
    EXPECT_EQ(file_bytes(place / "out/letter.txt"), "mine");
}

} // namespace draw_ensemble_test
