// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Of a file with other lines beside its rivers all rivers are read, and the rest is named.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/network/read_network.hpp>
#include <thalweg/io/network/read_rivers.hpp>

#include "vector_files.hpp"

namespace river_layers_test {

using namespace thalweg;
using test::has;

namespace {

/// A layer of one line, 1 km to the east.
ForeignLayer line_at(std::string const& name, int y, ForeignLayer::Fields const& fields = {},
                     std::string const& values = "") {
    std::string const north = std::to_string(5000000 + y);
    return {.name = name,
            .epsg = 32633,
            .fields = fields,
            .rows = {{"LINESTRING(500000 " + north + ",501000 " + north + ")", values}}};
}

RiverLines rivers_of(std::string const& path, std::string const& layer = "") {
    return io::read_rivers({.path = path, .layer = layer, .filter = io::LineFilter::natural});
}

std::string refusal(std::string const& path, std::string const& layer = "") {
    return test::error_of([&] { rivers_of(path, layer); });
}

/// The finding that names other layers; an empty one when there is none.
Finding others_in(std::vector<Finding> const& findings) {
    auto const found = std::ranges::find(findings, FindingKind("layers_not_read"), &Finding::kind);
    return found == findings.end() ? Finding{"left_out"} : *found;
}

std::string values_of(RiverLines const& rivers, std::string const& column) {
    auto const& columns = rivers.attributes.columns;
    auto const at = std::ranges::find(columns, column, &AttributeTable::Column::name);
    std::string all;
    for (auto const& row : rivers.attributes.rows) {
        auto const* const text = at == columns.end()
                                     ? nullptr
                                     : std::get_if<std::string>(&row[static_cast<std::size_t>(at - columns.begin())]);
        all += (text == nullptr ? "-" : *text) + ";";
    }
    return all;
}

/// "1 waterway canal; ": feature and reason of what is set aside, channels first.
std::string set_aside(RiverLines const& rivers) {
    std::string all;
    for (RiverLine const& line : rivers.channels) {
        all += std::to_string(line.feature) + " " + line.artificial + "; ";
    }
    for (SecondaryLine const& line : rivers.secondary) {
        all += std::to_string(line.feature) + " " + line.reason + (line.cause == LeftOut::coast ? " (coast); " : "; ");
    }
    return all;
}

std::string folder_of(std::string const& name, std::string const& placemarks) {
    return "<Folder><name>" + name + "</name>" + placemarks + "</Folder>";
}

std::string placemark(std::string const& shape, std::string const& coordinates) {
    return "<Placemark><name>p</name><" + shape + "><coordinates>" + coordinates + "</coordinates></" + shape +
           "></Placemark>";
}

std::string kml(std::string const& folders) {
    return R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document>)" + folders +
           "</Document></kml>";
}

/// A way of OpenStreetMap between two of the nodes 1 to 9.
std::string way(int id, std::string const& tags) {
    return "<way id=\"" + std::to_string(id) + "\" version=\"1\"><nd ref=\"" + std::to_string(id) + "\"/><nd ref=\"" +
           std::to_string(id + 1) + "\"/>" + tags + "</way>";
}

std::string tag(std::string const& key, std::string const& value) {
    return "<tag k=\"" + key + "\" v=\"" + value + "\"/>";
}

std::string osm(std::string const& ways) {
    std::string text = R"(<?xml version="1.0"?><osm version="0.6">)";
    for (int i = 1; i <= 9; ++i) {
        text +=
            "<node id=\"" + std::to_string(i) + "\" version=\"1\" lat=\"47.0" + std::to_string(i) + "\" lon=\"9.0\"/>";
    }
    return text + ways + "</osm>";
}

class RiverLayers : public ::testing::Test {
protected:
    std::string write(std::string const& name, std::vector<ForeignLayer> const& layers) const {
        return written(folder_, name, layers);
    }
    std::string text(std::string const& name, std::string const& content) const {
        test::write(folder_ / name, content);
        return folder_ / name;
    }
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (auto const& entry : std::filesystem::directory_iterator(folder_.path())) {
            names.push_back(entry.path().filename().string());
        }
        return names;
    }

private:
    ScratchFolder folder_;
};

} // namespace

