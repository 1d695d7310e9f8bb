// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/network/internal/read_network.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include "vector_files.hpp"

namespace river_fields_test {

using namespace thalweg;

namespace {

using Fields = std::vector<std::pair<std::string, OGRFieldType>>;
using Rows = std::vector<std::vector<std::string>>; ///< "" for NULL

/// The lines of a layer with these values, and why each is no natural watercourse.
struct Lines {
    std::vector<RiverLine> lines;
    std::vector<std::string> unnatural;
    std::vector<int> channels; ///< 1: unnatural, but carries water
};

Lines read(Fields const& fields, Rows const& rows) {
    GDALAllRegister();
    std::unique_ptr<GDALDataset> const data(
        GetGDALDriverManager()->GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
    ForeignLayer layer{.name = "lines", .fields = fields, .rows = {}};
    for (auto const& row : rows) {
        layer.rows.emplace_back("", row);
    }
    add_layer(*data, layer);
    OGRLayer& in = *data->GetLayer(0);
    io::RiverFields known(in);
    Lines read;
    for (auto const& feature : in) {
        RiverLine line;
        line.feature = static_cast<std::int64_t>(read.lines.size()) + 1;
        known.read(*feature, line);
        read.lines.push_back(std::move(line));
        auto const why = known.unnatural(*feature);
        read.unnatural.push_back(why.reason);
        read.channels.push_back(why.is_channel ? 1 : 0);
    }
    known.link(read.lines);
    return read;
}

std::vector<std::int64_t> downs(Lines const& read) {
    std::vector<std::int64_t> down;
    for (RiverLine const& line : read.lines) {
        down.push_back(line.down);
    }
    return down;
}

} // namespace

TEST(RiverFields, AFileWithoutKnownFieldsSaysNothing) {
    Lines const lines = read({{"id", OFTInteger}, {"remark", OFTString}}, {{"1", "x"}, {"", ""}});
    for (RiverLine const& line : lines.lines) {
        EXPECT_TRUE(line.size.empty());
        EXPECT_EQ(line.channel, Channel::unknown);
        EXPECT_EQ(line.name, "");
        EXPECT_EQ(line.down, 0);
        EXPECT_EQ(line.rank, 0);
    }
    EXPECT_EQ(lines.unnatural, (std::vector<std::string>{"", ""}));
}

TEST(RiverFields, SizesComeInTheirOrderAndClassesAfterThem) {
    // Whatever the order of the columns: area, discharge, order, class, in any case of letters.
    Lines const rivers =
        read({{"ord_clas", OFTInteger}, {"ORD_STRA", OFTInteger}, {"Dis_Av_Cms", OFTReal}, {"UPLAND_SKM", OFTReal}},
             {{"1", "3", "2.5", "40"}, {"4", "", "-9999", "nan"}, {"0", "2", "0", "7"}});
    EXPECT_EQ(rivers.lines[0].size, (std::vector<double>{40.0, 2.5, 3.0, 1.0}));
    EXPECT_EQ(rivers.lines[1].size, (std::vector<double>{0.0, 0.0, 0.0, 0.25}));
    EXPECT_EQ(rivers.lines[2].size, (std::vector<double>{7.0, 0.0, 2.0, 0.0}));
    EXPECT_GT(rivers.lines[0].size, rivers.lines[2].size);
    EXPECT_GT(rivers.lines[2].size, rivers.lines[1].size);
    // EU-Hydro has the order alone. A text is no size.
    EXPECT_EQ(read({{"STRAHLER", OFTInteger}}, {{"5"}}).lines[0].size, (std::vector<double>{5.0}));
    EXPECT_TRUE(read({{"STRAHLER", OFTString}}, {{"5"}}).lines[0].size.empty());
}

TEST(RiverFields, NhdPlusMarksItsMainAndMinorPaths) {
    Fields const fields{{"Divergence", OFTInteger}, {"StreamCalc", OFTInteger}, {"StreamOrde", OFTInteger}};
    Lines const lines = read(
        fields, {{"0", "3", "3"}, {"1", "3", "3"}, {"2", "0", "3"}, {"0", "0", "3"}, {"0", "0", "0"}, {"", "", ""}});
    std::vector<Channel> channels;
    for (RiverLine const& line : lines.lines) {
        channels.push_back(line.channel);
    }
    EXPECT_EQ(channels, (std::vector<Channel>{Channel::unknown, Channel::main, Channel::minor, Channel::minor,
                                              Channel::unknown, Channel::unknown}));
}

TEST(RiverFields, LinksNameLinesOfTheFile) {
    // Text ids as in EU-Hydro: one names itself, one nobody's id, one has none; of two with one id the first counts.
    Fields const fields{{"OBJECT_ID", OFTString}, {"NEXTDOWNID", OFTString}};
    EXPECT_EQ(downs(read(fields, {{"a", "b"}, {"b", "c"}, {"c", "c"}, {"d", "z"}, {"e", ""}, {"b", "a"}, {"", "a"}})),
              (std::vector<std::int64_t>{2, 3, 0, 0, 0, 1, 0}));
    // Whole numbers beyond 32 bits.
    EXPECT_EQ(downs(read({{"HYRIV_ID", OFTInteger64}, {"NEXT_DOWN", OFTInteger64}},
                         {{"20000000001", "20000000002"}, {"20000000002", "0"}})),
              (std::vector<std::int64_t>{2, 0}));
    // MERIT-Basins has the COMID of NHDPlus and a link of its own.
    Lines const merit = read({{"COMID", OFTInteger}, {"NextDownID", OFTInteger}, {"uparea", OFTReal}},
                             {{"27000001", "0", "500"}, {"27000002", "27000001", "300"}});
    EXPECT_EQ(downs(merit), (std::vector<std::int64_t>{0, 1}));
    EXPECT_EQ(merit.lines[0].size, (std::vector<double>{500.0}));
    // thalweg's own links come before those that a file kept from NHDPlus.
    EXPECT_EQ(
        downs(read(
            {{"hydroseq", OFTInteger64}, {"dnhydroseq", OFTInteger64}, {"arc_id", OFTInteger}, {"ds_arc", OFTInteger}},
            {{"9", "8", "1", "0"}, {"8", "0", "2", "1"}})),
        (std::vector<std::int64_t>{0, 1}));
    // An id without a link is none.
    EXPECT_EQ(downs(read({{"arc_id", OFTInteger}}, {{"1"}, {"2"}})), (std::vector<std::int64_t>{0, 0}));
}

TEST(RiverFields, NamesAreFoundUnderTheNamesOfTheirFields) {
    EXPECT_EQ(read({{"GNIS_Name", OFTString}}, {{"Walker Creek"}}).lines[0].name, "Walker Creek");
    EXPECT_EQ(read({{"nameTxtInt", OFTString}}, {{"Po"}}).lines[0].name, "Po");
    EXPECT_EQ(read({{"riv_name", OFTString}, {"name", OFTString}}, {{"second", "first"}}).lines[0].name, "first");
}

TEST(RiverFields, WhatIsNoNaturalWatercourseSaysWhy) {
    Fields const osm{{"waterway", OFTString}, {"tunnel", OFTString}, {"man_made", OFTString}};
    EXPECT_EQ(read(osm, {{"river", "", ""},
                         {"Stream", "no", ""},
                         {"Canal", "", ""},
                         {"stream", "flooded", ""},
                         {"stream", "culvert", ""},
                         {"", "", "pipeline"},
                         {"", "", ""}})
                  .unnatural,
              (std::vector<std::string>{"", "", "waterway canal", "tunnel flooded", "", "man_made pipeline", ""}));
    Fields const nhd{{"FTYPE", OFTString}, {"FCODE", OFTInteger}};
    EXPECT_EQ(read(nhd, {{"StreamRiver", "46006"},
                         {"Coastline", "56600"},
                         {"428", ""},
                         {"", "33600"},
                         {"ArtificialPath", "55800"},
                         {"", "56700"}})
                  .unnatural,
              (std::vector<std::string>{"", "FTYPE Coastline", "FTYPE 428", "FCODE 33600 CanalDitch", "", ""}));
}

TEST(RiverFields, CanalsDitchesDrainsAndPipesCarryWater) {
    Fields const osm{{"waterway", OFTString}, {"tunnel", OFTString}, {"man_made", OFTString}, {"barrier", OFTString}};
    Lines const lines = read(osm, {{"river", "", "", ""},
                                   {"canal", "", "", ""},
                                   {"Ditch", "", "", ""},
                                   {"drain", "", "", ""},
                                   {"weir", "", "", ""},
                                   {"stream", "flooded", "", ""},
                                   {"", "", "pipeline", ""},
                                   {"", "", "", "ditch"}}); // a dry one, which keeps people out
    EXPECT_EQ(lines.channels, (std::vector<int>{0, 1, 1, 1, 0, 1, 1, 0}));
    EXPECT_EQ(lines.unnatural.back(), "barrier ditch");
    Fields const nhd{{"FTYPE", OFTString}, {"FCODE", OFTInteger}};
    EXPECT_EQ(read(nhd, {{"Coastline", ""}, {"CanalDitch", ""}, {"428", ""}, {"", "33600"}, {"", "56600"}}).channels,
              (std::vector<int>{0, 1, 1, 1, 0}));
}

} // namespace river_fields_test
