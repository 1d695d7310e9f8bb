// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <map>
#include <sstream>

#include <gtest/gtest.h>
#include <measure/trees.hpp>
#include <ogrsf_frmts.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/network/import/from_file.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/planform/split_confluences.hpp>

#include "sample_networks.hpp"
#include "scratch_folder.hpp"
#include "vector_files.hpp"

namespace write_schemas_test {

using namespace thalweg;
using io::NetworkFormat;
using io::Schema;

namespace {

using test::error_of;

/// Every feature's fields as text, by name, in small letters.
using Rows = std::vector<std::map<std::string, std::string>>;

Rows rows_of(std::string const& path) {
    auto const dataset = opened(path);
    Rows rows;
    for (auto const& feature : *dataset->GetLayer(0)) {
        auto& row = rows.emplace_back();
        for (int i = 0; i < feature->GetFieldCount(); ++i) {
            std::string name = feature->GetFieldDefnRef(i)->GetNameRef();
            std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
            row[name] = feature->GetFieldAsString(i);
        }
        OGRLineString const& line = *feature->GetGeometryRef()->toLineString();
        row["first_y"] = std::to_string(line.getY(0));
    }
    return rows;
}

constexpr std::array<Schema, 5> schemas{Schema::native, Schema::taudem, Schema::nhdplus, Schema::hydrorivers,
                                        Schema::grass};

/// Two rivers of 5000 and 3000 m that meet at a height of 10 m, 2000 m above the outlet; areas of whole km2.
SampleNetwork kilometres() {
    SampleNetwork sample;
    auto const outlet = sample.node(500000.0, 4000000.0, 2.0);
    auto const meeting = sample.node(500000.0, 4002000.0, 10.0);
    auto const left = sample.node(497000.0, 4006000.0, 60.0);
    auto const right = sample.node(500000.0, 4005000.0, 40.0);
    sample.arc(left, meeting);
    sample.arc(right, meeting);
    sample.arc(meeting, outlet);
    sample.settle();
    sample.us_area_m2 = {1e6, 2e6, 12e6};
    sample.ds_area_m2 = {6e6, 5e6, 14e6};
    sample.node_area_m2 = {14e6, 12e6, 1e6, 2e6};
    return sample;
}

/// The rows of kilometres() in a schema.
Rows rows_in(Schema schema, std::string const& name) {
    ScratchFolder const folder;
    io::write_network(kilometres().tables(), folder / name, {io::network_format("", name), schema});
    return rows_of(folder / name);
}

/// wanted: "name=value name=value"; values that are numbers are compared as such.
void expect_row(std::map<std::string, std::string> const& row, std::string const& wanted) {
    std::istringstream words(wanted);
    for (std::string word; words >> word;) {
        std::string const name = word.substr(0, word.find('='));
        std::string const value = word.substr(word.find('=') + 1);
        ASSERT_TRUE(row.contains(name)) << name;
        char* end = nullptr;
        double const number = std::strtod(value.c_str(), &end);
        if (*end == '\0') {
            EXPECT_DOUBLE_EQ(std::stod(row.at(name)), number) << name;
        } else {
            EXPECT_EQ(row.at(name), value) << name;
        }
    }
}

} // namespace

TEST(WriteSchemas, TauDemIsDrawnUpstreamAndCountsFromZero) {
    Rows const rows = rows_in(Schema::taudem, "net.gpkg");
    ASSERT_EQ(rows.size(), 3U);
    expect_row(rows[0], "linkno=0 dslinkno=2 uslinkno1=-1 uslinkno2=-1 dsnodeid=-1 strmorder=1 length=5000 "
                        "magnitude=1 dscontarea=6000000 strmdrop=50 slope=0.01 straightl=5000 "
                        "uscontarea=1000000 wsno=0 doutend=2000 doutstart=7000 doutmid=4500 first_y=4002000");
    expect_row(rows[2], "linkno=2 dslinkno=-1 uslinkno1=0 uslinkno2=1 strmorder=2 magnitude=2 doutend=0 "
                        "first_y=4000000");
}

TEST(WriteSchemas, NhdPlusHasKilometresAndCentimetres) {
    Rows const rows = rows_in(Schema::nhdplus, "net.shp");
    ASSERT_EQ(rows.size(), 3U);
    expect_row(rows[0], "comid=1 lengthkm=5 streamleve=1 streamorde=1 fromnode=3 tonode=2 pathlength=2 "
                        "arbolatesu=5 startflag=1 terminalfl=0 areasqkm=5 totdasqkm=6 maxelevsmo=6000 "
                        "minelevsmo=1000 slope=0.01 uphydroseq=0 first_y=4006000");
    expect_row(rows[2], "hydroseq=1 dnhydroseq=0 levelpathi=1 terminalpa=1 arbolatesu=10 terminalfl=1 "
                        "dnlevel=0 dndraincou=0");
    // The longer river goes on as the main stem: one level path, and the other's is its own.
    EXPECT_EQ(rows[0].at("flowdir"), "With Digitized");
    EXPECT_EQ(rows[0].at("levelpathi"), "1");
    EXPECT_EQ(rows[1].at("levelpathi"), rows[1].at("hydroseq"));
    EXPECT_EQ(rows[2].at("uphydroseq"), rows[0].at("hydroseq"));
    EXPECT_EQ(rows[1].at("dnlevelpat"), "1");
    EXPECT_EQ(rows[1].at("streamleve"), "2");
}

TEST(WriteSchemas, HydroRiversHasItsLinksAndNothingItCannotKnow) {
    Rows const rows = rows_in(Schema::hydrorivers, "net.gpkg");
    ASSERT_EQ(rows.size(), 3U);
    expect_row(rows[1], "hyriv_id=2 next_down=3 main_riv=3 length_km=3 dist_dn_km=2 dist_up_km=3 catch_skm=3 "
                        "upland_skm=5 endorheic=0 dis_av_cms=-9999 ord_stra=1 ord_clas=2");
    expect_row(rows[2], "next_down=0 dist_dn_km=0 dist_up_km=7 ord_stra=2");
}

TEST(WriteSchemas, GrassHasItsNames) {
    Rows const rows = rows_in(Schema::grass, "net.gpkg");
    ASSERT_EQ(rows.size(), 3U);
    expect_row(rows[1], "cat=2 stream=2 next_stream=3 prev_str01=0 strahler=1 horton=1 shreve=1 hack=2 "
                        "topo_dim=2 length=3000 stright=3000 sinosoid=1 cum_length=3000 out_dist=5000 "
                        "source_elev=40 outlet_elev=10 elev_drop=30 gradient=0.01");
    expect_row(rows[2], "next_stream=-1 prev_str01=1 prev_str02=2 prev_str03=0 horton=2 scheidegger=4 "
                        "drwal_old=2");
    EXPECT_EQ(rows[0].at("horton"), "2"); // the main stem has the order of its mouth up to its source
    expect_row(rows_in(Schema::grass, "net.shp")[2], "outlet_ele=2 next_strea=-1");
}

TEST(WriteSchemas, UnknownValuesAreTheSchemasOwn) {
    ScratchFolder const folder;
    SampleNetwork sample = kilometres();
    sample.us_area_m2.assign(3, -1.0);
    sample.ds_area_m2.assign(3, -1.0);
    io::NetworkTables tables = sample.tables();
    tables.heights = false;
    io::write_network(tables, folder / "nhd.gpkg", {.schema = Schema::nhdplus});
    expect_row(rows_of(folder / "nhd.gpkg")[0], "maxelevsmo=-9998 slope=-9998 areasqkm=-1");
    io::write_network(tables, folder / "tau.gpkg", {.schema = Schema::taudem});
    expect_row(rows_of(folder / "tau.gpkg")[0], "dscontarea=-1");
}

TEST(WriteSchemas, MoreRiversThanASchemaCanNameAreRefusedWithTheRemedy) {
    ScratchFolder const folder;
    SampleNetwork const sample = two_basins();
    std::string const message =
        error_of([&] { io::write_network(sample.tables(), folder / "net.gpkg", {.schema = Schema::taudem}); });
    EXPECT_TRUE(test::has(message, "BadInput io.write_network", "(0.7, 100.1)"));
    EXPECT_EQ(folder.entries(), 0);
    EXPECT_NO_THROW(io::write_network(sample.tables(), folder / "net.gpkg", {.schema = Schema::grass}));
}

TEST(WriteSchemas, GeoJsonNeedsACode) {
    ScratchFolder const folder;
    SampleNetwork const sample = y_shape();
    for (NetworkFormat const format : {NetworkFormat::geojson, NetworkFormat::geojson2008}) {
        EXPECT_THROW(io::write_network(sample.tables(""), folder / "net.geojson", {format}), BadInput);
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WriteSchemas, GeoJsonIsInDegrees) {
    ScratchFolder const folder;
    SampleNetwork const sample = two_basins();
    io::write_network(sample.tables(), folder / "net.geojson", {NetworkFormat::geojson, Schema::grass});
    EXPECT_FALSE(test::has(bytes_of(folder / "net.geojson"), "\"crs\""));
    auto const data = opened(folder / "net.geojson");
    OGRSpatialReference const* const crs = data->GetLayer(0)->GetSpatialRef();
    ASSERT_NE(crs, nullptr);
    EXPECT_TRUE(crs->IsGeographic());
    io::ReadNetworkParams read;
    read.crs = "EPSG:32631";
    NetworkFile const file = io::read_network(folder / "net.geojson", read);
    ASSERT_EQ(file.arcs.size(), 6U);
    io::write_network(sample.tables(), folder / "net.gpkg", {NetworkFormat::geopackage, Schema::grass});
    NetworkFile const exact = io::read_network(folder / "net.gpkg", io::ReadNetworkParams{});
    for (std::size_t a = 0; a < file.arcs.size(); ++a) {
        ASSERT_EQ(file.arcs[a].line.size(), exact.arcs[a].line.size());
        for (std::size_t v = 0; v < file.arcs[a].line.size(); ++v) {
            Vec3 const& p = file.arcs[a].line[v];
            EXPECT_LT(distance(in_plan(p), in_plan(exact.arcs[a].line[v])), 2e-4);
            EXPECT_EQ(p.z, exact.arcs[a].line[v].z);
        }
    }
}

TEST(WriteSchemas, FormatsAreKnownByEndingAndName) {
    EXPECT_EQ(io::network_format("", "a.FGB"), NetworkFormat::flatgeobuf);
    EXPECT_EQ(io::network_format("graphml", "a.xml"), NetworkFormat::graphml);
    EXPECT_THROW(io::network_format("", "a.kml"), BadParameter);
    EXPECT_THROW(io::network_format("kml", "a.gpkg"), BadParameter);
    EXPECT_EQ(io::network_files("x/a.fgb", {NetworkFormat::flatgeobuf}),
              (std::vector<std::string>{"a_arcs.fgb", "a_nodes.fgb"}));
    EXPECT_EQ(io::network_files("x/a.fgb", {NetworkFormat::flatgeobuf, Schema::grass}),
              (std::vector<std::string>{"a.fgb"}));
}

TEST(WriteSchemas, SameBytesEachTimeAndNoFileButThoseAnnounced) {
    SampleNetwork const sample = y_shape();
    for (auto const& format : io::network_formats()) {
        for (Schema const schema : schemas) {
            ScratchFolder const one;
            ScratchFolder const two;
            io::WriteNetworkParams const params{format.format, schema, Grid{40, 40, 10.0, -150.0, 250.0, "EPSG:32631"}};
            std::string const name = std::string("net") + format.ending;
            CPLErrorReset();
            io::write_network(sample.tables(), one / name, params);
            EXPECT_EQ(CPLGetLastErrorType(), CE_None) << format.name << CPLGetLastErrorMsg();
            io::write_network(sample.tables(), two / name, params);
            auto const files = io::network_files(name, params);
            EXPECT_EQ(one.entries(), static_cast<std::ptrdiff_t>(files.size())) << format.name;
            for (std::string const& file : files) {
                EXPECT_FALSE(bytes_of(one / file).empty()) << file;
                EXPECT_TRUE(bytes_of(one / file) == bytes_of(two / file)) << file;
            }
        }
    }
}

TEST(WriteSchemas, MaskHasTheCellsOfRivers) {
    ScratchFolder const folder;
    SampleNetwork const sample = y_shape();
    Grid const grid{40, 40, 10.0, -150.0, 250.0, "EPSG:32631"};
    io::write_network(sample.tables(), folder / "net.tif", {NetworkFormat::mask, Schema::native, grid});
    Raster<float> const mask = io::read_dem(folder / "net.tif");
    EXPECT_EQ(mask.grid().width, 40);
    std::int64_t rivers = 0;
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        EXPECT_TRUE(mask[i] == 0.0F || mask[i] == 1.0F);
        rivers += mask[i] == 1.0F ? 1 : 0;
    }
    EXPECT_GT(rivers, 20);
    for (NodeId n = 0; n < 4; ++n) {
        EXPECT_EQ(mask[grid.cell_of(sample.network.planform.node(n).at)], 1.0F);
    }
    Grid const small{4, 4, 10.0, -150.0, 250.0, "EPSG:32631"};
    EXPECT_THROW(io::write_network(sample.tables(), folder / "out.tif", {NetworkFormat::mask, Schema::native, small}),
                 BadInput);
}

TEST(WriteSchemas, GraphsHaveNodesEdgesAndTheirText) {
    SampleNetwork sample = y_shape();
    sample.draft.arcs[0].arc.type = "a <b> & \"c\", 'd' # \x01";
    sample.settle();
    ScratchFolder const folder;
    io::write_network(sample.tables(), folder / "net.graphml", {NetworkFormat::graphml});
    std::string const graphml = bytes_of(folder / "net.graphml");
    EXPECT_TRUE(test::has(graphml, "edgedefault=\"directed\"", "<data key=\"crs\">EPSG:32631</data>",
                          "<node id=\"1\"><data key=\"x\">0.1</data><data key=\"y\">0.2</data>",
                          "<edge source=\"3\" target=\"2\">", "a &lt;b&gt; &amp; &quot;c&quot;, 'd' #  </data>",
                          "LINESTRING Z (0.3 100.7 4.7, 0.1 0.2 0.3333333333333333)"));

    io::write_network(sample.tables(), folder / "net.csv", {NetworkFormat::csv});
    std::string const csv = bytes_of(folder / "net.csv");
    EXPECT_EQ(csv.substr(0, csv.find("\r\n")).find("from_node,to_node,arc_id,ds_arc,"), 0U);
    EXPECT_TRUE(test::has(csv, "\r\n3,2,1,2,", "\"a <b> & \"\"c\"\", 'd' # \x01\""));

    io::write_network(sample.tables(), folder / "net.edges", {NetworkFormat::edges});
    std::string const edges = bytes_of(folder / "net.edges");
    EXPECT_EQ(edges.front(), '#');
    EXPECT_TRUE(test::has(edges, "\n3 2 {'arc_id': 1, 'ds_arc': 2, ", "'a <b> & \"c\", \\x27d\\x27 \\x23 \\x01'"));
}

// Law: what is written in anyone's schema, in any format that holds doubles, is read back: lines and heights bit for
// bit, arcs in their order, orders and links as they were, areas within the rounding of their unit.
TEST(WriteSchemas, RoundTripsLoseNothingTheSchemaCanHold) {
    ASSERT_TRUE(rc::check([&] {
        std::string const name = *rc::gen::element("net.gpkg", "net.shp", "net.fgb", "net.geojson");
        bool const is_geojson = name.ends_with(".geojson"); // in its own coordinates
        auto const format = is_geojson ? NetworkFormat::geojson2008 : io::network_format("", name);
        auto const schema = *rc::gen::elementOf(schemas);
        ElevatedNetwork rivers =
            random_rivers(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::int64_t>(2, 12),
                          *rc::gen::inRange<std::int64_t>(2, 12), 1000.0 / 7.0);
        std::int64_t feature = 0;
        NetworkDraft named = rivers.planform.draft();
        for (DraftArc& drawn : named.arcs) {
            feature = (7 * feature + 3) % 1000003;
            drawn.arc.feature = feature;
        }
        rivers.planform = std::move(named);
        SampleNetwork const drawn = sample_of(std::move(rivers));
        ScratchFolder const folder;
        CPLErrorReset();
        io::write_network(drawn.tables(), folder / name, {format, schema});
        std::string const read_name = io::network_files(name, {format, schema}).front();
        NetworkFile const file = io::read_network(folder / read_name, io::ReadNetworkParams{});
        RC_ASSERT(CPLGetLastErrorType() == CE_None);
        RC_ASSERT(file.schema == io::table_of(schema).name);
        RC_ASSERT(file.crs == "EPSG:32631");
        RC_ASSERT(file.arcs.size() == drawn.us_area_m2.size());
        network::FileNetwork const made = network::from_file(file);
        NetworkOrders const orders = network::order(made.network.planform);
        RC_ASSERT(orders.strahler == drawn.orders.strahler);
        RC_ASSERT(orders.shreve == drawn.orders.shreve);
        RC_ASSERT(orders.hack == drawn.orders.hack);
        RC_ASSERT(made.network.arc_z == drawn.network.arc_z);
        std::vector<std::int64_t> numbers;
        for (std::size_t a = 0; a < drawn.network.planform.arc_count(); ++a) {
            RC_ASSERT(made.network.planform.arc(a).line == drawn.network.planform.arc(a).line);
            RC_ASSERT(made.network.planform.out(made.network.planform.to(a)) ==
                      drawn.network.planform.out(drawn.network.planform.to(a)));
            if (schema != Schema::grass) {
                RC_ASSERT(std::fabs(made.us_area_m2[a] - drawn.us_area_m2[a]) < 2e-6);
                RC_ASSERT(std::fabs(made.ds_area_m2[a] - drawn.ds_area_m2[a]) < 2e-6);
            }
            numbers.push_back(made.network.planform.arc(a).feature);
        }
        if (schema != Schema::native && format == NetworkFormat::flatgeobuf) { // which sorts its features
            std::sort(numbers.begin(), numbers.end());
        }
        for (std::size_t a = 0; a < numbers.size(); ++a) {
            std::int64_t const own = drawn.network.planform.arc(a).feature;
            RC_ASSERT(numbers[a] == (schema == Schema::native ? own : static_cast<std::int64_t>(a) + 1));
        }
        for (auto const& node : file.nodes) {
            auto const n = static_cast<NodeId>(node.id - 1);
            Vec2 const at = schema == Schema::native ? drawn.network.planform.node(n).at : Vec2{node.at.x, node.at.y};
            double const z = schema == Schema::native ? drawn.network.node_z[n] : node.at.z;
            RC_ASSERT(node.at == (Vec3{at.x, at.y, z}));
        }
        for (auto const& arc : file.arcs) {
            auto const a = static_cast<std::size_t>(std::lower_bound(made.arc_ids.begin(), made.arc_ids.end(), arc.id) -
                                                    made.arc_ids.begin());
            RC_ASSERT(!file.says.strahler || arc.strahler == drawn.orders.strahler[a]);
            RC_ASSERT(!file.says.shreve || arc.shreve == drawn.orders.shreve[a]);
        }
    }));
}

TEST(WriteSchemas, SamplesComeBackFromEverySchemaOnceTheyAreSplit) {
    for (SampleNetwork const& sample : {single_arc(), y_shape(), two_basins()}) {
        SampleNetwork const drawn = sample_of(network::split_confluences(sample.network).network);
        for (auto const& table : io::all_schemas()) {
            ScratchFolder const folder;
            io::write_network(drawn.tables(), folder / "net.gpkg", {.schema = table.schema});
            network::FileNetwork const made =
                network::from_file(io::read_network(folder / "net.gpkg", io::ReadNetworkParams{}));
            EXPECT_EQ(made.network.arc_z, drawn.network.arc_z) << table.name;
            EXPECT_EQ(network::order(made.network.planform).shreve, drawn.orders.shreve) << table.name;
        }
    }
}

} // namespace write_schemas_test
