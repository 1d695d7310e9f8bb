// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/write_network.hpp>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/read_network.hpp>

#include "full_disk.hpp"
#include "sample_networks.hpp"
#include "scratch_folder.hpp"
#include "vector_files.hpp"

namespace write_network_test {

using namespace thalweg;

namespace {

using test::error_of;
using Opened = std::unique_ptr<GDALDataset>;

// A network in both formats, its layers by name.
class Written {
public:
    explicit Written(SampleNetwork const& sample) {
        io::write_geopackage(sample.tables(), folder_ / "net.gpkg");
        io::write_shapefiles(sample.tables(), folder_ / "net");
    }
    std::vector<Opened> both(std::string const& layer) const {
        std::vector<Opened> files;
        files.push_back(opened(folder_ / "net.gpkg"));
        files.push_back(opened(folder_ / ("net_" + layer + ".shp")));
        return files;
    }
    static OGRLayer& layer(GDALDataset& dataset, std::string const& name) {
        OGRLayer* const found = dataset.GetLayerByName(name.c_str());
        return found != nullptr ? *found : *dataset.GetLayer(0);
    }
    ScratchFolder const& folder() const { return folder_; }

private:
    ScratchFolder folder_;
};

std::string const arc_fields = "arc_id:i from_node:i to_node:i ds_arc:i n_up:i basin_id:i topo_ord:i strahler:i "
                               "shreve:i hack:i length:r length_3d:r straight:r z_up:r z_down:r dist_out:r slope:r "
                               "us_area:r ds_area:r survives:r feature:l type:s braided:i given:i ";
std::string const node_fields = "node_id:i kind:s deg_in:i deg_out:i basin_id:i strahler:i z:r area:r dist_out:r ";

std::string fields_of(OGRLayer& layer) {
    std::string text;
    for (int i = 0; i < layer.GetLayerDefn()->GetFieldCount(); ++i) {
        auto const* field = layer.GetLayerDefn()->GetFieldDefn(i);
        char const type = field->GetType() == OFTInteger     ? 'i'
                          : field->GetType() == OFTInteger64 ? 'l'
                          : field->GetType() == OFTReal      ? 'r'
                          : field->GetType() == OFTString    ? 's'
                                                             : '?';
        text += std::string(field->GetNameRef()) + ":" + type + " ";
    }
    return text;
}

void expect_no_nulls(OGRLayer& layer) {
    for (auto const& feature : layer) {
        ASSERT_NE(feature->GetGeometryRef(), nullptr);
        for (int i = 0; i < feature->GetFieldCount(); ++i) {
            EXPECT_TRUE(feature->IsFieldSetAndNotNull(i))
                << layer.GetName() << " " << feature->GetFID() << " " << feature->GetFieldDefnRef(i)->GetNameRef();
        }
    }
}

} // namespace

TEST(WriteNetwork, RefusalsNameTheirPlace) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    struct Case {
        std::string place;
        std::function<void(SampleNetwork&)> spoil;
    };
    for (auto const& [place, spoil] : {
             Case{"", [](SampleNetwork& net) { (net = {}).settle(); }},
             Case{"node 5 at (7.5, 8.5)", [](SampleNetwork& net) { net.node(7.5, 8.5, 1.0), net.settle(); }},
             Case{"arc 3 ", [](SampleNetwork& net) { net.network.arc_z[2].back() = std::nextafter(4.7, 0.0); }},
             Case{"", [](SampleNetwork& net) { net.us_area_m2.pop_back(); }},
             Case{"arcs 2 has ds_area", [&](SampleNetwork& net) { net.ds_area_m2[1] = nan; }},
             Case{"arcs 1 has", [&](SampleNetwork& net) { net.network.arc_z[0][1] = INFINITY; }},
         }) {
        ScratchFolder const folder;
        SampleNetwork sample = y_shape();
        spoil(sample);
        EXPECT_TRUE(test::has(error_of([&] { io::write_geopackage(sample.tables(), folder / "a.gpkg"); }),
                              "BadInput io.write_", place));
        EXPECT_TRUE(test::has(error_of([&] { io::write_shapefiles(sample.tables(), folder / "a"); }),
                              "BadInput io.write_", place));
        EXPECT_TRUE(place.starts_with("arcs") || folder.entries() == 0) << place; // those are found while writing
    }
    ScratchFolder const folder;
    for (std::string const crs : {"EPSG:1", "http://example.org/crs"}) {
        EXPECT_THROW(io::write_geopackage(y_shape().tables(crs), folder / "net.gpkg"), BadInput);
    }
}

