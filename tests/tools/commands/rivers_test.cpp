// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rivers by branching rules, along strokes, and with relief pasted over them, as the command line makes them.
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <io/vector_files.hpp>
#include <support.hpp>

#include <thalweg/io/raster/raster_files.hpp>

#include "command.hpp"

namespace rivers_test {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

using test::geojson;

std::string const sized = " --set grid.width=160 --set grid.height=160 --set network.tokunaga.order=3 ";

std::string stroke(std::string const& vertices, std::string const& properties = "\"rosgen\":\"B\"") {
    return test::line(vertices, properties);
}

std::string const strokes_recipe =
    "[grid]\nwidth = 200\nheight = 200\ncell = 30\norigin = [500000, 4006000]\n[network]\nsource = \"tokunaga\"\n"
    "[network.tokunaga]\norder = 4\nstrokes = \"s.geojson\"\n[surface]\n";

/// A ring 3 km wide and high.
std::string const ring = "[[500000,4000000],[503000,4000300],[503000,4003000],[500300,4003300],[500000,4000000]]";

/// Exit 0, every check holds, and the network and the land are there. Gives the report.
json made(Workplace const& place, std::string const& arguments, std::string const& folder = "out") {
    expect_run(place, "make " + arguments + " -q -o " + folder, 0);
    json const report = report_of(place / folder);
    expect_checks_hold(report, arguments);
    for (char const* name : {"dem.tif", "network.tif", "network.gpkg", "network_arcs.shp", "report.html", "map.png",
                             "profile.svg", "recipe.toml"}) {
        EXPECT_TRUE(fs::exists(place / (folder + "/" + name))) << arguments << name;
    }
    return report;
}

double greatest_difference(fs::path const& a, fs::path const& b) {
    auto const one = thalweg::io::read_dem(a.string());
    auto const two = thalweg::io::read_dem(b.string());
    double greatest = 0.0;
    for (std::int64_t i = 0; i < one.cells(); ++i) {
        greatest = std::max(greatest, static_cast<double>(std::fabs(one[i] - two[i])));
    }
    return greatest;
}

std::int64_t features_in(fs::path const& file, char const* layer) {
    auto const data = opened(file);
    OGRLayer* const found = data->GetLayerByName(layer);
    return found == nullptr ? -1 : found->GetFeatureCount();
}

} // namespace

TEST(Rivers, EverySampleHoldsItsContract) {
    for (std::string const name : {"tokunaga", "strokes", "blend"}) {
        Workplace const place;
        json const report = made(place, samples + name + ".toml --threads 1", "one");
        made(place, samples + name + ".toml --threads 2", "two");
        for (char const* file : {"dem.tif", "network.gpkg", "recipe.toml", "map.png"}) {
            EXPECT_TRUE(file_bytes(place / "one" / file) == file_bytes(place / "two" / file)) << name << file;
        }
        EXPECT_EQ(features_in(place / "one/network.gpkg", "ridges"), report["ridges"]["count"].get<std::int64_t>());
        EXPECT_GT(report["ridges"]["count"], 100);
        EXPECT_GT(report["diffusion"]["iterations"], 0);
        EXPECT_LE(report["diffusion"]["residual"], 1e-8);
        json const& tokunaga = report["network"]["tokunaga"];
        EXPECT_GT(tokunaga["placed"], 0);
        EXPECT_EQ(tokunaga["dropped"], 0);
        EXPECT_EQ(tokunaga["drawn"]["links"], tokunaga["placed"]);
        EXPECT_EQ(tokunaga["grown"]["links"], tokunaga["placed"]);
        EXPECT_EQ(tokunaga.contains("asked"), name != "strokes") << "strokes have a lambda each";
        if (name != "strokes") {
            EXPECT_EQ(tokunaga["grown"]["streams"], tokunaga["drawn"]["streams"]);
            EXPECT_EQ(tokunaga["grown"]["side_branches"], tokunaga["drawn"]["side_branches"]);
            EXPECT_EQ(tokunaga["asked"]["a"], 2.0);
        }
        EXPECT_EQ(report.contains("patches"), name == "blend");
        if (name == "blend") {
            ASSERT_EQ(report["patches"].size(), 1U);
            json const& patch = report["patches"][0];
            EXPECT_GT(patch["cells"], 1000);
            EXPECT_GT(patch["kept"], 0);
            EXPECT_GE(patch["seam_max_m"], patch["seam_rms_m"]);
            EXPECT_TRUE(file_bytes(place / "one/inputs/patch1/bigtujunga_srtm1.tif") ==
                        file_bytes(samples + "bigtujunga_srtm1.tif"));
        }
        if (name == "strokes") {
            EXPECT_EQ(file_bytes(place / "one/inputs/strokes/strokes.geojson"),
                      file_bytes(samples + "strokes.geojson"));
        }
        EXPECT_FALSE(test::has(file_bytes(place / "one/recipe.toml"), samples));
        fs::rename(place / "one", place / "moved");
        expect_run(place, "replay moved --verify", 0);
    }
}

