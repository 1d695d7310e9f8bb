// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Columns of a user's file, from reading to writing.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/network/import/from_file.hpp>
#include <thalweg/network/order/order.hpp>

#include "sample_networks.hpp"
#include "vector_files.hpp"

namespace user_columns_test {

using namespace thalweg;
using io::NetworkFormat;
using io::Schema;
using Type = AttributeTable::Type;
using Names = std::vector<std::string>;

namespace {

/// Two rivers that meet, with fields of every type that OGR has; the second has none of the values.
ForeignLayer with_every_type() {
    return {.type = wkbLineString25D,
            .fields = "small wide:l real:r text:s day:d hour:t moment:m numbers:I wides:L reals:R words:S",
            .rows = {{"LINESTRING Z (50 200 6, 100 100 3)",
                      "-7|1099511627776|2.5|Zürich \xE6\xB2\xB3|2020/01/31|13:45:10|2020/01/31 13:45:10|(2:3,4)|"
                      "(2:5,1099511627776)|(2:0.5,1.5)|(2:a,b)"},
                     {"LINESTRING Z (150 200 5, 100 100 3)", "||||||||||"},
                     {"LINESTRING Z (100 100 3, 100 0 1)", "1|2|3||||||||"}}};
}

/// Writes a network of one arc with a user's columns of one record, and opens its arcs.
std::unique_ptr<GDALDataset> with_columns(ScratchFolder const& folder, AttributeTable attributes, Schema schema,
                                          NetworkFormat format = NetworkFormat::geopackage) {
    SampleNetwork const sample = single_arc();
    io::UserData const user{std::move(attributes), {1}, {}};
    io::NetworkTables tables = sample.tables();
    tables.user = &user;
    io::WriteNetworkParams const params{format, schema};
    std::string const name = format == NetworkFormat::shapefile ? "net.shp" : "net.gpkg";
    io::write_network(tables, folder / name, params);
    return opened(folder / io::network_files(name, params).front());
}

/// The names that the last columns of a file have where the user calls them so.
Names named(Names const& names, Schema schema, NetworkFormat format = NetworkFormat::geopackage) {
    AttributeTable table;
    table.rows.emplace_back();
    for (std::string const& name : names) {
        table.columns.push_back({name, Type::text});
        table.rows[0].emplace_back("x");
    }
    ScratchFolder const folder;
    auto const data = with_columns(folder, std::move(table), schema, format);
    OGRFeatureDefn& layer = *data->GetLayer(0)->GetLayerDefn();
    Names found;
    for (int i = layer.GetFieldCount() - static_cast<int>(names.size()); i < layer.GetFieldCount(); ++i) {
        found.emplace_back(layer.GetFieldDefn(i)->GetNameRef());
    }
    return found;
}

} // namespace

TEST(UserColumns, NamesThatWouldMisleadGetAPrefix) {
    struct Case {
        Schema schema;
        Names names;
        Names wanted;
    };
    for (auto const& [schema, names, wanted] : {
             // Those of another schema beside a foreign one; half of what tells a schema tells nothing.
             Case{Schema::taudem,
                  {"COMID", "GNIS_Name", "hydroseq", "ToNode", "LengthKM"},
                  {"u_COMID", "GNIS_Name", "u_hydroseq", "u_ToNode", "LengthKM"}},
             Case{Schema::taudem, {"COMID", "next_down", "stream"}, {"COMID", "next_down", "stream"}},
             Case{Schema::grass,
                  {"from_node", "TO_NODE", "ds_arc", "arc_id"},
                  {"u_from_node", "u_TO_NODE", "u_ds_arc", "u_arc_id"}},
             // The network schema is recognised whatever is beside it.
             Case{Schema::native,
                  {"COMID", "GNIS_Name", "hydroseq", "ToNode", "LengthKM"},
                  {"COMID", "GNIS_Name", "hydroseq", "ToNode", "LengthKM"}},
             // Names that are taken or reserved, in any case of letters; a column may have no name.
             Case{Schema::native, {"Slope", "FID", "geom", "name"}, {"u_Slope", "u_FID", "u_geom", "name"}},
             Case{Schema::native,
                  {"name", "NAME", "slope", "u_slope", "", ""},
                  {"name", "u_NAME", "u_slope", "u_u_slope", "column", "u_column"}},
             Case{Schema::native, {"u_hack", "hack", "HACK"}, {"u_hack", "hack_2", "HACK_3"}},
         }) {
        EXPECT_EQ(named(names, schema), wanted);
    }
}

TEST(UserColumns, ShortNamesHaveTenBytesAndStayApart) {
    EXPECT_EQ(
        named({"ten_bytes_", "shape_length", "shape_leng", "SHAPE_LENGTHS"}, Schema::native, NetworkFormat::shapefile),
        (Names{"ten_bytes_", "shape_le_2", "shape_leng", "SHAPE_LE_3"}));
    // No letter is cut in two: the tenth byte here is the first of three.
    EXPECT_EQ(named({"123456789\xE6\xB2\xB3"}, Schema::native, NetworkFormat::shapefile), (Names{"123456789"}));
}

TEST(UserColumns, ShapefilesCutLongTextsAtALetterAndLeaveRoomForDigits) {
    std::string const letters = std::string(253, 'x') + "\xC3\xBC and more";
    for (NetworkFormat const format : {NetworkFormat::shapefile, NetworkFormat::geopackage}) {
        AttributeTable table;
        table.columns = {{"text", Type::text}, {"real", Type::real}};
        table.rows = {{letters, 12345678.25}};
        ScratchFolder const folder;
        auto const data = with_columns(folder, std::move(table), Schema::native, format);
        OGRFeatureUniquePtr const feature(data->GetLayer(0)->GetNextFeature());
        bool const is_cut = format == NetworkFormat::shapefile;
        EXPECT_EQ(feature->GetFieldAsString("text"), is_cut ? std::string(253, 'x') : letters);
        EXPECT_EQ(feature->GetFieldAsDouble("real"), 12345678.25);
        int const decimals = feature->GetFieldDefnRef(feature->GetFieldIndex("real"))->GetPrecision();
        EXPECT_EQ(decimals, is_cut ? 12 : 0); // 20 digits in all
    }
}

TEST(UserColumns, DatesAndListsAreReadAsTexts) {
    ScratchFolder const folder;
    NetworkFile const file =
        io::read_network(written(folder, "lines.geojson", {with_every_type()}), {.any_lines = true});
    Names const lists{"numbers", "wides", "reals", "words"};
    EXPECT_EQ(count_of(file, "as_text"), 4);
    EXPECT_TRUE(test::has(finding_of(file, "as_text").text, "numbers"));
    std::vector<Type> types;
    for (auto const& column : file.attributes.columns) {
        types.push_back(column.type);
    }
    EXPECT_EQ(types, (std::vector<Type>{Type::integer, Type::integer64, Type::real, Type::text, Type::date, Type::time,
                                        Type::datetime, Type::text, Type::text, Type::text, Type::text}));
    ASSERT_EQ(file.attributes.rows.size(), 3U);
    using Row = std::vector<AttributeTable::Value>;
    EXPECT_EQ(file.attributes.rows[1], Row(11));
    EXPECT_EQ(file.attributes.rows[0][7], AttributeTable::Value("(2:3,4)"));
}

TEST(UserColumns, OfTheNetworkSchemaOnlyTheUsersColumnsAreRead) {
    ScratchFolder const folder;
    NetworkFile const file =
        io::read_network(written(folder, "a.gpkg",
                                 {{.name = "arcs",
                                   .fields = "arc_id FROM_NODE to_node ds_arc slope:r u_slope:r GNIS_Name:s",
                                   .rows = {{"LINESTRING (0 0, 1 1)", "1|1|2|0|0.5|7|Po"}}}}),
                         io::ReadNetworkParams{});
    ASSERT_EQ(file.attributes.columns.size(), 2U);
    EXPECT_EQ(file.attributes.columns[0].name, "u_slope");
    EXPECT_EQ(file.attributes.columns[1].name, "GNIS_Name");
}

// Law: what a user's file says comes out of every format with its type and value; what has no record is NULL.
TEST(UserColumns, EveryFormatGivesBackWhatAFileSaid) {
    ScratchFolder const folder;
    NetworkFile const file =
        io::read_network(written(folder, "lines.geojson", {with_every_type()}), {.any_lines = true});
    network::FileNetwork made = network::from_file(file);
    made.records[2] = 0;
    NetworkOrders const orders = network::order(made.network.planform);
    std::vector<double> const node_area_m2(made.network.planform.node_count(), -1.0);
    io::UserData const user{file.attributes, made.records, made.stretches};
    std::vector<double> const area_m2(file.arcs.size(), -1.0);
    io::NetworkTables tables{made.network, orders, area_m2, area_m2, node_area_m2, "EPSG:32631", {}};
    tables.user = &user;
    for (std::string const name : {"out.gpkg", "out.fgb", "out.geojson", "out.shp"}) {
        io::NetworkFormat const format = io::network_format("", name);
        io::write_network(tables, folder / name, {.format = format});
        auto const data = opened(folder / io::network_files(name, {.format = format}).front());
        ASSERT_NE(data, nullptr) << name;
        OGRLayer& layer = *data->GetLayer(0);
        auto const type = [&](char const* field) {
            return layer.GetLayerDefn()->GetFieldDefn(layer.GetLayerDefn()->GetFieldIndex(field))->GetType();
        };
        // FlatGeobuf has no dates, dBase has nothing else: what they lack is text.
        EXPECT_EQ(type("day"), format == NetworkFormat::flatgeobuf ? OFTString : OFTDate) << name;
        EXPECT_EQ(type("moment"), format == NetworkFormat::shapefile ? OFTString : OFTDateTime) << name;
        std::map<std::string, std::string> const wanted{{"small", "-7"},
                                                        {"wide", "1099511627776"},
                                                        {"real", "2.5"},
                                                        {"text", "Zürich \xE6\xB2\xB3"},
                                                        {"day", "2020/01/31"},
                                                        {"hour", "13:45:10"},
                                                        {"moment", "2020/01/31 13:45:10"},
                                                        {"words", "(2:a,b)"}};
        for (auto const& feature : layer) {
            auto const number = feature->GetFieldAsInteger64("feature");
            for (auto const& [field, text] : wanted) {
                int const index = feature->GetFieldIndex(field.c_str());
                bool const is_number = field == "small" || field == "wide" || field == "real";
                if (number == 1 && is_number) {
                    EXPECT_EQ(feature->GetFieldAsDouble(index), std::stod(text)) << name << " " << field;
                } else if (number == 1) {
                    EXPECT_EQ(feature->GetFieldAsString(index), text) << name << " " << field;
                } else {
                    EXPECT_EQ(feature->IsFieldSetAndNotNull(index), 0) << name << " " << field;
                }
            }
        }
    }
}

} // namespace user_columns_test