TEST(WriteNetwork, NothingIsOverwritten) {
    ScratchFolder const folder;
    SampleNetwork const sample = y_shape();
    std::ofstream(folder / "net.gpkg") << "mine";
    std::ofstream(folder / "net_nodes.shp") << "mine";
    EXPECT_THROW(io::write_geopackage(sample.tables(), folder / "net.gpkg"), IoError);
    EXPECT_THROW(io::write_shapefiles(sample.tables(), folder / "net"), IoError);
    EXPECT_EQ(bytes_of(folder / "net.gpkg"), "mine");
    EXPECT_EQ(bytes_of(folder / "net_nodes.shp"), "mine");
}

TEST(WriteNetwork, ACrsThatIsLostIsAnError) {
    ScratchFolder const folder;
    std::filesystem::create_directory(folder / "net_arcs.prj"); // GDAL then writes none and says nothing
    EXPECT_THROW(io::write_shapefiles(y_shape().tables(), folder / "net"), IoError);
}

TEST(WriteNetwork, MissingFolderIsAnIoErrorThatNamesThePath) {
    ScratchFolder const folder;
    SampleNetwork const sample = y_shape();
    EXPECT_THROW(io::write_geopackage(sample.tables(), folder / "none/net.gpkg"), IoError);
    EXPECT_TRUE(test::has(error_of([&] { io::write_shapefiles(sample.tables(), folder / "none/net"); }), "IoError",
                          "none/net_arcs.shp"));
}

TEST(WriteNetwork, FullDiskIsAnIoError) {
    ScratchFolder const folder;
    SampleNetwork sample;
    auto below = sample.node(0.0, 0.0, 0.0);
    for (int i = 1; i < 1000; ++i) {
        auto const above = sample.node(i * 1.5, i * 0.5, i);
        sample.arc(above, below);
        below = above;
    }
    sample.settle();
    for (rlim_t const bytes : {100U, 5000U, 50000U}) {
        FullDisk const full(bytes);
        EXPECT_THROW(io::write_geopackage(sample.tables(), folder / ("net" + std::to_string(bytes))), IoError) << bytes;
        EXPECT_THROW(io::write_shapefiles(sample.tables(), folder / ("net" + std::to_string(bytes))), IoError) << bytes;
    }
}

TEST(WriteNetwork, StopsWhenAsked) {
    ScratchFolder const folder;
    EXPECT_THROW(io::write_geopackage(y_shape().tables(), folder / "net.gpkg", test::stopped_run()), Cancelled);
}

TEST(WriteNetwork, FieldsAreTheSchemasInBothFormats) {
    Written const written(two_basins());
    for (auto const& dataset : written.both("arcs")) {
        OGRLayer& arcs = Written::layer(*dataset, "arcs");
        EXPECT_EQ(fields_of(arcs), arc_fields); // none is longer than ten characters
        EXPECT_EQ(arcs.GetGeomType(), wkbLineString25D);
        EXPECT_STREQ(arcs.GetSpatialRef()->GetAuthorityCode(nullptr), "32631");
        expect_no_nulls(arcs);
    }
    for (auto const& dataset : written.both("nodes")) {
        OGRLayer& nodes = Written::layer(*dataset, "nodes");
        EXPECT_EQ(fields_of(nodes), node_fields);
        EXPECT_EQ(nodes.GetGeomType(), wkbPoint25D);
        EXPECT_STREQ(nodes.GetSpatialRef()->GetAuthorityCode(nullptr), "32631");
        expect_no_nulls(nodes);
    }
    EXPECT_EQ(bytes_of(written.folder() / "net_arcs.cpg"), "UTF-8");
    EXPECT_EQ(bytes_of(written.folder() / "net_nodes.cpg"), "UTF-8");
}

