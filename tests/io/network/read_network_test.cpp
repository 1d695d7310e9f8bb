// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/read_network.hpp>

#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/write_network.hpp>

#include "sample_networks.hpp"
#include "scratch_folder.hpp"

namespace read_network_test {

using namespace thalweg;

namespace {

using test::has;
using test::message_of;

std::string refusal(std::string const& path) {
    return message_of<BadInput>([&] { io::read_network(path); });
}

// A GeoPackage of Y shape, changed by SQL.
std::string changed(ScratchFolder const& folder, std::vector<std::string> const& statements) {
    SampleNetwork const sample = y_shape();
    std::string const path = folder / "net.gpkg";
    io::write_geopackage(sample.tables(), path);
    std::unique_ptr<GDALDataset> const dataset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
    for (std::string const& statement : statements) {
        dataset->ReleaseResultSet(dataset->ExecuteSQL(statement.c_str(), nullptr, nullptr));
    }
    return path;
}

// A shapefile pair of one node and one arc, whose arc and fields the test makes.
std::string hand_made(ScratchFolder const& folder, OGRwkbGeometryType type, std::string const& arc_wkt,
                      std::function<void(OGRFeature&)> const& fill, OGRFieldType id_type = OFTInteger) {
    GDALAllRegister();
    auto* const driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    std::string const path = folder / "hand.gpkg";
    std::unique_ptr<GDALDataset> const dataset(driver->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    auto const feature_in = [&](char const* name, OGRwkbGeometryType layer_type, std::vector<char const*> const& fields,
                                std::string const& wkt, std::function<void(OGRFeature&)> const& set) {
        OGRLayer& layer = *dataset->CreateLayer(name, nullptr, layer_type, nullptr);
        for (char const* const field_name : fields) {
            OGRFieldDefn field(field_name, id_type);
            layer.CreateField(&field);
        }
        OGRFeature feature(layer.GetLayerDefn());
        for (int i = 0; i < feature.GetFieldCount(); ++i) {
            feature.SetField(i, 1);
        }
        set(feature);
        OGRGeometry* shape = nullptr;
        OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &shape);
        feature.SetGeometryDirectly(shape);
        EXPECT_EQ(layer.CreateFeature(&feature), OGRERR_NONE);
    };
    feature_in("nodes", wkbPoint25D, {"node_id"}, "POINT Z (0 0 0)", [](OGRFeature&) {});
    feature_in("arcs", type, {"arc_id", "from_node", "to_node", "ds_arc", "strahler", "shreve", "basin_id"}, arc_wkt,
               fill);
    return path;
}

void leave(OGRFeature& /*feature*/) {}

} // namespace

TEST(ReadNetwork, MissingFileAndEmptyFolder) {
    ScratchFolder const folder;
    EXPECT_TRUE(has(refusal(folder / "none.gpkg"), "does not exist"));
    EXPECT_TRUE(has(refusal(folder.path().string()), "0 files NAME_arcs.shp"));
    std::ofstream(folder / "text.gpkg") << "no network";
    EXPECT_TRUE(has(refusal(folder / "text.gpkg"), "cannot be read"));
    std::ofstream(folder / "rivers.shp") << "no network";
    EXPECT_TRUE(has(refusal(folder / "rivers.shp"), "neither NAME_arcs.shp nor NAME_nodes.shp"));
}

TEST(ReadNetwork, EveryNameOfANetworkReadsTheSame) {
    ScratchFolder const folder;
    SampleNetwork const sample = two_basins();
    std::filesystem::create_directory(folder / "both");
    std::filesystem::create_directory(folder / "shapes");
    io::write_geopackage(sample.tables(), folder / "both/network.gpkg");
    io::write_shapefiles(sample.tables(), folder / "shapes/net");
    for (std::string const name :
         {"both", "both/network.gpkg", "shapes", "shapes/net_arcs.shp", "shapes/net_nodes.shp"}) {
        NetworkFile const file = io::read_network(folder / name);
        ASSERT_EQ(file.nodes.size(), 8U) << name;
        ASSERT_EQ(file.arcs.size(), 6U) << name;
        EXPECT_EQ(file.arcs[3].strahler, 2);
        EXPECT_EQ(file.arcs[3].shreve, 3);
        EXPECT_EQ(file.arcs[3].from_node, 3);
        EXPECT_EQ(file.arcs[3].to_node, 2);
        EXPECT_EQ(file.arcs[3].ds_arc, 5);
        EXPECT_EQ(file.arcs[5].basin, 2);
        EXPECT_EQ(file.arcs[5].line.back(), (Vec3{1000.1, 0.0, 3.0}));
    }
    io::write_shapefiles(sample.tables(), folder / "shapes/second");
    EXPECT_TRUE(has(refusal(folder / "shapes"), "2 files"));
    std::filesystem::remove(folder / "shapes/net_nodes.shp");
    EXPECT_TRUE(has(refusal(folder / "shapes/net_arcs.shp"), "net_nodes.shp does not exist"));
}

TEST(ReadNetwork, BadNumbersInAFileAreReadAsTheyStand) {
    ScratchFolder const folder;
    NetworkFile const file = io::read_network(
        changed(folder, {"UPDATE arcs SET ds_arc = 99, strahler = -7", "UPDATE nodes SET node_id = 1"}));
    EXPECT_EQ(file.arcs[0].ds_arc, 99);
    EXPECT_EQ(file.arcs[0].strahler, -7);
    EXPECT_EQ(file.nodes[3].id, 1);
}

TEST(ReadNetwork, MissingLayerAndMissingFieldsAreNamed) {
    ScratchFolder const one;
    EXPECT_TRUE(has(refusal(changed(one, {"DROP TABLE nodes"})), "no layer nodes"));
    ScratchFolder const two;
    EXPECT_TRUE(has(refusal(changed(two, {"ALTER TABLE arcs DROP COLUMN ds_arc",
                                          "ALTER TABLE arcs RENAME COLUMN shreve TO magnitude"})),
                    "layer arcs: no field ds_arc, shreve"));
}

TEST(ReadNetwork, NumbersMustBeThereAndWhole) {
    ScratchFolder const none;
    EXPECT_TRUE(has(refusal(hand_made(none, wkbLineString25D, "LINESTRING Z (0 0 1, 1 1 0)",
                                      [](OGRFeature& f) { f.SetFieldNull(f.GetFieldIndex("to_node")); })),
                    "feature 1 has no to_node"));
    ScratchFolder const half;
    EXPECT_TRUE(has(refusal(hand_made(
                        half, wkbLineString25D, "LINESTRING Z (0 0 1, 1 1 0)",
                        [](OGRFeature& f) { f.SetField("strahler", 1.5); }, OFTReal)),
                    "strahler 1.5, not a whole number"));
    ScratchFolder const text;
    EXPECT_TRUE(has(refusal(hand_made(text, wkbLineString25D, "LINESTRING Z (0 0 1, 1 1 0)", leave, OFTString)),
                    "arc_id holds text, which is read as numbers"));
    ScratchFolder const whole;
    EXPECT_EQ(io::read_network(hand_made(
                                   whole, wkbLineString25D, "LINESTRING Z (0 0 1, 1 1 0)",
                                   [](OGRFeature& f) { f.SetField("strahler", 3.0); }, OFTReal))
                  .arcs[0]
                  .strahler,
              3);
}

TEST(ReadNetwork, ShapesMustBeLinesWithZ) {
    ScratchFolder const flat;
    EXPECT_TRUE(has(refusal(hand_made(flat, wkbLineString, "LINESTRING (0 0, 1 1)", leave)), "has no heights (Z)"));
    ScratchFolder const polygon;
    EXPECT_TRUE(has(refusal(hand_made(polygon, wkbPolygon25D, "POLYGON Z ((0 0 0, 1 1 0, 1 0 0, 0 0 0))", leave)),
                    "is not a line"));
    ScratchFolder const parts;
    EXPECT_TRUE(has(
        refusal(hand_made(parts, wkbMultiLineString25D, "MULTILINESTRING Z ((0 0 1, 1 1 0), (2 2 1, 3 3 0))", leave)),
        "has 2 parts"));
    ScratchFolder const one;
    EXPECT_EQ(io::read_network(hand_made(one, wkbMultiLineString25D, "MULTILINESTRING Z ((0 0 1, 1 1 0))", leave))
                  .arcs[0]
                  .line,
              (std::vector<Vec3>{{0, 0, 1}, {1, 1, 0}}));
    ScratchFolder const empty;
    EXPECT_TRUE(io::read_network(hand_made(empty, wkbLineString25D, "LINESTRING Z EMPTY", leave)).arcs[0].line.empty());
}

TEST(ReadNetwork, DamagedFileIsNotReadInPart) {
    SampleNetwork sample;
    auto below = sample.node(0.0, 0.0, 0.0);
    for (int i = 1; i < 3000; ++i) {
        auto const above = sample.node(i * 1.5, i * 0.5, i);
        sample.arc(above, below);
        below = above;
    }
    sample.settle();
    ScratchFolder const folder;
    std::string const path = folder / "net.gpkg";
    io::write_geopackage(sample.tables(), path);
    auto const size = std::filesystem::file_size(path);
    int refused = 0;
    for (double const share : {0.2, 0.3, 0.4, 0.5, 0.6}) {
        std::string const copy = folder / "damaged.gpkg";
        std::filesystem::copy_file(path, copy, std::filesystem::copy_options::overwrite_existing);
        std::fstream file(copy, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(share * static_cast<double>(size)) / 4096 * 4096);
        file << std::string(3 * 4096, '\x55');
        file.close();
        try {
            NetworkFile const read = io::read_network(copy);
            EXPECT_EQ(read.arcs.size(), 2999U);
            EXPECT_EQ(read.nodes.size(), 3000U);
        } catch (Error const&) {
            ++refused;
        }
    }
    EXPECT_GE(refused, 2);
    std::filesystem::resize_file(path, size / 2);
    EXPECT_THROW(io::read_network(path), Error);
}

} // namespace read_network_test