TEST(Rivers, OpenClGivesTheSameLand) {
    Workplace const place;
    made(place, samples + "tokunaga.toml" + sized, "cpu");
    made(place, samples + "tokunaga.toml" + sized + "--device opencl", "opencl");
    EXPECT_LE(greatest_difference(place / "cpu/dem.tif", place / "opencl/dem.tif"), 1e-3);
    EXPECT_TRUE(file_bytes(place / "cpu/network.tif") == file_bytes(place / "opencl/network.tif"));
}

TEST(Rivers, HeightsByTypeOrGradedGoWithLinesOfAFile) {
    for (std::string const heights : {"rosgen", "graded"}) {
        Workplace const place;
        json const report =
            made(place, samples + "lines.toml --set network.slope=0.087 --set network.heights=" + heights);
        EXPECT_EQ(report["recipe"]["network"]["heights"], heights);
        expect_run(place, "replay out --verify", 0);
    }
}

TEST(Rivers, TheMainStemIsTheOneOfTheName) {
    Workplace const place;
    // The brook is longer than the upper part of the river that it joins.
    auto const drawn = [&](std::string const& brook) {
        place.write("rivers.geojson",
                    geojson(test::line("[503000,4001000],[503000,4000100]", R"("name":"Green River")") + "," +
                            test::line("[502000,4001800],[503000,4001000]", R"("name":"Green River")") + "," +
                            test::line("[505500,4004500],[503000,4001000]", "\"name\":\"" + brook + "\"")));
        expect_run(place, "make rivers.geojson -o out --set grid.cell=50 --overwrite -q", 0);
        auto const file = opened(place / "out/network.gpkg");
        std::map<int, int> hack;
        for (auto const& arc : *file->GetLayerByName("arcs")) {
            if (arc->GetFieldAsInteger("given") == 1) {
                hack[arc->GetFieldAsInteger("feature")] = arc->GetFieldAsInteger("hack");
            }
        }
        return hack;
    };
    EXPECT_EQ(drawn("Long Brook"), (std::map<int, int>{{1, 1}, {2, 1}, {3, 2}}));
    EXPECT_EQ(drawn("Green River"), (std::map<int, int>{{1, 1}, {2, 2}, {3, 1}})) << "of two, the longer";
}

TEST(Rivers, EveryWayOfDiffusion) {
    Workplace const place;
    std::string const base = samples + "tokunaga.toml" + sized;
    made(place, base, "steady");
    json const literal = made(place, base + "--set surface.diffusion=explicit --set surface.sweeps=200", "explicit");
    EXPECT_EQ(literal["diffusion"]["iterations"], 200);
    EXPECT_GT(greatest_difference(place / "steady/dem.tif", place / "explicit/dem.tif"), 0.01);
    made(place, base + "--set skeleton.midpoint_inverse=1.5", "inverse");
    EXPECT_GT(greatest_difference(place / "steady/dem.tif", place / "inverse/dem.tif"), 0.01);
}