TEST(WriteNetwork, ValuesAreTheNetworksInBothFormats) {
    for (SampleNetwork const& sample : {single_arc(), y_shape(), two_basins()}) {
        Written const written(sample);
        for (auto const& dataset : written.both("arcs")) {
            std::size_t a = 0;
            for (auto const& feature : Written::layer(*dataset, "arcs")) {
                auto const whole = [&](char const* name) { return feature->GetFieldAsInteger64(name); };
                auto const real = [&](char const* name) { return feature->GetFieldAsDouble(name); };
                Arc const& arc = sample.network.planform.arc(a);
                auto const& z = sample.network.arc_z[a];
                NodeId const from = sample.network.planform.from(a);
                NodeId const to = sample.network.planform.to(a);
                EXPECT_EQ(whole("arc_id"), static_cast<std::int64_t>(a) + 1);
                EXPECT_EQ(whole("from_node"), static_cast<std::int64_t>(from) + 1);
                EXPECT_EQ(whole("to_node"), static_cast<std::int64_t>(to) + 1);
                EXPECT_EQ(whole("ds_arc"), sample.network.planform.out(to) + 1);
                EXPECT_EQ(whole("n_up"), static_cast<std::int64_t>(sample.network.planform.in(from).size()));
                EXPECT_EQ(whole("basin_id"), sample.orders.arc_basin[a]);
                EXPECT_EQ(whole("topo_ord"), sample.orders.topological[a]);
                EXPECT_EQ(whole("strahler"), sample.orders.strahler[a]);
                EXPECT_EQ(whole("shreve"), sample.orders.shreve[a]);
                EXPECT_EQ(whole("hack"), sample.orders.hack[a]);
                EXPECT_EQ(whole("feature"), arc.feature);
                EXPECT_EQ(whole("braided"), 0);
                EXPECT_EQ(feature->GetFieldAsString("type"), arc.type.empty() ? "none" : arc.type);
                EXPECT_NEAR(real("length"), sample.network.planform.length_m(a), 1e-9);
                EXPECT_NEAR(real("straight"),
                            distance(sample.network.planform.node(from).at, sample.network.planform.node(to).at), 1e-9);
                EXPECT_NEAR(real("z_up"), sample.network.node_z[from], 1e-9);
                EXPECT_NEAR(real("z_down"), sample.network.node_z[to], 1e-9);
                EXPECT_NEAR(real("slope"), (z.front() - z.back()) / sample.network.planform.length_m(a), 1e-15);
                EXPECT_NEAR(real("dist_out"), sample.orders.node_dist_out_m[to], 1e-9);
                EXPECT_NEAR(real("us_area"), sample.us_area_m2[a], 1e-6);
                EXPECT_NEAR(real("ds_area"), sample.ds_area_m2[a], 1e-6);
                EXPECT_EQ(real("survives"), std::isinf(arc.persistence) ? -1.0 : arc.persistence);
                EXPECT_GE(real("length_3d"), real("length"));
                auto const& line = *feature->GetGeometryRef()->toLineString();
                ASSERT_EQ(static_cast<std::size_t>(line.getNumPoints()), arc.line.size());
                double along = 0.0;
                for (int i = 0; i < line.getNumPoints(); ++i) {
                    auto const k = static_cast<std::size_t>(i);
                    EXPECT_EQ(line.getX(i), arc.line[k].x);
                    EXPECT_EQ(line.getY(i), arc.line[k].y);
                    EXPECT_EQ(line.getZ(i), z[k]);
                    if (i > 0) {
                        double const plan = distance(arc.line[k - 1], arc.line[k]);
                        along += std::sqrt(plan * plan + (z[k] - z[k - 1]) * (z[k] - z[k - 1]));
                    }
                }
                EXPECT_NEAR(real("length_3d"), along, 1e-9);
                ++a;
            }
            EXPECT_EQ(a, sample.network.planform.arc_count());
        }
        for (auto const& dataset : written.both("nodes")) {
            NodeId n = 0;
            for (auto const& feature : Written::layer(*dataset, "nodes")) {
                EXPECT_EQ(feature->GetFieldAsInteger64("node_id"), static_cast<std::int64_t>(n) + 1);
                EXPECT_STREQ(feature->GetFieldAsString("kind"), name_of(kind_of(sample.network.planform, n)));
                EXPECT_EQ(feature->GetFieldAsInteger64("deg_in"),
                          static_cast<std::int64_t>(sample.network.planform.in(n).size()));
                EXPECT_EQ(feature->GetFieldAsInteger64("deg_out"), sample.network.planform.out(n) == no_arc ? 0 : 1);
                EXPECT_EQ(feature->GetFieldAsInteger64("basin_id"), sample.orders.node_basin[n]);
                EXPECT_EQ(feature->GetFieldAsInteger64("strahler"), sample.orders.node_strahler[n]);
                EXPECT_NEAR(feature->GetFieldAsDouble("z"), sample.network.node_z[n], 1e-9);
                EXPECT_NEAR(feature->GetFieldAsDouble("area"), sample.node_area_m2[n], 1e-6);
                EXPECT_NEAR(feature->GetFieldAsDouble("dist_out"), sample.orders.node_dist_out_m[n], 1e-9);
                auto const& point = *feature->GetGeometryRef()->toPoint();
                EXPECT_EQ(point.getX(), sample.network.planform.node(n).at.x);
                EXPECT_EQ(point.getY(), sample.network.planform.node(n).at.y);
                EXPECT_EQ(point.getZ(), sample.network.node_z[n]);
                ++n;
            }
            EXPECT_EQ(n, sample.network.planform.node_count());
        }
    }
}

