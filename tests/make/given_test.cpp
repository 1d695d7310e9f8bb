// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/given.hpp>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <make/made.hpp>

#include <thalweg/core/vec.hpp>

namespace given_test {

using namespace thalweg;
using namespace thalweg::make;

namespace {

using test::line;

/// One of each kind around a trunk of 3000 m that runs south, on 140 x 120 cells of 30 m.
std::string const rivers =
    test::geojson(line("[502000,5003000],[502000,5002000]") + "," + line("[502000,5002000],[502000,5000000]") + "," +
                  line("[501000,5002500],[502000,5002000]", "\"waterway\":\"canal\"") + "," +    // 1118 m
                  line("[500000,5001000],[500400,5001000]", "\"natural\":\"coastline\"") + "," + // 400 m
                  line("[502000,5002000],[502000,5000000]") + "," +                              // 2000 m once more
                  line("[502000,5001500],[502300,5001250],[502000,5001000]") + "," +             // a braid of 781 m
                  line("[502000,5002000],[503000,5002800]") + "," + // drawn upstream, 1281 m
                  line("[503500,5001000],[502040,5001000]") + "," + // ends 40 m beside the trunk
                  line("[502000,5003000],[502000,5003010]") + "," + // 10 m
                  line("[501000,5004600],[502000,5002500]"));       // 1107 m of it beyond the grid

std::string const recipe = "[grid]\nwidth = 140\nheight = 120\norigin = [500000, 5003600]\ncell = 30\nclip = true\n"
                           "crs = \"EPSG:32631\"\n[network]\nsource = \"lines\"\n";
std::string const path = "[network.lines]\npath = \"rivers.geojson\"\ncoastlines = \"none\"\nsnap = 50\n";

struct Files : ScratchFolder {
    Files() { write("rivers.geojson", rivers); }
    std::string folder() const { return path().string(); }
};

/// Law: nothing is lost on the way, and what is left out can be looked at.
void expect_balanced(GivenLength const& given) {
    double const out = std::accumulate(given.left_out_m.begin(), given.left_out_m.end(), 0.0);
    EXPECT_NEAR(given.read_m + given.closed_m, given.kept_m + out, 1e-6);
    for (std::size_t cause = 0; cause < given.left_out_m.size(); ++cause) {
        double sum = 0.0;
        for (SecondaryLine const& one : given.secondary) {
            sum += static_cast<std::size_t>(one.cause) == cause ? length_in_plan(one.vertices) : 0.0;
        }
        EXPECT_NEAR(given.left_out_m[cause], sum, 1e-6) << key_of(static_cast<LeftOut>(cause));
    }
}

double stretches_m(MakeResult const& t) {
    return t.planform.file.sources.length_m(t.terrain.rivers.network.planform);
}

} // namespace

TEST(GivenLength, EveryMetreIsAccountedFor) {
    Files const files;
    MakeResult const t = test::made(recipe + path, files.folder());
    GivenLength const& given = *t.assessment.given;
    expect_balanced(given);
    EXPECT_NEAR(given.kept_m, stretches_m(t), 1e-6);
    EXPECT_NEAR(given.read_m, 1000.0 + 2000.0 + 1118.0 + 400.0 + 2000.0 + 781.0 + 1280.6 + 1460.0 + 10.0 + 2325.9, 1.0);
    EXPECT_NEAR(given.left_out(LeftOut::filter), 1118.0, 0.1);
    EXPECT_NEAR(given.left_out(LeftOut::coast), 400.0, 1e-6);
    EXPECT_NEAR(given.left_out(LeftOut::duplicate), 2000.0, 1e-6);
    EXPECT_NEAR(given.left_out(LeftOut::divergence), 781.0, 0.1);
    EXPECT_NEAR(given.left_out(LeftOut::grid), 1107.6 + 3.2, 0.1); // what is drawn on to the edge is straight
    EXPECT_NEAR(given.left_out(LeftOut::too_short), 10.0, 1e-6);
    EXPECT_EQ(given.left_out(LeftOut::pruned), 0.0);
    EXPECT_NEAR(given.turned_m, 1280.6, 0.1);
    EXPECT_NEAR(given.moved_m, 40.0, 1e-6);
    EXPECT_NEAR(given.closed_m, 40.0, 10.0); // and what was too short lengthens the trunk
    EXPECT_NEAR(given.share(), given.kept_m / (given.kept_m + 10.0), 1e-12);
}

TEST(GivenLength, WhatIsPrunedWasAskedFor) {
    Files const files;
    MakeResult const t = test::made(recipe + "prune = 46\n" + path, files.folder());
    GivenLength const& given = *t.assessment.given;
    expect_balanced(given);
    EXPECT_NEAR(given.left_out(LeftOut::pruned), 1280.6 + 500.0, 0.1); // the two shortest branches
    EXPECT_GT(given.share(), 0.99);
}

TEST(GivenLength, HeadsBesideAnotherRiverAreCut) {
    Files files;
    // One begins in a cell beside another's.
    files.write("rivers.geojson", test::geojson(line("[502000,5003590],[502000,5000010]") + "," +
                                                line("[502030,5003000],[502400,5003100],[502400,5003590]")));
    std::string const text = recipe + "[network.lines]\npath = \"rivers.geojson\"\n[surface]\n";
    std::string const asked = recipe + "[network.lines]\npath = \"rivers.geojson\"\nkeep = 1\n[surface]\n";
    MakeResult const t = test::made(text, files.folder());
    GivenLength const& given = *t.assessment.given;
    expect_balanced(given);
    EXPECT_NEAR(given.kept_m, stretches_m(t), 1e-6);
    ASSERT_GT(given.left_out(LeftOut::head), 0.0);
    for (Check const& check : t.assessment.checks) {
        EXPECT_EQ(check.ok, check.name != "given_length") << check.name << ' ' << check.value;
    }
    EXPECT_FALSE(test::made(asked, files.folder()).assessment.passed());
}

TEST(GivenLength, HeadsNearTheEdgeAndLowerValleysAreKept) {
    Files files;
    files.write("rivers.geojson", test::geojson(line("[502000,5003590],[502000,5000010]") + "," +
                                                line("[502200,5003000],[502200,5003590]")));
    MakeResult const t = test::made(recipe + "[network.lines]\npath = \"rivers.geojson\"\n[surface]\n", files.folder());
    EXPECT_EQ(t.assessment.given->share(), 1.0);
    EXPECT_TRUE(t.assessment.passed());
}

TEST(GivenLength, OfAFeatureInSeveralPartsOnlyTheShortOneIsLeftOut) {
    Files files;
    std::string const parts = "[[[502000,5003000],[502000,5000010]],[[502000,5003000],[502000,5003010]]]";
    files.write("rivers.geojson", test::geojson(test::feature("MultiLineString", parts)));
    MakeResult const t = test::made(recipe + path, files.folder());
    GivenLength const& given = *t.assessment.given;
    expect_balanced(given);
    EXPECT_NEAR(given.left_out(LeftOut::too_short), 10.0, 1e-6);
    EXPECT_NEAR(given.kept_m, 2990.0, 10.0);
}

// Areas of three schemas: the terrain's at an arc's lower end divided by the file's, where that line ends there.
TEST(GivenAreas, OfTheFileStandBesideThoseOfTheTerrain) {
    std::string const text = recipe + "[network.lines]\npath = \"rivers.geojson\"\n[surface]\n";
    Files files;
    EXPECT_FALSE(test::made(text, files.folder()).assessment.given_areas);
    for (auto const& [field, unit_m2] :
         {std::pair("\"TotDASqKM\":", 1e6), std::pair("\"UPLAND_SKM\":", 1e6), std::pair("\"DSContArea\":", 1.0)}) {
        auto const area = [&](double km2) { return fmt::format("{}{}", field, km2 * 1e6 / unit_m2); };
        // The upper half of the trunk has an area, the lower one none; its tributary runs as drawn.
        files.write("rivers.geojson", test::geojson(line("[502000,5003000],[502000,5002000]", area(2.0)) + "," +
                                                    line("[503000,5002800],[502000,5002000]", area(4.0)) + "," +
                                                    line("[502000,5002000],[502000,5000010]", area(0.0))));
        MakeResult const t = test::made(text, files.folder());
        ASSERT_TRUE(t.assessment.given_areas) << field;
        GivenAreas const& given = *t.assessment.given_areas;
        EXPECT_EQ(given.arcs, 2);
        std::vector<double> ratios;
        StreamNetwork const& network = t.terrain.rivers.network.planform;
        for (ArcId a = 0; a < network.arc_count(); ++a) {
            double const km2 = network.arc(a).feature == 1 ? 2.0 : network.arc(a).feature == 2 ? 4.0 : 0.0;
            if (km2 > 0.0) {
                ratios.push_back(t.terrain.water.areas.ds_area_m2[a] / (1e6 * km2));
            }
        }
        std::ranges::sort(ratios);
        ASSERT_EQ(ratios.size(), 2U);
        EXPECT_DOUBLE_EQ(given.low, ratios[0]);
        EXPECT_DOUBLE_EQ(given.high, ratios[1]);
        auto const near = std::ranges::count_if(ratios, [](double r) { return r >= 0.5 && r <= 2.0; });
        EXPECT_DOUBLE_EQ(given.within_factor_2, 0.5 * static_cast<double>(near));
    }
}

// Nothing fits the terrain to the file's areas: they agree where neighbouring valleys lie beyond the map.
TEST(GivenAreas, OfWalkerCreekAreTheTerrains) {
    std::string const text =
        "[network]\nsource = \"lines\"\n[network.lines]\npath = \"walker_nhdplus.gpkg\"\n[surface]\n";
    MakeResult const t = test::made(text, THALWEG_SOURCE_DIR "/samples");
    ASSERT_TRUE(t.assessment.given_areas);
    EXPECT_GE(t.assessment.given_areas->arcs, 50);
    EXPECT_GE(t.assessment.given_areas->within_factor_2, 0.9);
    EXPECT_NEAR(t.assessment.given_areas->median, 1.0, 0.15);
}

// 123 km of rivers on 5 x 5 or 7 x 7 cells passed every check in silence.
TEST(GivenLength, CellsTooLargeForTheRiversAreSaid) {
    auto const said = [](std::string const& grid) {
        MakeResult const t = test::made(
            grid + "[network]\nsource = \"lines\"\n[network.lines]\npath = \"walker_nhdplus.gpkg\"\n[surface]\n",
            THALWEG_SOURCE_DIR "/samples");
        std::vector<Finding> found;
        std::ranges::copy_if(t.assessment.findings, std::back_inserter(found),
                             [](Finding const& f) { return f.kind.row().kind == std::string_view("crowded_rivers"); });
        return found;
    };
    for (std::string const grid : {"[grid]\ncell = 10000\n", "[grid]\ncell = 5000\n"}) {
        std::vector<Finding> const found = said(grid);
        ASSERT_EQ(found.size(), 1U) << grid;
        EXPECT_GT(found[0].amount, 0.6);
        EXPECT_TRUE(
            test::has(found[0].text, "of the 51 arcs have no cell of their own: cells of ", "000 m are too large"));
        EXPECT_TRUE(test::has(found[0].remedy, "--set grid.cell="));
    }
    EXPECT_TRUE(said("[grid]\ncell = 300\n").empty());
}

TEST(GivenLength, BendsAreNoLength) {
    Files const files;
    MakeResult const t = test::made(recipe + "meander = 1\n" + path, files.folder());
    MakeResult const straight = test::made(recipe + path, files.folder());
    EXPECT_NEAR(t.assessment.given->kept_m, straight.assessment.given->kept_m, 1e-6);
    EXPECT_EQ(t.assessment.given->left_out(LeftOut::head), 0.0);
}

TEST(GivenLength, OneLineSumsItUp) {
    GivenLength given;
    given.read_m = 5307000.0;
    given.kept_m = 5000000.0;
    given.left_out_m = {1000.0, 0.0, 0.0, 0.0, 0.0, 2000.0, 0.0, 304000.0};
    given.turned_m = 1500.0;
    given.moved_m = 12.5;
    given.carried_m = 700.0;
    EXPECT_TRUE(test::has(line_of(given),
                          "5307.0 km read, 5000.0 km kept; left out: 1.0 km no natural watercourses, 2.0 km ",
                          ", 304.0 km", "; 1.5 km", " 12.5 m", " 0.7 km"));
}

} // namespace given_test