TEST_F(RiverLayers, OthersAreNamedWithTheirLength) {
    ForeignLayer const wells{.name = "wells", .type = wkbPoint, .epsg = 32633, .rows = {{"POINT(1 2)"}}};
    std::string const file =
        write("a.gpkg", {line_at("rivers", 0), line_at("canals", 10), line_at("ditches", 20), wells});
    RiverLines const read = rivers_of(file);
    EXPECT_EQ(read.lines.size(), 1U);
    Finding const others = others_in(read.findings);
    EXPECT_NEAR(others.amount, 2000.0, 1e-6);
    EXPECT_TRUE(has(others.text, "a.gpkg", "canals (1.0 km), ditches (1.0 km)", "those of rivers"));
    EXPECT_TRUE(has(others.remedy, "rivers,canals"));
    EXPECT_EQ(others_in(io::read_network(file, {.any_lines = true}).findings).text, others.text);

    EXPECT_EQ(others_in(rivers_of(file, "canals").findings).kind, FindingKind("left_out"));
    std::string const alone = write("b.gpkg", {line_at("rivers", 0), {.name = "none"}, wells});
    EXPECT_EQ(others_in(rivers_of(alone).findings).kind, FindingKind("left_out"));
}

TEST_F(RiverLayers, SeveralAreReadAsOne) {
    std::string const file =
        write("a.gpkg", {line_at("rivers", 0, "name:s size:r", "Aa|1.5"),
                         line_at("brooks, north", 10, "name:s size:s", "Bee|2"), line_at("other", 20, "code", "7")});
    RiverLines const both = rivers_of(file, "rivers , other");
    ASSERT_EQ(both.lines.size(), 2U);
    EXPECT_EQ(both.lines[1].feature, 2);
    EXPECT_EQ(both.lines[0].name, "Aa");
    EXPECT_EQ(values_of(both, "layer"), "rivers;other;");
    EXPECT_EQ(values_of(both, "name"), "Aa;-;");
    EXPECT_EQ(rivers_of(file, "brooks, north").lines.size(), 1U);
    EXPECT_EQ(rivers_of(file, "rivers,rivers").lines.size(), 1U);
    EXPECT_TRUE(has(refusal(file, "rivers,othr"), "no layer 'othr'", "Did you mean 'other'?"));
    EXPECT_EQ(io::read_network(file, {.arcs_layer = "rivers,other", .any_lines = true}).arcs.size(), 2U);

    ForeignLayer elsewhere = line_at("west", 0);
    elsewhere.epsg = 32632;
    EXPECT_TRUE(has(refusal(write("b.gpkg", {line_at("rivers", 0), elsewhere}), "rivers,west"), "BadInput",
                    "layers rivers and west", "coordinate systems"));
}

TEST_F(RiverLayers, FoldersOfKmlBelongTogether) {
    std::string const file =
        text("a.kml", kml(folder_of("Main river", placemark("LineString", "9,47,0 9,47.01,0")) +
                          folder_of("Sources", placemark("Point", "9,47,0")) +
                          folder_of("Tributaries", placemark("LineString", "9.01,47,0 9,47.005,0")) +
                          folder_of("Roads", placemark("LineString", "9.01,47,0 9.01,47.01,0"))));
    RiverLines const read = rivers_of(file);
    EXPECT_EQ(read.lines.size(), 2U);
    EXPECT_EQ(values_of(read, "layer"), "Main river;Tributaries;");
    EXPECT_TRUE(has(others_in(read.findings).text, "Roads (1.1 km)"));
    EXPECT_EQ(io::read_network(file, {.any_lines = true}).arcs.size(), 2U);
    EXPECT_EQ(rivers_of(file, "Roads").lines.size(), 1U);
}