TEST(WriteNetwork, BraidedArcsAreMarkedInBothFormats) {
    SampleNetwork const sample = y_shape();
    std::vector<std::uint8_t> const braided{0, 1, 0};
    io::NetworkTables tables = sample.tables();
    tables.braided = &braided;
    ScratchFolder const folder;
    io::write_geopackage(tables, folder / "net.gpkg");
    io::write_shapefiles(tables, folder / "net");
    for (std::string const name : {"net.gpkg", "net_arcs.shp"}) {
        auto const dataset = opened(folder / name);
        std::vector<std::uint8_t> found;
        for (auto const& feature : Written::layer(*dataset, "arcs")) {
            found.push_back(static_cast<std::uint8_t>(feature->GetFieldAsInteger("braided")));
        }
        EXPECT_EQ(found, braided) << name;
    }
    std::vector<std::uint8_t> const of_another{1};
    tables.braided = &of_another;
    EXPECT_THROW(io::write_geopackage(tables, folder / "other.gpkg"), BadInput);
}

TEST(WriteNetwork, LargeNumbersFitWithoutAWarning) {
    SampleNetwork sample;
    auto const up = sample.node(-3e12, 0.0, 3.3e12);
    auto const down = sample.node(3e12, 0.0, -3.3e12);
    sample.arc(up, down);
    sample.settle();
    sample.ds_area_m2[0] = 5.5e15;
    sample.node_area_m2[1] = 5.5e15;
    ScratchFolder const folder;
    CPLErrorReset();
    io::write_shapefiles(sample.tables(), folder / "net");
    EXPECT_EQ(CPLGetLastErrorType(), CE_None) << CPLGetLastErrorMsg();
    io::write_geopackage(sample.tables(), folder / "net.gpkg");
    EXPECT_EQ(CPLGetLastErrorType(), CE_None) << CPLGetLastErrorMsg();
    auto const dataset = opened(folder / "net_arcs.shp");
    auto const feature = std::unique_ptr<OGRFeature>(dataset->GetLayer(0)->GetNextFeature());
    EXPECT_EQ(feature->GetFieldAsDouble("ds_area"), 5.5e15);
    EXPECT_EQ(feature->GetFieldAsDouble("z_down"), -3.3e12);
    EXPECT_EQ(feature->GetFieldAsDouble("length"), 6e12);
    sample.ds_area_m2[0] = 5.5e16;
    EXPECT_THROW(io::write_shapefiles(sample.tables(), folder / "more"), BadInput);
}