TEST(Rivers, ANetworkFillsAPolygon) {
    Workplace const place;
    std::string const recipe = "[network]\nsource = \"tokunaga\"\n[network.tokunaga]\norder = 3\nregion = "
                               "\"region.geojson\"\n[surface]\n";
    place.write("r.toml", recipe);
    auto const region = [&](std::string const& features) { place.write("region.geojson", geojson(features)); };
    region(test::feature("Polygon", "[" + ring + "]"));
    json const report = made(place, "r.toml");
    EXPECT_EQ(report["network"]["tokunaga"]["dropped"], 0);
    EXPECT_TRUE(fs::exists(place / "out/inputs/region/region.geojson"));
    expect_run(place, "replay out --verify", 0);

    expect_refused(place, "make r.toml -o no --set",
                   {"grid.width=20 --set grid.height=20", "network.tokunaga.strokes=region.geojson",
                    "network.source=dla", "network.tokunaga.region=none.geojson"});
    std::string const hole = ",[[501000,4001000],[501500,4001000],[501500,4001500],[501000,4001000]]";
    std::string const bow = "[[[500000,4000000],[503000,4003000],[503000,4000000],[500000,4003000],[500000,4000000]]]";
    for (std::string const& wrong :
         {test::feature("Polygon", "[" + ring + "]") + "," + test::feature("Polygon", "[" + ring + "]"),
          test::feature("Polygon", "[" + ring + hole + "]"), test::feature("Polygon", bow)}) {
        region(wrong);
        expect_refused(place, "make r.toml -o no", {""});
    }
}

TEST(Rivers, PatchesLieOneOverTheOther) {
    Workplace const place;
    std::string const land = "seed = 7\n[grid]\nwidth = 160\nheight = 160\n[network]\nsource = \"tokunaga\"\n"
                             "[network.tokunaga]\norder = 3\n[surface]\nmethod = \"diffuse\"\n";
    std::string const patch =
        "[[patch]]\nsource = \"" + samples + "bigtujunga_srtm1.tif\"\nwindow = [10, 10, 40, 30]\n";
    place.write("two.toml",
                land + patch + "at = [501500, 4998500]\n" + patch + "at = [502400, 4997900]\nrotate = 30\n");
    json const two = made(place, "two.toml", "two");
    EXPECT_EQ(two["patches"].size(), 2U);
    expect_run(place, "replay two --verify", 0);

    place.write("replace.toml", land + patch + "at = [502400, 4997600]\nrivers = \"replace\"\n");
    json const replaced = made(place, "replace.toml", "replaced");
    EXPECT_EQ(replaced["patches"][0]["kept"], 0);
    EXPECT_GT(replaced["certificate"]["waived_cells"], 0); // under the patch, and of rivers that came through it
    expect_run(place, "check replaced --dem replaced/dem.tif", 0);
    expect_run(place, "check replaced/network.gpkg --dem replaced/dem.tif", 3); // without the folder's recipe
    place.write("keep.toml", land + patch + "at = [502400, 4997600]\n");
    json const kept = made(place, "keep.toml", "kept");
    EXPECT_GT(kept["patches"][0]["kept"], 0);

    auto const with_mask = [&](std::string const& coordinates) {
        place.write("mask.geojson", geojson(test::feature("Polygon", "[" + coordinates + "]")));
        place.write("mask.toml", land + patch + "at = [502400, 4997600]\nmask = \"mask.geojson\"\n");
    };
    with_mask("[[502200,4997500],[502600,4997500],[502600,4997700],[502200,4997500]]");
    json const masked = made(place, "mask.toml", "masked");
    EXPECT_LT(masked["patches"][0]["cells"], kept["patches"][0]["cells"]);
    EXPECT_TRUE(fs::exists(place / "masked/inputs/patch1/mask/mask.geojson"));
    expect_run(place, "replay masked --verify", 0);

    for (std::string const away : {"[[1,1],[2,1],[2,2],[1,1]]", // off the patch, or without a cell's centre
                                   "[[502205,4997501],[502206,4997501],[502206,4997502],[502205,4997501]]"}) {
        with_mask(away);
        expect_refused(place, "make mask.toml -o no", {""});
    }
    place.write("away.toml", land + patch + "at = [900000, 1]\n");
    place.write("none.toml", land + "[[patch]]\nsource = \"none.tif\"\n");
    expect_refused(place, "make -o no", {"away.toml", "none.toml"});
}

