// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/tiff.hpp>
#include <io/vector_files.hpp>
#include <support.hpp>

#include "command.hpp"

namespace samples_test {

namespace fs = std::filesystem;

namespace {

struct FileArc {
    GIntBig from;
    GIntBig to;
    GIntBig downstream;
    std::vector<double> z;
};

std::map<GIntBig, FileArc> read_arcs(OGRLayer* layer) {
    std::map<GIntBig, FileArc> arcs;
    for (auto const& feature : layer) {
        FileArc arc{feature->GetFieldAsInteger64("from_node"),
                    feature->GetFieldAsInteger64("to_node"),
                    feature->GetFieldAsInteger64("ds_arc"),
                    {}};
        for (auto const& point : *feature->GetGeometryRef()->toLineString()) {
            arc.z.push_back(point.getZ());
        }
        EXPECT_TRUE(arcs.emplace(feature->GetFieldAsInteger64("arc_id"), std::move(arc)).second);
    }
    return arcs;
}

/// The whole of what a sample must leave, read with GDAL and OGR alone.
void hold_to_contract(fs::path const& folder) {
    auto const report = report_of(folder);
    expect_checks_hold(report);
    auto const gpkg = opened(folder / "network.gpkg");
    ASSERT_TRUE(gpkg);
    OGRLayer* const layer = gpkg->GetLayerByName("arcs");
    ASSERT_NE(layer, nullptr);
    EXPECT_EQ(wkbFlatten(layer->GetGeomType()), wkbLineString);
    EXPECT_TRUE(wkbHasZ(layer->GetGeomType()));
    ASSERT_NE(layer->GetSpatialRef(), nullptr);
    EXPECT_TRUE(layer->GetSpatialRef()->IsProjected());
    std::map<GIntBig, FileArc> const arcs = read_arcs(layer);
    EXPECT_EQ(arcs.size(), report["network"]["arcs"].get<std::size_t>());

    std::set<GIntBig> nodes;
    std::size_t outlets = 0;
    for (auto const& [id, arc] : arcs) {
        nodes.insert(arc.from);
        nodes.insert(arc.to);
        outlets += arc.downstream == 0;
        if (arc.downstream != 0) {
            ASSERT_TRUE(arcs.count(arc.downstream)) << id;
            EXPECT_EQ(arcs.at(arc.downstream).from, arc.to);
        }
        for (std::size_t i = 1; i < arc.z.size(); ++i) {
            EXPECT_LE(arc.z[i], arc.z[i - 1]) << "arc " << id;
        }
        EXPECT_GT(arc.z.front(), arc.z.back()) << "arc " << id;
        std::set<GIntBig> seen{id};
        for (GIntBig at = arc.downstream; at != 0; at = arcs.at(at).downstream) {
            ASSERT_TRUE(seen.insert(at).second) << "arc " << id << " runs in a circle";
        }
    }
    EXPECT_EQ(nodes.size(), gpkg->GetLayerByName("nodes")->GetFeatureCount());
    EXPECT_EQ(nodes.size(), arcs.size() + report["network"]["outlets"].get<std::size_t>()) << "V = E + 1 a basin";
    EXPECT_GE(outlets, report["network"]["outlets"].get<std::size_t>());

    auto const shape = opened(folder / "network_arcs.shp");
    ASSERT_TRUE(shape);
    std::map<GIntBig, FileArc> const same = read_arcs(shape->GetLayer(0));
    ASSERT_EQ(same.size(), arcs.size());
    for (auto const& [id, arc] : same) {
        EXPECT_EQ(arc.z, arcs.at(id).z) << "arc " << id;
    }

    auto const dem = opened(folder / "dem.tif");
    auto const network = opened(folder / "network.tif");
    ASSERT_TRUE(dem && network);
    EXPECT_EQ(dem->GetRasterXSize(), report["recipe"]["grid"]["width"].get<int>());
    EXPECT_EQ(network->GetRasterYSize(), dem->GetRasterYSize());
    EXPECT_STREQ(dem->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
    EXPECT_STREQ(dem->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
    EXPECT_EQ(dem->GetRasterBand(1)->GetRasterDataType(), GDT_Float32);
    int has_nodata = 0;
    dem->GetRasterBand(1)->GetNoDataValue(&has_nodata);
    EXPECT_EQ(has_nodata, 1);
    ASSERT_NE(dem->GetSpatialRef(), nullptr);
    EXPECT_TRUE(dem->GetSpatialRef()->IsSame(layer->GetSpatialRef()));

    for (char const* name : {"report.html", "map.png", "profile.svg", "wireframe.svg", "sections.svg", "contours.gpkg",
                             "recipe.toml", "network_nodes.shp", "project.qgz", "dem.qml"}) {
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    }
    EXPECT_EQ(fs::exists(folder / "curve.svg"), report["recipe"]["surface"]["method"] == "dilate");
    EXPECT_LT(fs::file_size(folder / "wireframe.svg"), 2'000'000U);
}

void same_bytes(fs::path const& a, fs::path const& b) {
    for (char const* name :
         {"dem.tif", "network.tif", "network.gpkg", "network_arcs.shp", "network_arcs.dbf", "network_arcs.shx",
          "network_nodes.shp", "network_nodes.dbf", "contours.gpkg", "catchments.gpkg", "map.png", "profile.svg",
          "wireframe.svg", "sections.svg", "recipe.toml", "project.qgz", "dem.qml"}) {
        EXPECT_FALSE(file_bytes(a / name).empty()) << name;
        EXPECT_TRUE(file_bytes(a / name) == file_bytes(b / name)) << name;
    }
}

void sample(std::string const& name) {
    Workplace const place;
    std::string const recipe = samples + name + ".toml";
    expect_run(place, "make " + recipe + " -o one --threads 1", 0);
    expect_run(place, "make " + recipe + " -o two --threads 2", 0);
    hold_to_contract(place / "one");
    same_bytes(place / "one", place / "two");
    expect_run(place, "replay one --verify", 0);
    expect_run(place, "check one", 0);
}

} // namespace

TEST(Samples, AreMadeAgainWithAnyNumberOfThreads) {
    for (char const* name : {"dla", "lines", "relief_tokunaga", "relief_lines", "island"}) {
        SCOPED_TRACE(name);
        sample(name);
    }
}

TEST(Samples, NoArgumentsMakeTheSampleValley) {
    Workplace const place;
    expect_run(place, "make -q", 0);
    expect_run(place, "make " + samples + "relief.toml -o sample -q", 0);
    same_bytes(place / "valley", place / "sample");
}

TEST(Samples, DefaultsYieldToTheKeysThatReplaceThem) {
    Workplace const place;
    std::string const small_forest = "make --set grid.width=96 --set grid.height=96 --set network.forest.seeds=3 ";
    expect_run(place, small_forest + "--dry-run", 0);
    expect_run(place, small_forest + "--set network.forest.outlet_spacing=40 --dry-run", 2);
}

TEST(Samples, EveryIncrementAndMetric) {
    Workplace const place;
    for (char const* increment : {"uniform", "decreasing", "rise_fall", "'3-0.01*x'"}) {
        for (char const* metric : {"cityblock", "euclid"}) {
            expect_run(
                place,
                std::string("make --set grid.width=120 --set grid.height=90 "
                            "--set network.dla.particles=2000 --set network.prune=20 --set surface.method=dilate "
                            "--set surface.metric=") +
                    metric + " --set surface.increment=" + increment + " --overwrite -o out -q",
                0);
            hold_to_contract(place / "out");
        }
    }
}

TEST(Samples, EveryBranchAndHeight) {
    Workplace const place;
    for (char const* branch : {"largest", "north", "east", "south", "west", "all"}) {
        for (char const* heights : {"straight_repaired", "along_stream"}) {
            expect_run(place,
                       std::string("make --set network.dla.particles=3000 --set network.prune=8 "
                                   "--set surface.method=dilate --set network.dla.branch=") +
                           branch + " --set network.heights=" + heights + " --overwrite -o out -q",
                       0);
            hold_to_contract(place / "out");
        }
    }
}

TEST(Samples, EvenSlopesInEquilibriumTerrainStandOnWalls) {
    Workplace const place;
    expect_run(place,
               "make --set network.dla.particles=3000 --set network.prune=8 "
               "--set network.heights=along_stream -o out",
               3, "river cells stand on walls");
    auto const report = report_of(place / "out");
    for (auto const& check : report["checks"]) {
        EXPECT_EQ(check["ok"].get<bool>(), check["name"] != "walled_cells") << check;
    }
}

TEST(Samples, WithoutASurfaceOnlyTheNetworkIsMade) {
    Workplace const place;
    place.write("r.toml", "[network]\nprune = 6\n[network.dla]\nparticles = 3000\nbranch = \"south\"\n");
    auto const report = expect_run(place, "make r.toml -o out -q --json", 0).json();
    EXPECT_FALSE(report.contains("dem"));
    EXPECT_EQ(report["network"]["area_from"], "nearest");
    EXPECT_TRUE(fs::exists(place / "out/network.gpkg"));
    EXPECT_TRUE(fs::exists(place / "out/profile.svg"));
    EXPECT_FALSE(fs::exists(place / "out/dem.tif"));
    EXPECT_FALSE(fs::exists(place / "out/map.png"));
    expect_run(place, "replay out", 0);
}

namespace {

/// Two rivers with heights that meet, in UTM zone 31: from the north-west and the north-east, leaving to the south.
std::string const rivers_with_heights =
    test::geojson(test::line("[500000,5002000,90],[500700,5001300,70],[501000,5001000,50]") + "," +
                  test::line("[502000,5002000,95],[501000,5001000,50]") + "," +
                  test::line("[501000,5000000,10],[501000,5001000,50]"));

std::string lines_recipe(std::string const& grid, std::string const& surface) {
    return "[grid]\ncell = 20\n" + grid + "[network]\nsource = \"lines\"\n[network.lines]\npath = \"r.geojson\"\n" +
           "[surface]\n" + surface;
}

} // namespace

TEST(Samples, HeightsOfTheFileAreKeptAndTheOutletGoesOnDown) {
    Workplace const place;
    place.write("r.geojson", rivers_with_heights);
    place.write("r.toml", lines_recipe("", ""));
    auto const report = expect_run(place, "make r.toml -o out -q --json", 0).json();
    hold_to_contract(place / "out");
    EXPECT_EQ(report["recipe"]["network"]["heights"], "file");
    auto const gpkg = opened(place / "out/network.gpkg");
    std::set<double> heights;
    double lowest = 1e9;
    for (auto const& [id, arc] : read_arcs(gpkg->GetLayerByName("arcs"))) {
        heights.insert(arc.z.begin(), arc.z.end());
        lowest = std::min(lowest, arc.z.back());
    }
    for (double const z : {90.0, 70.0, 50.0, 95.0, 10.0}) {
        EXPECT_EQ(heights.count(z), 1U) << z;
    }
    EXPECT_LT(lowest, 10.0);
    expect_run(place, "replay out", 0);
}

TEST(Samples, ClippedRiversAndAMask) {
    Workplace const place;
    place.write("r.geojson", rivers_with_heights);
    std::string const grid = "width = 60\nheight = 60\norigin = [500400, 5001600]\n";
    place.write("r.toml", lines_recipe(grid, ""));
    expect_run(place, "make r.toml -o out -q", 2);
    place.write("r.toml", lines_recipe(grid + "clip = true\n", ""));
    expect_run(place, "make r.toml -o out -q", 0);
    hold_to_contract(place / "out");

    // A mask that leaves out the outermost column in the east, where no river runs.
    written((place / "mask.tif").string(),
            {.width = 60, .height = 60, .epsg = 0, .frame = {500400, 20, 0, 5001600, 0, -20}},
            [](int col, int row) { return col == 59 && row > 20 ? 0.0 : 1.0; });
    place.write("r.toml", lines_recipe(grid + "clip = true\n", "mask = \"mask.tif\"\n"));
    Outcome const masked = expect_run(place, "make r.toml --set network.heights=graded -o masked -q --json", 0);
    EXPECT_EQ(masked.json()["dem"]["nodata"], 39);
    hold_to_contract(place / "masked");
    expect_run(place, "replay masked", 0);
}

TEST(Samples, AFolderOfShapefilesIsKeptWhole) {
    Workplace const place;
    place.write("r.geojson", rivers_with_heights);
    place.shell("ogr2ogr rivers r.geojson -nln rivers");
    place.write("r.toml", "[grid]\ncell = 20\n[network]\nsource = \"lines\"\n[network.lines]\npath = \"rivers\"\n");
    expect_run(place, "make r.toml -o folder -q", 0);
    EXPECT_TRUE(fs::exists(place / "folder/inputs/rivers/rivers.dbf"));
    expect_run(place, "replay folder", 0);
    place.write("r.toml",
                "[grid]\ncell = 20\n[network]\nsource = \"lines\"\n[network.lines]\npath = \"rivers/rivers.shp\"\n");
    expect_run(place, "make r.toml -o file -q", 0);
    EXPECT_TRUE(fs::exists(place / "file/inputs/rivers.prj"));
    expect_run(place, "replay file", 0);
}

} // namespace samples_test