// That the bytes are the same each time is a law of every schema and format (WriteSchemas).
TEST(WriteNetwork, FilesHaveAFixedDate) {
    Written const written(two_basins());
    // Year, month and day of the last update are bytes 1 to 3.
    EXPECT_EQ(bytes_of(written.folder() / "net_arcs.dbf").substr(1, 3), (std::string{100, 1, 1}));
    auto const dataset = opened(written.folder() / "net.gpkg");
    OGRLayer* const times = dataset->ExecuteSQL("SELECT DISTINCT last_change FROM gpkg_contents", nullptr, nullptr);
    ASSERT_NE(times, nullptr);
    ASSERT_EQ(times->GetFeatureCount(), 1);
    EXPECT_STREQ(OGRFeatureUniquePtr(times->GetNextFeature())->GetFieldAsString(0), "2000/01/01 00:00:00+00");
    dataset->ReleaseResultSet(times);
}

TEST(WriteNetwork, GeoPackageHasRunTableAndSpatialIndex) {
    Written const written(y_shape());
    auto const dataset = opened(written.folder() / "net.gpkg");
    ASSERT_EQ(dataset->GetLayerCount(), 4) << "layer_styles too";
    EXPECT_TRUE(dataset->GetLayerByName("arcs")->TestCapability(OLCFastSpatialFilter));
    EXPECT_TRUE(dataset->GetLayerByName("nodes")->TestCapability(OLCFastSpatialFilter));
    OGRLayer& run = *dataset->GetLayerByName("run");
    EXPECT_EQ(run.GetGeomType(), wkbNone);
    EXPECT_EQ(fields_of(run), "name:s value:s ");
    std::string text;
    for (auto const& feature : run) {
        text += std::string(feature->GetFieldAsString("name")) + "=" + feature->GetFieldAsString("value") + " ";
    }
    EXPECT_EQ(text, "seed=7 version=0.1.0 ");
}

TEST(WriteNetwork, RidgesAreALayerOfTheGeoPackage) {
    SampleNetwork const sample = y_shape();
    RidgeLines const ridges{{{{{0.1, 0.2, 3.5}, {3.1, 4.2, 1.0 / 3.0}, {3.1, 14.2, 9.7}}, 1, 3},
                             {{{-7.7, 1.1, -2.5}, {-7.7, 1.3, -2.5}}, 2, 12345}}};
    io::NetworkTables tables = sample.tables();
    tables.ridges = &ridges;
    ScratchFolder const folder;
    io::write_geopackage(tables, folder / "net.gpkg");
    auto const dataset = opened(folder / "net.gpkg");
    ASSERT_EQ(dataset->GetLayerCount(), 5);
    OGRLayer& layer = *dataset->GetLayerByName("ridges");
    EXPECT_EQ(fields_of(layer), "ridge_id:i left:i right:i length:r z_min:r z_max:r ");
    EXPECT_EQ(layer.GetGeomType(), wkbLineString25D);
    EXPECT_STREQ(layer.GetSpatialRef()->GetAuthorityCode(nullptr), "32631");
    expect_no_nulls(layer);
    std::size_t r = 0;
    std::vector<double> const length{15.0, 1.3 - 1.1};
    for (auto const& feature : layer) {
        ASSERT_LT(r, 2U);
        auto const& line = ridges.lines[r].line;
        EXPECT_EQ(feature->GetFieldAsInteger("ridge_id"), static_cast<int>(r) + 1);
        EXPECT_EQ(feature->GetFieldAsInteger64("left"), ridges.lines[r].left);
        EXPECT_EQ(feature->GetFieldAsInteger64("right"), ridges.lines[r].right);
        EXPECT_NEAR(feature->GetFieldAsDouble("length"), length[r], 1e-12);
        EXPECT_EQ(feature->GetFieldAsDouble("z_min"), r == 0 ? 1.0 / 3.0 : -2.5);
        EXPECT_EQ(feature->GetFieldAsDouble("z_max"), r == 0 ? 9.7 : -2.5);
        auto const& drawn = *feature->GetGeometryRef()->toLineString();
        ASSERT_EQ(drawn.getNumPoints(), static_cast<int>(line.size()));
        for (int i = 0; Vec3 const& p : line) {
            EXPECT_EQ((Vec3{drawn.getX(i), drawn.getY(i), drawn.getZ(i)}), p);
            ++i;
        }
        ++r;
    }
    EXPECT_EQ(r, 2U);
    EXPECT_EQ(io::read_network(folder / "net.gpkg").arcs.size(), 3U);

    io::write_geopackage(tables, folder / "again.gpkg");
    EXPECT_TRUE(bytes_of(folder / "net.gpkg") == bytes_of(folder / "again.gpkg"));
}