TEST_F(RiverLayers, TracksAndRoutesOfGpxBelongTogetherAndHaveHeights) {
    RiverLines const read = rivers_of(text(
        "a.gpx",
        R"(<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1">)"
        R"(<wpt lat="47" lon="9"/><rte><rtept lat="47.1" lon="9"><ele>20</ele></rtept>)"
        R"(<rtept lat="47" lon="9"><ele>10</ele></rtept></rte><trk><trkseg><trkpt lat="47.1" lon="9.1"><ele>30</ele>)"
        R"(</trkpt><trkpt lat="47" lon="9"><ele>10</ele></trkpt></trkseg></trk></gpx>)"));
    ASSERT_EQ(read.lines.size(), 2U);
    EXPECT_TRUE(read.has_z);
    EXPECT_EQ(read.lines[0].vertices[0].z, 20.0);
    EXPECT_EQ(read.lines[1].vertices[0].z, 30.0);
}

TEST_F(RiverLayers, OfOpenStreetMapTheWaysWithWaterwayAreRead) {
    std::string const ways = way(1, tag("waterway", "river")) + way(2, tag("power", "line")) +
                             way(3, tag("natural", "coastline")) + way(4, tag("waterway", "canal")) +
                             way(5, tag("ref", "7")) + way(6, tag("boundary", "administrative")) +
                             way(7, tag("man_made", "pipeline")) + way(8, tag("highway", "track"));
    std::string const set = "4 waterway canal; 7 man_made pipeline; 2 power line; 3 natural coastline (coast); "
                            "5 no waterway; 6 boundary administrative; 8 highway track; ";
    std::string const relation = R"(<relation id="1" version="1"><member type="way" ref="1" role=""/>)" +
                                 tag("type", "waterway") + "</relation>";
    std::string const file = text("a.osm", osm(ways + relation));
    EXPECT_EQ(io::find_rivers(file).layer, "lines");
    for (std::string const layer : {"", "lines"}) {
        RiverLines const read = rivers_of(file, layer);
        EXPECT_EQ(read.lines.size(), 1U);
        EXPECT_EQ(set_aside(read), set);
        EXPECT_TRUE(read.findings.empty());
    }
    EXPECT_EQ(io::read_network(file, {.any_lines = true}).arcs.size(), 8U);
}

TEST_F(RiverLayers, OpenStreetMapMayComeByAnotherFile) {
    ForeignLayer lines{.name = "lines", .fields = "osm_id:s waterway:s highway:s other_tags:s"};
    for (std::string const values :
         {"1|river||", R"(2||| "name"=>"a \"power\"=>b","natural"=>"coastline")", R"(3|||{"power": "line"})", "4|||",
          "||track|", "|||", "5||track|"}) { // two were drawn by hand
        std::string const y = std::to_string(10 * lines.rows.size());
        lines.rows.push_back({"LINESTRING (0 " + y + ", 5 " + y + ")", values});
    }
    ForeignLayer const relations{.name = "other_relations",
                                 .type = wkbGeometryCollection,
                                 .fields = "osm_id:s",
                                 .rows = {{"GEOMETRYCOLLECTION(LINESTRING(0 0,5 0))", "9"}}};
    RiverLines const read = rivers_of(write("a.gpkg", {lines, relations}));
    EXPECT_EQ(read.lines.size(), 2U);
    EXPECT_EQ(set_aside(read), "2 natural coastline (coast); 3 power line; 4 no waterway; 5 highway track; "
                               "7 highway track; ");
    EXPECT_TRUE(read.findings.empty());
    for (ForeignLayer::Row& row : lines.rows) {
        row.values[1].clear();
    }
    EXPECT_TRUE(has(refusal(write("b.gpkg", {{.name = "lines",
                                              .fields = "osm_id:s waterway:s other_tags:s",
                                              .rows = {{"LINESTRING(0 0,5 0)", "1||"}}}})),
                    "BadInput", "no waterway", "network.lines.filter"));
}

