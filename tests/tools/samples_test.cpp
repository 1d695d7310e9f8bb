// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <ogrsf_frmts.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

struct FileArc {
    GIntBig from;
    GIntBig to;
    GIntBig downstream;
    std::vector<double> z;
};

GDALDatasetUniquePtr open(fs::path const& path, unsigned kind) {
    GDALAllRegister();
    return GDALDatasetUniquePtr(GDALDataset::Open(path.string().c_str(), kind | GDAL_OF_READONLY));
}

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
    auto const report = nlohmann::json::parse(file_bytes(folder / "report.json"));
    for (auto const& check : report["checks"]) {
        EXPECT_TRUE(check["ok"].get<bool>()) << check;
    }
    auto const gpkg = open(folder / "network.gpkg", GDAL_OF_VECTOR);
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

    auto const shape = open(folder / "network_arcs.shp", GDAL_OF_VECTOR);
    ASSERT_TRUE(shape);
    std::map<GIntBig, FileArc> const same = read_arcs(shape->GetLayer(0));
    ASSERT_EQ(same.size(), arcs.size());
    for (auto const& [id, arc] : same) {
        EXPECT_EQ(arc.z, arcs.at(id).z) << "arc " << id;
    }

    auto const dem = open(folder / "dem.tif", GDAL_OF_RASTER);
    auto const network = open(folder / "network.tif", GDAL_OF_RASTER);
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

    for (char const* name :
         {"map.png", "profile.svg", "curve.svg", "contours.gpkg", "recipe.toml", "network_nodes.shp"}) {
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    }
}

void same_bytes(fs::path const& a, fs::path const& b) {
    for (char const* name : {"dem.tif", "network.tif", "network.gpkg", "network_arcs.shp", "network_arcs.dbf",
                             "network_arcs.shx", "network_nodes.shp", "network_nodes.dbf", "contours.gpkg", "map.png",
                             "profile.svg", "curve.svg", "recipe.toml"}) {
        EXPECT_FALSE(file_bytes(a / name).empty()) << name;
        EXPECT_TRUE(file_bytes(a / name) == file_bytes(b / name)) << name;
    }
}

void sample(std::string const& name) {
    Workplace const place;
    std::string const recipe = THALWEG_SOURCE_DIR "/samples/" + name + ".toml";
    Outcome const one = thalweg_run("make " + recipe + " -o one --threads 1", place.path());
    ASSERT_EQ(one.code, 0) << one.err;
    Outcome const two = thalweg_run("make " + recipe + " -o two --threads 2", place.path());
    ASSERT_EQ(two.code, 0) << two.err;
    hold_to_contract(place / "one");
    same_bytes(place / "one", place / "two");
    Outcome const replay = thalweg_run("replay one --verify", place.path());
    EXPECT_EQ(replay.code, 0) << replay.out << replay.err;
    Outcome const check = thalweg_run("check one", place.path());
    EXPECT_EQ(check.code, 0) << check.out << check.err;
}

} // namespace

TEST(Samples, Dla) {
    sample("dla");
}

TEST(Samples, Lines) {
    sample("lines");
}

TEST(Samples, NoArgumentsMakeTheSampleValley) {
    Workplace const place;
    ASSERT_EQ(thalweg_run("make -q", place.path()).code, 0);
    ASSERT_EQ(thalweg_run("make " THALWEG_SOURCE_DIR "/samples/dla.toml -o sample -q", place.path()).code, 0);
    same_bytes(place / "valley", place / "sample");
}

TEST(Samples, EveryIncrementAndMetric) {
    Workplace const place;
    for (char const* increment : {"uniform", "decreasing", "rise_fall", "'3-0.01*x'"}) {
        for (char const* metric : {"cityblock", "euclid"}) {
            Outcome const o =
                thalweg_run(std::string("make --set grid.width=120 --set grid.height=90 "
                                        "--set network.dla.particles=2000 --set surface.relief=0 "
                                        "--set surface.metric=") +
                                metric + " --set surface.increment=" + increment + " --overwrite -o out -q",
                            place.path());
            EXPECT_EQ(o.code, 0) << o.err;
            hold_to_contract(place / "out");
        }
    }
}

TEST(Samples, EveryBranchAndHeight) {
    Workplace const place;
    for (char const* branch : {"largest", "north", "east", "south", "west", "all"}) {
        for (char const* heights : {"straight_repaired", "along_stream"}) {
            Outcome const o = thalweg_run(std::string("make --set network.dla.particles=3000 --set network.prune=8 ") +
                                              "--set network.dla.branch=" + branch +
                                              " --set network.heights=" + heights + " --overwrite -o out -q",
                                          place.path());
            EXPECT_EQ(o.code, 0) << branch << o.err;
            hold_to_contract(place / "out");
        }
    }
}

TEST(Samples, FrameLeftOutReplaysToTheSameBytes) {
    Workplace const place;
    place.write("r.toml", "[network]\nprune = 6\n[network.dla]\nparticles = 3000\nbranch = \"south\"\n[surface]\n");
    ASSERT_EQ(thalweg_run("make r.toml -o out -q", place.path()).code, 0);
    EXPECT_EQ(thalweg_run("replay out", place.path()).code, 0);
}
