// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/network_tables.hpp>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/io/network/internal/line_features.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/write_network.hpp>
#include <thalweg/network/import/from_file.hpp>
#include <thalweg/network/order/order.hpp>

#include "scratch_folder.hpp"
#include "vector_files.hpp"

namespace user_columns_test {

using namespace thalweg;
using io::Schema;
using Type = AttributeTable::Type;
using Kind = io::Column::Kind;

namespace {

using Names = std::vector<std::string>;

AttributeTable columns_named(Names const& names) {
    AttributeTable table;
    for (std::string const& name : names) {
        table.columns.push_back({name, AttributeTable::Type::text});
    }
    return table;
}

/// A table of two records with a column of each type.
AttributeTable of_each_type() {
    AttributeTable table;
    table.columns = {{"small", Type::integer},  {"wide", Type::integer64}, {"real", Type::real},
                     {"text", Type::text},      {"day", Type::date},       {"time_of_measure", Type::time},
                     {"moment", Type::datetime}};
    table.rows = {
        {std::int64_t{7}, std::int64_t{1} << 40, 2.5, "Walker", "2020/01/31", "13:45:10", "2020/01/31 13:45:10"},
        {{}, {}, {}, {}, {}, {}, {}}};
    return table;
}

/// Two rivers that meet, with fields of every type that OGR has for users; the second has none of the values.
ForeignLayer with_every_type() {
    return {.name = "lines",
            .type = wkbLineString25D,
            .fields = {{"small", OFTInteger},
                       {"wide", OFTInteger64},
                       {"real", OFTReal},
                       {"text", OFTString},
                       {"day", OFTDate},
                       {"hour", OFTTime},
                       {"moment", OFTDateTime},
                       {"numbers", OFTIntegerList},
                       {"wides", OFTInteger64List},
                       {"reals", OFTRealList},
                       {"words", OFTStringList}},
            .rows = {{"LINESTRING Z (50 200 6, 100 100 3)",
                      {"-7", "1099511627776", "2.5", "Zürich \xE6\xB2\xB3", "2020/01/31", "13:45:10",
                       "2020/01/31 13:45:10", "(2:3,4)", "(2:5,1099511627776)", "(2:0.5,1.5)", "(2:a,b)"}},
                     {"LINESTRING Z (150 200 5, 100 100 3)", {"", "", "", "", "", "", "", "", "", "", ""}},
                     {"LINESTRING Z (100 100 3, 100 0 1)", {"1", "2", "3", "", "", "", "", "", "", "", ""}}}};
}

std::unique_ptr<GDALDataset> memory_of(ForeignLayer const& layer) {
    GDALAllRegister();
    std::unique_ptr<GDALDataset> data(
        GetGDALDriverManager()->GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
    add_layer(*data, layer);
    return data;
}

} // namespace

TEST(UserColumns, WithoutColumnsThereAreNoNames) {
    EXPECT_TRUE(io::user_names({}, {"arc_id"}).empty());
    EXPECT_TRUE(io::short_user_names({}, {"arc_id"}).empty());
}

TEST(UserColumns, ColumnsOfAnotherSchemaGetAPrefixBesideAForeignOne) {
    AttributeTable const nhdplus = columns_named({"COMID", "GNIS_Name", "hydroseq", "ToNode", "LengthKM"});
    Names const taudem{"LINKNO", "DSLINKNO", "Length"};
    EXPECT_EQ(io::user_names(nhdplus, taudem, Schema::taudem),
              (Names{"u_COMID", "GNIS_Name", "u_hydroseq", "u_ToNode", "LengthKM"}));
    // The network schema is recognised whatever stands beside it, and half of what tells a schema tells nothing.
    EXPECT_EQ(io::user_names(nhdplus, {"arc_id"}, Schema::native),
              (Names{"COMID", "GNIS_Name", "hydroseq", "ToNode", "LengthKM"}));
    EXPECT_EQ(io::user_names(columns_named({"COMID", "next_down", "stream"}), taudem, Schema::taudem),
              (Names{"COMID", "next_down", "stream"}));
}

TEST(UserColumns, AColumnOfTheUserMayCompleteAnotherSchemaBesideTheLayersOwn) {
    EXPECT_EQ(io::user_names(columns_named({"next_stream", "other"}), {"LINKNO", "DSLINKNO", "stream"}, Schema::taudem),
              (Names{"u_next_stream", "other"}));
    EXPECT_EQ(io::user_names(columns_named({"from_node", "TO_NODE", "ds_arc", "arc_id"}), {"cat", "next_stream"},
                             Schema::grass),
              (Names{"u_from_node", "u_TO_NODE", "u_ds_arc", "u_arc_id"}));
}

TEST(UserColumns, TakenAndReservedNamesGetAPrefix) {
    EXPECT_EQ(io::user_names(columns_named({"Slope", "FID", "geom", "name"}), {"slope", "arc_id"}),
              (Names{"u_Slope", "u_FID", "u_geom", "name"}));
    // Unique in any case of letters, also beside names that have the prefix; a column may have no name.
    EXPECT_EQ(io::user_names(columns_named({"name", "NAME", "slope", "u_slope", "", ""}), {"slope"}),
              (Names{"name", "u_NAME", "u_slope", "u_u_slope", "column", "u_column"}));
    EXPECT_EQ(io::user_names(columns_named({"u_a", "a", "A"}), {"a"}), (Names{"u_a", "a_2", "A_3"}));
}

TEST(UserColumns, ShortNamesHaveTenBytesAndStayApart) {
    EXPECT_EQ(io::short_user_names({"ten_bytes_", "shape_length", "shape_leng", "SHAPE_LENGTHS"}, {"arc_id"}),
              (Names{"ten_bytes_", "shape_le_2", "shape_leng", "SHAPE_LE_3"}));
    EXPECT_EQ(io::short_user_names({"time_of_measure"}, {"TIME_OF_ME"}), (Names{"time_of__2"}));
    // No letter is cut in two: the tenth byte here is the first of three.
    EXPECT_EQ(io::short_user_names({"123456789\xE6\xB2\xB3"}, {}), (Names{"123456789"}));
}

TEST(UserColumns, TypesStayAndWhatHasNoRecordIsNull) {
    AttributeTable const attributes = of_each_type();
    for (bool const in_shapefile : {false, true}) {
        io::Table table;
        table.rows = 4;
        std::vector<std::int64_t> const record{1, 2, 0, 9};
        io::add_user_columns(
            table, attributes, [&](std::int64_t row) { return record[static_cast<std::size_t>(row)]; }, in_shapefile);
        ASSERT_EQ(table.columns.size(), 7U);
        Kind const time = in_shapefile ? Kind::text : Kind::time; // dBase has dates alone
        Kind const moment = in_shapefile ? Kind::text : Kind::datetime;
        std::vector<Kind> const kinds{Kind::integer, Kind::wide_integer, Kind::real, Kind::text, Kind::date, time,
                                      moment};
        for (std::size_t c = 0; c < kinds.size(); ++c) {
            EXPECT_EQ(table.columns[c].kind, kinds[c]) << table.columns[c].name;
            EXPECT_TRUE(table.columns[c].is_users);
            EXPECT_EQ(table.columns[c].at(0), attributes.rows[0][c]) << table.columns[c].name;
            for (std::int64_t const row : {1, 2, 3}) { // NULL, no record, none of the table
                EXPECT_TRUE(std::holds_alternative<std::monostate>(table.columns[c].at(row)));
            }
        }
        EXPECT_EQ(table.columns[5].name, in_shapefile ? "time_of_me" : "time_of_measure");
    }
}

TEST(UserColumns, ShapefilesCutLongTextsAtALetterAndLeaveRoomForDigits) {
    AttributeTable attributes = columns_named({"text"});
    attributes.columns.push_back({"real", Type::real});
    std::string letters(253, 'x');
    letters += "\xC3\xBC and more";
    attributes.rows = {{letters, 12345678.25}, {"short", -0.5}};
    io::Table table;
    table.rows = 2;
    io::add_user_columns(
        table, attributes, [](std::int64_t row) { return row + 1; }, true);
    EXPECT_EQ(std::get<std::string>(table.columns[0].at(0)), std::string(253, 'x'));
    EXPECT_EQ(std::get<std::string>(table.columns[0].at(1)), "short");
    EXPECT_EQ(table.columns[1].decimals, 12); // 20 digits in all
    io::Table whole;
    whole.rows = 2;
    io::add_user_columns(
        whole, attributes, [](std::int64_t row) { return row + 1; }, false);
    EXPECT_EQ(std::get<std::string>(whole.columns[0].at(0)), letters);
}

TEST(AttributeReader, DatesAndListsBecomeTextsOfTheirOwn) {
    auto const data = memory_of(with_every_type());
    OGRLayer& layer = *data->GetLayer(0);
    io::AttributeReader reader(layer);
    for (auto const& feature : layer) {
        reader.read(*feature);
    }
    std::vector<std::string> as_text;
    for (Finding const& finding : reader.findings()) {
        EXPECT_EQ(finding.kind, "as_text");
        as_text.push_back(finding.text);
    }
    ASSERT_EQ(as_text.size(), 4U);
    EXPECT_TRUE(test::has(as_text[0], "field numbers holds IntegerList"));
    AttributeTable const table = reader.take();
    std::vector<Type> types;
    for (auto const& column : table.columns) {
        types.push_back(column.type);
    }
    EXPECT_EQ(types, (std::vector<Type>{Type::integer, Type::integer64, Type::real, Type::text, Type::date, Type::time,
                                        Type::datetime, Type::text, Type::text, Type::text, Type::text}));
    ASSERT_EQ(table.rows.size(), 3U);
    using Row = std::vector<AttributeTable::Value>;
    EXPECT_EQ(table.rows[0],
              (Row{std::int64_t{-7}, std::int64_t{1} << 40, 2.5, "Zürich \xE6\xB2\xB3", "2020/01/31", "13:45:10",
                   "2020/01/31 13:45:10", "(2:3,4)", "(2:5,1099511627776)", "(2:0.5,1.5)", "(2:a,b)"}));
    EXPECT_EQ(table.rows[1], Row(11));
}

TEST(AttributeReader, OfTheNetworkSchemaOnlyTheUsersColumnsAreRead) {
    auto const data = memory_of({.name = "arcs",
                                 .fields = {{"arc_id", OFTInteger},
                                            {"FROM_NODE", OFTInteger},
                                            {"to_node", OFTInteger},
                                            {"ds_arc", OFTInteger},
                                            {"slope", OFTReal},
                                            {"u_slope", OFTReal},
                                            {"GNIS_Name", OFTString}},
                                 .rows = {{"", {"1", "1", "2", "0", "0.5", "7", "Po"}}}});
    EXPECT_TRUE(io::is_in_network_schema(*data->GetLayer(0)));
    io::AttributeReader reader(*data->GetLayer(0));
    AttributeTable const table = reader.take();
    ASSERT_EQ(table.columns.size(), 2U);
    EXPECT_EQ(table.columns[0].name, "u_slope");
    EXPECT_EQ(table.columns[1].name, "GNIS_Name");
}

// Law: what a user's file says comes out of every format with its type and value.
TEST(UserColumns, EveryFormatGivesBackWhatAFileSaid) {
    ScratchFolder const folder;
    std::string const path = written(folder, "lines.geojson", "GeoJSON", {with_every_type()});
    NetworkFile const file = io::read_network(path, {.any_lines = true});
    network::FileNetwork const made = network::from_file(file);
    NetworkOrders const orders = network::order(made.network.plan);
    std::vector<double> const node_area_m2(made.network.plan.node_count(), -1.0);
    io::UserData const user{file.attributes, made.records, made.stretches};
    std::vector<double> const area_m2(file.arcs.size(), -1.0);
    io::NetworkTables tables{made.network, orders, area_m2, area_m2, node_area_m2, "EPSG:32631", {}};
    tables.user = &user;
    for (auto const& [format, name] : {std::pair(io::NetworkFormat::geopackage, "out.gpkg"),
                                       {io::NetworkFormat::flatgeobuf, "out.fgb"},
                                       {io::NetworkFormat::geojson, "out.geojson"},
                                       {io::NetworkFormat::shapefile, "out.shp"}}) {
        io::write_network(tables, folder / name, {.format = format});
        std::unique_ptr<GDALDataset> const data(
            GDALDataset::Open((folder / io::network_files(name, {.format = format}).front()).c_str(), GDAL_OF_VECTOR));
        ASSERT_NE(data, nullptr) << name;
        OGRLayer& layer = *data->GetLayer(0);
        bool const in_shapefile = format == io::NetworkFormat::shapefile;
        auto const type = [&](char const* field) {
            return layer.GetLayerDefn()->GetFieldDefn(layer.GetLayerDefn()->GetFieldIndex(field))->GetType();
        };
        // FlatGeobuf has moments alone, dBase days alone: what they lack is text.
        EXPECT_EQ(type("day"), format == io::NetworkFormat::flatgeobuf ? OFTString : OFTDate) << name;
        EXPECT_EQ(type("moment"), in_shapefile ? OFTString : OFTDateTime) << name;
        for (auto const& feature : layer) {
            if (feature->GetFieldAsInteger64("feature") == 1) {
                EXPECT_EQ(feature->GetFieldAsInteger("small"), -7) << name;
                EXPECT_EQ(feature->GetFieldAsInteger64("wide"), std::int64_t{1} << 40) << name;
                EXPECT_EQ(feature->GetFieldAsDouble("real"), 2.5) << name;
                EXPECT_STREQ(feature->GetFieldAsString("text"), "Zürich \xE6\xB2\xB3") << name;
                EXPECT_STREQ(feature->GetFieldAsString("day"), "2020/01/31") << name;
                EXPECT_STREQ(feature->GetFieldAsString("hour"), "13:45:10") << name;
                EXPECT_STREQ(feature->GetFieldAsString("moment"), "2020/01/31 13:45:10") << name;
                EXPECT_STREQ(feature->GetFieldAsString("words"), "(2:a,b)") << name;
            } else {
                for (char const* const field : {"text", "day", "hour", "moment", "words"}) {
                    int const index = feature->GetFieldIndex(field);
                    EXPECT_EQ(feature->IsFieldSetAndNotNull(index), 0) << name << " " << field;
                }
            }
        }
    }
}

} // namespace user_columns_test