TEST(WriteNetwork, WithoutRidgesThereIsNoLayer) {
    SampleNetwork const sample = y_shape();
    RidgeLines ridges;
    io::NetworkTables tables = sample.tables();
    tables.ridges = &ridges;
    ScratchFolder const folder;
    io::write_geopackage(tables, folder / "net.gpkg");
    EXPECT_EQ(opened(folder / "net.gpkg")->GetLayerByName("ridges"), nullptr);
    io::write_geopackage(sample.tables(), folder / "none.gpkg");
    EXPECT_TRUE(bytes_of(folder / "net.gpkg") == bytes_of(folder / "none.gpkg"));

    ridges.lines.push_back({{{0.0, 0.0, 1.0}}, 4, 5});
    EXPECT_TRUE(test::has(error_of([&] { io::write_geopackage(tables, folder / "bad.gpkg"); }), "BadInput",
                          "ridge 1 between streams 4"));
    ridges.lines[0].line = {{0.0, 0.0, 1.0}, {1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}};
    EXPECT_TRUE(
        test::has(error_of([&] { io::write_geopackage(tables, folder / "worse.gpkg"); }), "BadInput", "ridges 1 has"));
}

TEST(WriteNetwork, NetworkWithoutCrs) {
    ScratchFolder const folder;
    SampleNetwork const sample = y_shape();
    io::write_geopackage(sample.tables(""), folder / "net.gpkg");
    io::write_shapefiles(sample.tables(""), folder / "net");
    EXPECT_FALSE(std::filesystem::exists(folder / "net_arcs.prj"));
    EXPECT_EQ(io::read_network(folder / "net.gpkg").arcs.size(), 3U);
}

TEST(WriteNetwork, LongTypeFitsOrIsNamed) {
    ScratchFolder const folder;
    SampleNetwork sample = y_shape();
    sample.draft.arcs[2].arc.type = std::string(254, 'A');
    sample.settle();
    io::write_shapefiles(sample.tables(), folder / "net");
    auto const dataset = opened(folder / "net_arcs.shp");
    auto const feature = std::unique_ptr<OGRFeature>(dataset->GetLayer(0)->GetFeature(2));
    EXPECT_EQ(feature->GetFieldAsString("type"), std::string(254, 'A'));
    sample.draft.arcs[2].arc.type = std::string(255, 'A');
    sample.settle();
    EXPECT_TRUE(test::has(error_of([&] { io::write_shapefiles(sample.tables(), folder / "more"); }), "BadInput",
                          "arcs 3 has type"));
}

} // namespace write_network_test