TEST_F(RiverLayers, CanalsDitchesAndPipesOfOtherSchemas) {
    struct Case {
        char const* fields;
        std::vector<std::string> values;
        std::string set_aside;
    };
    for (auto const& [fields, values, set] : {
             Case{"form:s", {"inlandRiver", "canal", "tidalRiver", "lake", "lock"}, "2 form canal; 5 form lock; "},
             Case{"NATURE:s",
                  {"Ecoulement naturel", "Conduit forcé", "Canal", "Ecoulement canalisé", "Conduit buse", "Delta"},
                  "2 NATURE Conduit forcé; 3 NATURE Canal; 5 NATURE Conduit buse; "},
             Case{"branchtype:s",
                  {"river", "pipe", "channel", "sewerConnection"},
                  "2 branchtype pipe; 4 branchtype sewerConnection; "},
             Case{"fclass:s", {"river", "drain", "stream"}, "2 fclass drain; "}, // Geofabrik
             Case{"featurecla:s",
                  {"River", "Canal", "Coastline"},
                  "2 featurecla Canal; 3 featurecla Coastline (coast); "},
             Case{"DFDD:s", {"BH140", "BH020", "BH030"}, "2 DFDD BH020; 3 DFDD BH030; "},
             Case{"OBJART:s OBJART_TXT:s",
                  {"44002|AX_Wasserlauf", "44003|", "44004|AX_Kanal"},
                  "2 OBJART 44003; 3 OBJART_TXT AX_Kanal; "},
             Case{"objtype:s",
                  {"ElvBekk", "KanalGrøft", "Kystkontur"},
                  "2 objtype KanalGrøft; 3 objtype Kystkontur (coast); "},
             Case{"origin_href:s",
                  {"http://inspire.ec.europa.eu/codelist/OriginValue/natural",
                   "http://inspire.ec.europa.eu/codelist/OriginValue/manMade"},
                  "2 origin_href http://inspire.ec.europa.eu/codelist/OriginValue/manMade; "},
             Case{"waterDefinition", {"6", "1", "3"}, "2 waterDefinition 1; 3 waterDefinition 3; "},
             Case{"type:s", {"Bach", "Graben", "Canal Street Creek", ""}, "2 type Graben; "},
         }) {
        ForeignLayer layer{.fields = fields};
        for (std::string const& value : values) {
            std::string const y = std::to_string(10 * layer.rows.size());
            layer.rows.push_back({"LINESTRING (0 " + y + ", 5 " + y + ")", value});
        }
        std::string const file = write("a.gpkg", {layer});
        EXPECT_EQ(set_aside(rivers_of(file)), set) << fields;
        EXPECT_EQ(io::read_rivers({.path = file}).lines.size(), values.size());
    }
}

TEST_F(RiverLayers, GmlKeepsItsReferencesAndItsFolder) {
    std::string const link = R"(<x:Link><x:shape><gml:LineString srsName="urn:ogc:def:crs:EPSG::32633"><gml:posList>)"
                             R"(0 0 5 5</gml:posList></gml:LineString></x:shape><x:flowDirection )"
                             R"(xlink:href="http://inspire.ec.europa.eu/codelist/LinkDirectionValue/)";
    std::string const file =
        text("a.gml", R"(<gml:FeatureCollection xmlns:gml="http://www.opengis.net/gml/3.2" xmlns:x="urn:x" )"
                      R"(xmlns:xlink="http://www.w3.org/1999/xlink"><gml:featureMember>)" +
                          link + R"(inOppositeDirection"/></x:Link></gml:featureMember></gml:FeatureCollection>)");
    RiverLines const read = rivers_of(file);
    ASSERT_EQ(read.lines.size(), 1U);
    EXPECT_EQ(read.lines[0].runs, -1);
    EXPECT_EQ(files(), std::vector<std::string>{"a.gml"});

    opened(file); // GDAL alone leaves a.gfs, without references
    ASSERT_EQ(files().size(), 2U);
    EXPECT_EQ(rivers_of(file).lines.at(0).runs, -1);
}

} // namespace river_layers_test