TEST(Rivers, StrokesThatCannotBeUsedAreRefused) {
    Workplace const place;
    place.write("r.toml", strokes_recipe);
    std::string const good = stroke("[503000,4000300],[503000,4004500]");
    std::vector<std::string> wrong{
        stroke("[501000,4002000],[505000,4002000]"), stroke("[501000,4002000],[507000,4002000]"),
        stroke("[501000,4002000],[501000,4002000]"), stroke("[501000,4002000],[503000,4003000]"),
        stroke("[501000,4002000],[501000,4004000]", "\"rosgen\":\"Q\"")};
    for (std::string const lambda : {"0", "-1", "51", "2.5"}) {
        wrong.push_back(stroke("[501000,4002000],[501000,4004000]", "\"lambda\":" + lambda));
    }
    for (std::string const& second : wrong) {
        place.write("s.geojson", geojson(good + "," + second));
        expect_refused(place, "make r.toml -o out", {""});
    }
    place.write("s.geojson", geojson(""));
    expect_refused(place, "make r.toml -o out", {""});
    fs::remove(place / "s.geojson");
    expect_refused(place, "make r.toml -o out", {""});
}

TEST(Rivers, OneStrokeAloneHasRidgesOnlyBetweenItsStreams) {
    Workplace const place;
    place.write("r.toml", strokes_recipe + "[skeleton]\nridges = \"voronoi\"\n");
    place.write("s.geojson", geojson(stroke("[503000,4000300],[503000,4000900]", "\"lambda\":1")));
    json const report = made(place, "r.toml --set network.tokunaga.order=1 --set surface.method=diffuse");
    EXPECT_EQ(report["network"]["arcs"], 3); // one refinement at least
    EXPECT_GT(report["ridges"]["count"], 0);
    // Of a single link, with nothing beside it, there is no ridge.
    json const lone = made(place,
                           samples + "tokunaga.toml --set network.tokunaga.order=1 --set grid.width=60 --set "
                                     "grid.height=60 --set skeleton.ridges=voronoi",
                           "lone");
    EXPECT_FALSE(lone.contains("ridges"));
    EXPECT_EQ(features_in(place / "lone/network.gpkg", "ridges"), -1);
}

TEST(Rivers, LinksWithoutRoomAreWarnedOfOrRefused) {
    Workplace const place;
    std::string const base = samples + "tokunaga.toml --set network.tokunaga.order=";
    expect_refused(place, "make -o no " + base,
                   {"9 --set grid.width=64 --set grid.height=64", "5 --set grid.width=1 --set grid.height=1",
                    "4 --set grid.width=2 --set grid.height=2", "5 --set grid.width=1 --set grid.height=90",
                    "4 --set grid.width=80 --set grid.height=80", "2 --set grid.width=300 --set grid.height=1", "13",
                    "0", "3 --set network.tokunaga.generator=0", "3 --set network.tokunaga.generator=51"});
    made(place, base + "1 --set grid.width=2 --set grid.height=2", "two");
    made(place, base + "1 --set grid.width=1 --set grid.height=1", "one");

    // Every cell of a single column lies on the border: the river is drawn, and the certificate tells.
    expect_run(place, "make " + base + "2 --set grid.width=1 --set grid.height=300 -q -o column", 3);
    json const columns = report_of(place / "column");
    for (auto const& check : columns["checks"]) {
        EXPECT_EQ(check["ok"].get<bool>(), check["name"] != "border_cells") << check;
    }

    // A stroke so short that its many branches have no room beside it.
    place.write("r.toml", strokes_recipe);
    place.write("s.geojson", geojson(stroke("[503000,4000300],[503000,4005700]", "\"lambda\":2") + "," +
                                     stroke("[500300,4001000],[500300,4001300]", "\"lambda\":20")));
    expect_run(place, "make r.toml -o out", 0, "warning: [network.tokunaga]: ");
}

} // namespace rivers_test
