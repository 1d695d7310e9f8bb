// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/io/files/files.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/network/schema.hpp>

#include "vector_files.hpp"

namespace data_sets_test {

using namespace thalweg;

namespace {

class DataSets : public ::testing::Test {
protected:
    /// The rivers of a layer with these fields: tributaries along a river, drawn upstream.
    RiverLines with_fields(std::string const& fields, std::vector<std::string> const& values,
                           io::ReadRiversParams params = {}) const {
        static std::vector<std::string> const lines{
            "LINESTRING (500 500, 0 1000)",    "LINESTRING (500 500, 1000 1000)", "LINESTRING (500 0, 500 500)",
            "LINESTRING (500 0, 900 300)",     "LINESTRING (500 -500, 500 0)",    "LINESTRING (500 -500, 900 -300)",
            "LINESTRING (500 -990, 500 -500)", "LINESTRING (900 -90, 500 0)"};
        ForeignLayer layer{.type = wkbUnknown, .epsg = 32633, .fields = fields.c_str()};
        for (std::size_t i = 0; i < values.size(); ++i) {
            layer.rows.push_back({lines[i], values[i]});
        }
        params.path = written(folder_, "fields.gpkg", {layer});
        return io::read_rivers(params);
    }

private:
    ScratchFolder folder_;
};

/// What lines say of where they flow: "down from>to runs rank area", of what they say.
std::string said(RiverLines const& rivers) {
    std::string all;
    for (RiverLine const& line : rivers.lines) {
        std::string one;
        one += line.down != 0 ? fmt::format(" d{}", line.down) : "";
        one += line.to_node != 0 ? fmt::format(" {}>{}", line.from_node, line.to_node) : "";
        one += line.runs != 0 ? fmt::format(" {:+}", line.runs) : "";
        one += line.rank != 0 ? fmt::format(" r{}", line.rank) : "";
        one += line.area_m2 != 0.0 ? fmt::format(" a{}", line.area_m2) : "";
        one += line.channel == Channel::main ? " main" : "";
        one += !std::isnan(line.vertices.front().z)
                   ? fmt::format(" z{}..{}", line.vertices.front().z, line.vertices.back().z)
                   : "";
        all += (&line == rivers.lines.data() ? "" : ";") + one;
    }
    return all;
}

struct Case {
    char const* set;
    char const* fields;
    std::vector<std::string> values;
    char const* said;
};

std::string const links = " d3; d3;";
std::vector<std::string> const ids{"11|13", "12|13", "13|0"};
std::vector<std::string> const nodes{"1|3", "2|3", "3|4"};

std::vector<Case> const cases{
    {"thalweg", "arc_id:l ds_arc:l ds_area:r", {"1|3|5", "2|3|6", "3|0|12"}, " d3 a5; d3 a6; a12"},
    {"NHDPlus",
     "Hydroseq:r DnHydroseq:r TotDASqKM:r",
     {"30|10|1", "20|10|2", "10|0|4"},
     " d3 r30 a1000000; d3 r20 a2000000; r10 a4000000"},
    {"nhdplusTools", "COMID tocomid", ids, " d3; d3;"},
    {"MERIT-Basins, RAPID",
     "COMID NextDownID uparea:r",
     {"11|13|1", "12|13|2", "13|0|4"},
     " d3 a1000000; d3 a2000000; a4000000"},
    {"HydroRIVERS", "HYRIV_ID:l NEXT_DOWN:l DIST_DN_KM:r", {"11|13|2.5", "12|13|2.5", "13|0|0"}, " d3 r2; d3 r2; r1"},
    {"EU-Hydro", "OBJECT_ID:s NEXTDOWNID:s", {"RL1|RL3", "RL2|RL3", "RL3|"}, " d3; d3;"},
    {"TauDEM, TDX-Hydro, GEOGLOWS",
     "LINKNO DSLINKNO DSContArea:r",
     {"0|2|5", "1|2|6", "2|-1|12"},
     " d3 a5; d3 a6; a12"},
    {"GRASS r.stream.order", "cat next_strea", {"11|13", "12|13", "13|-1"}, " d3; d3;"},
    {"CCM2", "WSO1_ID:l NEXTDOWNID:l", ids, " d3; d3;"},
    {"ArcHydro, Geofabric", "HydroID NextDownID", {"11|13", "12|13", "13|-1"}, " d3; d3;"},
    {"ArcHydro, Geofabric",
     "HydroID NextDownID UpstrDArea:r",
     {"11|13|5", "12|13|6", "13|-1|12"},
     " d3 a5; d3 a6; a12"},
    {"ECRINS",
     "TR:s NEXTDOWNID:s FNODE TNODE",
     {"TR11|TR13|1|3", "TR12|TR13|2|3", "TR13||3|4"},
     " d3 1>2; d3 3>2; 2>4"},
    {"BHO",
     "COTRECHO NUTRJUS NOORIGEM NODESTINO NUDISTBACT:r NUAREAMONT:r",
     {"11|13|1|3|9.5|1", "12|13|2|3|8.5|2", "13||3|4|0.5|4"},
     " d3 1>2 r3 a1000000; d3 3>2 r2 a2000000; 2>4 r1 a4000000"},
    {"SWORD",
     "reach_id:l rch_id_dn:s dist_out:r facc:r",
     {"74100000011|[74100000031 74100000099]|2000.5|1", "74100000021|74100000099,74100000031|1500|2",
      "74100000031||1000|4"},
     " d3 r3 a1000000; d3 r2 a2000000; r1 a4000000"},
    {"SWORD", "reach_id:l rch_id_dn_1:l n_rch_dn", {"11|13|1", "12|13|1", "13||0"}, " d3; d3;"},
    {"NextGen hydrofabric",
     "id:s toid:s tot_drainage_areasqkm:r",
     {"wb-1|nex-3|1", "wb-2|wb-3|2", "wb-3|tnx-9|4"},
     " d3 a1000000; d3 a2000000; a4000000"},
    {"mizuRoute", "segId tosegment", ids, " d3; d3;"},
    {"QSWAT+", "Channel ChannelR", ids, " d3; d3;"},
    {"ArcSWAT, QSWAT", "Subbasin SubbasinR", ids, " d3; d3;"},
    {"pyflwdir", "idx:l idx_ds:l", {"11|13", "12|13", "13|13"}, " d3; d3;"},
    {"river-route", "river_id:l downstream_river_id:l", {"11|13", "12|13", "13|-1"}, " d3; d3;"},
    {"River Environment Classification", "nzsegment FROM_NODE TO_NODE", {"1|1|3", "2|2|3", "3|3|4"}, " 1>2; 3>2; 2>4"},
    {"River Environment Classification",
     "nzsegment nz_fnode nz_tnode LENGTHDOWN:r CUM_AREA:r",
     {"1|1|3|2500|5", "2|2|3|2500|6", "3|3|4|10|12"},
     " 1>2 r2500 a5; 3>2 r2500 a6; 2>4 r10 a12"},
    {"W05", "W05_009:s W05_010:s", {"#gb03_1|#gb03_3", "#gb03_2|#gb03_3", "#gb03_3|#gb03_4"}, " 1>2; 3>2; 2>4"},
    {"3DHP", "hydrosequence:l dnhydrosequence:l", {"30|10", "20|10", "10|0"}, " d3 r30; d3 r20; r10"},
    {"DIBAVOD", "UTOKJ_ID:r UTOKJN_ID:r", ids, " d3; d3;"},
    {"river-route", "river_id:l ds_river_id:l", {"11|13", "12|13", "13|-1"}, " d3; d3;"},
    {"GRIT",
     "global_id:l upstream_node_id:l downstream_node_id:l is_mainstem drainage_area_out:r",
     {"11|1|3|1|1", "12|2|3|0|2", "13|3|4|1|4"},
     " 1>2 a1000000 main; 3>2 a2000000; 2>4 a4000000 main"},
    {"INSPIRE",
     "flowDirection_href:s",
     {"http://inspire.ec.europa.eu/codelist/LinkDirectionValue/inOppositeDirection", "inDirection", "bothDirections"},
     " -1; +1;"},
    {"NHN", "flowDirection", {"2", "1", "-1"}, " -1; +1;"},
    {"OS Open Rivers", "flow_direction:s", {"in opposite direction", "in direction", ""}, " -1; +1;"},
    {"BD TOPAGE, BD TOPO",
     "sens_de_l_ecoulement:s Z_INI:r Z_FIN:r",
     {"Sens inverse|50.5|90", "Sens direct|-1000|95", "Inconnu|20|50.5"},
     " -1 z50.5..90; +1; z20..50.5"},
    {"ArcGIS geometric networks, NHD",
     "FlowDir:s",
     {"Against Digitized", "With Digitized", "Uninitialized"},
     " -1; +1;"},
    {"ArcGIS geometric networks, NHD", "FLOWDIR", {"2", "1", "0"}, " -1; +1;"},
    {"ArcGIS geometric networks, NHD", "FLOWDIR", {"2", "1", "128"}, ";;"},                      // D8 codes of a raster
    {"ArcGIS geometric networks, NHD", "FLOWDIR flow:r", {"2|12.5", "1|7", "0|20"}, " -1; +1;"}, // a discharge
};

} // namespace

TEST_F(DataSets, SayWhereWaterGoes) {
    for (Case const& c : cases) {
        EXPECT_EQ(said(with_fields(c.fields, c.values)), c.said) << c.set << ": " << c.fields;
    }
}

TEST_F(DataSets, AreAllTestedAndDocumented) {
    std::string const docs = io::read_text(THALWEG_SOURCE_DIR "/docs/river_files.md", 1 << 20);
    for (io::DataSet const& set : io::all_data_sets()) {
        auto const is_it = [&](Case const& c) { return c.set == set.name; };
        EXPECT_TRUE(std::ranges::any_of(cases, is_it)) << set.name;
        EXPECT_TRUE(test::has(docs, fmt::format("| {} |", set.name))) << set.name;
    }
}

TEST_F(DataSets, OfSeveralLinksThoseOfTheFileCount) {
    // A NEXTDOWNID of whatever ids.
    EXPECT_EQ(said(with_fields("OBJECT_ID GID NEXTDOWNID", {"1|11|13", "2|12|13", "3|13|0"})), links);
    // Nodes and directions that a user names replace the links of a data set.
    RiverLines const named = with_fields("HydroID NextDownID a:s b:s", {"1|2|x|z", "2|1|y|z", "3|1|z|w"},
                                         {.from_field = "a", .to_field = "b"});
    EXPECT_EQ(said(named), " 1>2; 3>2; 2>4");
    EXPECT_EQ(said(with_fields("HydroID NextDownID way:s", {"1|3|with digitized", "2|3|in opposite direction", "3|0|2"},
                               {.direction_field = "way"})),
              " +1; -1; -1");
}

TEST_F(DataSets, RanksMayBeAnyNumbers) {
    EXPECT_EQ(said(with_fields("far:r", {"2.5", "-9999", "0"}, {.rank_field = "far"})), " r2;; r1");
    EXPECT_EQ(said(with_fields("far:r", {"2", "7", "0"}, {.rank_field = "far"})), " r2; r7;");
}

TEST_F(DataSets, ConditionsKeepTheNumbersOfLines) {
    RiverLines const some =
        with_fields("name:s size", {"Po|3", "Adda|2", "Po|5"}, {.where = "\"size\" > 2 AND name = 'Po'"});
    ASSERT_EQ(some.lines.size(), 2U);
    EXPECT_EQ(some.lines[1].feature, 3);
    EXPECT_EQ(some.attributes.rows.size(), 3U);
}

TEST_F(DataSets, WhatLooksLikeLinksNodesOrDirectionsIsNamed) {
    auto const notes = [&](char const* fields, std::vector<std::string> const& values) {
        std::string texts;
        for (Finding const& finding : with_fields(fields, values).findings) {
            texts += finding.kind == FindingKind("unused_fields") ? finding.text + ";" : "";
        }
        return texts;
    };
    EXPECT_TRUE(test::has(notes("nr abfluss", {"1|3", "2|3", "3|5", "4|5", "5|7", "6|7", "7|0"}),
                          "--field arc_id=nr --field ds_arc=abfluss"));
    EXPECT_TRUE(test::has(notes("von nach", {"1|3", "2|3", "3|5", "4|5", "5|7", "6|7", "7|8", "5|9"}),
                          "--field from_node=von --field to_node=nach"));
    EXPECT_TRUE(test::has(notes("nr way:s", {"1|In Direction", "2|In Opposite Direction", "3|In Direction"}),
                          "--field direction=way"));
    EXPECT_TRUE(test::has(notes("flow_dir_txt:s", {"downhill", "uphill", "?"}), "('?'"));
    EXPECT_EQ(notes("nr klasse name:s", {"1|2|a", "2|2|b", "3|1|c"}), "");
}

} // namespace data_sets_test
