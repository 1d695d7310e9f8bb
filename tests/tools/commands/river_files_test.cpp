// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Files of rivers as their publishers make them: every line is found again, on the arcs or in layer secondary.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/vector_files.hpp>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>

#include "command.hpp"

namespace river_files_test {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

using Place = std::pair<double, double>;

/// A GeoJSON file of lines in EPSG:32631 (or in degrees) and their attributes.
class Lines {
public:
    explicit Lines(bool degrees = false) : degrees_(degrees) {}

    void add(std::vector<Place> const& line, json properties) {
        json coordinates = json::array();
        for (auto const& [x, y] : line) {
            coordinates.push_back({x, y});
        }
        features_.push_back({{"type", "Feature"},
                             {"properties", std::move(properties)},
                             {"geometry", {{"type", "LineString"}, {"coordinates", coordinates}}}});
    }
    std::int64_t count() const { return static_cast<std::int64_t>(features_.size()); }
    std::string text() const {
        json file{{"type", "FeatureCollection"}, {"features", features_}};
        if (!degrees_) {
            file["crs"] = {{"type", "name"}, {"properties", {{"name", "urn:ogc:def:crs:EPSG::32631"}}}};
        }
        return file.dump();
    }

private:
    bool degrees_;
    json features_ = json::array();
};

std::set<std::int64_t> features_in(fs::path const& gpkg, char const* layer) {
    std::set<std::int64_t> found;
    auto const data = opened(gpkg);
    OGRLayer* const rows = data == nullptr ? nullptr : data->GetLayerByName(layer);
    if (rows != nullptr) {
        for (auto const& row : *rows) {
            found.insert(row->GetFieldAsInteger64("feature"));
        }
    }
    return found;
}

std::multiset<std::string> texts_of(fs::path const& gpkg, char const* layer, char const* field) {
    std::multiset<std::string> texts;
    auto const data = opened(gpkg);
    for (auto const& row : *data->GetLayerByName(layer)) {
        texts.insert(row->GetFieldAsString(field));
    }
    return texts;
}

/// Every arc that came from the file is made of its lines without gaps, but for what an outlet was extended by.
void expect_sources_cover_arcs(fs::path const& gpkg) {
    using Row = std::pair<double, double>;
    std::map<std::int64_t, std::vector<Row>> rows;
    auto const data = opened(gpkg);
    ASSERT_NE(data->GetLayerByName("sources"), nullptr) << gpkg;
    for (auto const& row : *data->GetLayerByName("sources")) {
        rows[row->GetFieldAsInteger64("arc_id")].emplace_back(row->GetFieldAsDouble("from_m"),
                                                              row->GetFieldAsDouble("to_m"));
    }
    for (auto const& arc : *data->GetLayerByName("arcs")) {
        if (arc->GetFieldAsInteger64("feature") == 0) {
            continue;
        }
        std::int64_t const id = arc->GetFieldAsInteger64("arc_id");
        double const length = arc->GetFieldAsDouble("length");
        double at = 0.0;
        for (auto const& [from, to] : rows[id]) {
            EXPECT_NEAR(from, at, 1e-6 * length) << "arc " << id << " of " << gpkg;
            EXPECT_LT(from, to) << "arc " << id << " of " << gpkg;
            at = to;
        }
        if (arc->GetFieldAsInteger64("ds_arc") != 0) {
            EXPECT_NEAR(at, length, 1e-6 * length) << "arc " << id << " of " << gpkg;
        }
    }
}

/// The lines beside the main path, and why; what the terrain took away aside.
std::set<std::pair<std::int64_t, std::string>> beside(fs::path const& gpkg) {
    std::set<std::pair<std::int64_t, std::string>> found;
    auto const data = opened(gpkg);
    OGRLayer* const rows = data == nullptr ? nullptr : data->GetLayerByName("secondary");
    if (rows != nullptr) {
        for (auto const& row : *rows) {
            std::string const reason = row->GetFieldAsString("reason");
            if (reason != "cut at its head" && reason != "pruned") {
                found.emplace(row->GetFieldAsInteger64("feature"), reason);
            }
        }
    }
    return found;
}

/// Every feature from 1 to count is on the arcs or in secondary.
void expect_all_found(fs::path const& gpkg, std::int64_t count) {
    auto found = features_in(gpkg, "sources");
    for (char const* const layer : {"arcs", "secondary"}) {
        found.merge(features_in(gpkg, layer));
    }
    for (std::int64_t f = 1; f <= count; ++f) {
        EXPECT_TRUE(found.contains(f)) << "feature " << f << " of " << gpkg;
    }
}

/// check --fix: every line is found again in the mended copy, which has no faults and the main path of make.
void mended(Workplace const& place, std::string const& input, std::int64_t count) {
    Outcome const fixed = thalweg_run("check '" + input + "' --fix mended.gpkg --json", place.path());
    EXPECT_TRUE(fixed.code == 0 || fixed.code == 3) << fixed.err;
    ASSERT_TRUE(fs::exists(place / "mended.gpkg")) << fixed.out;
    expect_run(place, "check mended.gpkg", 0);
    expect_all_found(place / "mended.gpkg", count);
    expect_sources_cover_arcs(place / "mended.gpkg");
    EXPECT_EQ(beside(place / "mended.gpkg"), beside(place / "out/network.gpkg"));
}

/// make, check, check --fix: exit 0, 0, and a mended copy without faults. Gives the report.
json made(Workplace const& place, std::string const& input, std::int64_t count, std::string const& options = "") {
    expect_run(place, "make '" + input + "' -o out" + options, 0);
    json const report = report_of(place / "out");
    expect_checks_hold(report);
    expect_all_found(place / "out/network.gpkg", count);
    expect_sources_cover_arcs(place / "out/network.gpkg");
    expect_run(place, "convert out -o split.gpkg --max-upstream 2", 0);
    expect_sources_cover_arcs(place / "split.gpkg");
    expect_run(place, "check out --dem out/dem.tif", 0);
    mended(place, input, count);
    return report;
}

/// A river from north to south with side streams.
constexpr double mouth_m = 0.0;
constexpr double head_m = 8000.0;
double bend(double y) {
    return 200.0 * ((static_cast<std::int64_t>(y) / 1000) % 2 == 0 ? 1.0 : -1.0);
}

Lines braided() {
    Lines lines;
    std::vector<Place> main;
    for (double y = head_m; y >= mouth_m; y -= 500.0) {
        main.emplace_back(bend(y), y);
    }
    for (std::size_t i = 1; i < main.size(); ++i) {
        lines.add({main[i - 1], main[i]}, {{"id", i}, {"name", "Braid"}});
    }
    // Channels beside it, two of them on the same reach, one with a bar in it.
    for (std::size_t i = 3; i + 3 < main.size(); i += 4) {
        double const side = i % 8 == 3 ? 900.0 : -900.0;
        Place const out{main[i].first + side, 0.5 * (main[i].second + main[i + 2].second)};
        lines.add({main[i], {0.5 * (main[i].first + out.first), out.second + 300.0}, out}, {{"id", 100 + i}});
        lines.add({out, {out.first, out.second - 250.0}, main[i + 2]}, {{"id", 200 + i}});
        if (i % 8 == 3) {
            lines.add({out, {out.first + 250.0, out.second - 200.0}, {out.first, out.second - 250.0}},
                      {{"id", 300 + i}});
            lines.add({{out.first + 2500.0, out.second + 500.0}, out}, {{"id", 400 + i}, {"name", "Side"}});
        }
    }
    return lines;
}

/// Like OpenStreetMap: ways split at random, some drawn upstream, a canal, a culvert, a ditch and a pond.
Lines from_osm(std::uint64_t seed) {
    Lines lines;
    std::int64_t way = 1000;
    auto const add = [&](std::vector<Place> const& course, std::string const& name) {
        std::vector<Place> part{course.front()};
        for (std::size_t i = 1; i < course.size(); ++i) {
            part.push_back(course[i]);
            ++way;
            bool const ends = i + 1 == course.size() ||
                              thalweg::unit(thalweg::random_word(seed, static_cast<std::uint64_t>(way))) < 0.3;
            if (ends) {
                if (thalweg::unit(thalweg::random_word(seed + 1, static_cast<std::uint64_t>(way))) < 0.1) {
                    std::reverse(part.begin(), part.end());
                }
                lines.add(part, {{"osm_id", std::to_string(way)}, {"waterway", "river"}, {"name", name}});
                part = {course[i]};
            }
        }
    };
    std::vector<Place> main;
    for (double y = head_m; y >= mouth_m; y -= 250.0) {
        main.emplace_back(bend(y), y);
    }
    add(main, "Main");
    for (std::size_t k = 4; k < main.size(); k += 6) {
        double const side = k % 4 == 0 ? 1.0 : -1.0;
        std::vector<Place> course;
        for (double x = 3000.0; x > 0.0; x -= 400.0) {
            course.emplace_back(main[k].first + side * x, main[k].second + 0.3 * x);
        }
        course.push_back(main[k]);
        add(course, "Side " + std::to_string(k));
    }
    lines.add({{-3000, 1000}, {0, 1200}, {3000, 1100}}, {{"osm_id", "1"}, {"waterway", "canal"}});
    lines.add({{-2500, 700}, {-2000, 300}}, {{"osm_id", "2"}, {"waterway", "ditch"}});
    lines.add({{2000, 700}, {2500, 300}}, {{"osm_id", "3"}, {"waterway", "stream"}, {"tunnel", "flooded"}});
    lines.add({{2600, 6800}, {2900, 6800}, {2900, 7000}, {2600, 7000}, {2600, 6800}},
              {{"osm_id", "4"}, {"waterway", "stream"}});
    return lines;
}

/// Like HydroRIVERS: in degrees, a tree by NEXT_DOWN, vertices at the centres of cells of 15 arc seconds.
Lines from_hydrorivers() {
    Lines lines(true);
    constexpr double cell = 1.0 / 240.0;
    auto const at = [&](int col, int row) { return Place{6.0 + (col + 0.5) * cell, 46.0 + (row + 0.5) * cell}; };
    std::int64_t const first = 20000001;
    for (int k = 0; k < 12; ++k) { // the main stem, each reach 3 cells long
        std::vector<Place> reach;
        for (int i = 0; i <= 3; ++i) {
            reach.push_back(at(20 + (k * 3 + i) % 2, 60 - (k * 3 + i)));
        }
        lines.add(reach, {{"HYRIV_ID", first + k},
                          {"NEXT_DOWN", k == 11 ? 0 : first + k + 1},
                          {"MAIN_RIV", first + 11},
                          {"LENGTH_KM", 1.4},
                          {"UPLAND_SKM", 30.0 + 10.0 * k},
                          {"DIS_AV_CMS", 0.5 + 0.1 * k},
                          {"ORD_STRA", k == 0 ? 1 : 2}});
    }
    for (int k = 1; k < 12; ++k) { // a side stream into the upper end of each
        std::vector<Place> reach;
        int const row = 60 - 3 * k;
        int const end = 20 + (3 * k) % 2;
        int const side = k % 2 == 0 ? 1 : -1;
        for (int i = 9; i >= 0; --i) {
            reach.push_back(at(end + side * i, row + i / 2));
        }
        lines.add(reach, {{"HYRIV_ID", first + 100 + k},
                          {"NEXT_DOWN", first + k},
                          {"MAIN_RIV", first + 11},
                          {"LENGTH_KM", 3.0},
                          {"UPLAND_SKM", 12.0},
                          {"DIS_AV_CMS", 0.1},
                          {"ORD_STRA", 1}});
    }
    return lines;
}

/// Like EU-Hydro: links by text ids; one reach drawn upstream, a channel beside the main one, and null lines.
Lines from_eu_hydro() {
    Lines lines;
    auto const id = [](int k) { return "RL00" + std::to_string(1000 + k); };
    for (int k = 0; k < 8; ++k) {
        std::vector<Place> reach{{bend(8000.0 - 1000.0 * k), 8000.0 - 1000.0 * k},
                                 {100.0, 7500.0 - 1000.0 * k},
                                 {bend(7000.0 - 1000.0 * k), 7000.0 - 1000.0 * k}};
        if (k == 4) {
            std::reverse(reach.begin(), reach.end());
        }
        lines.add(reach, {{"OBJECT_ID", id(k)}, {"NEXTDOWNID", k == 7 ? "" : id(k + 1)}, {"STRAHLER", 2}});
    }
    lines.add({{bend(6000), 6000}, {1500, 5500}, {bend(5000), 5000}},
              {{"OBJECT_ID", id(50)}, {"NEXTDOWNID", id(3)}, {"STRAHLER", 1}});
    lines.add({{4000, 4500}, {2000, 4200}, {bend(4000), 4000}},
              {{"OBJECT_ID", id(60)}, {"NEXTDOWNID", id(4)}, {"STRAHLER", 1}});
    return lines;
}

std::string const coarse = " --set grid.cell=100";

/// Length [m] of the longest straight stretch of any arc.
double longest_straight_run(fs::path const& path) {
    double longest = 0.0;
    auto const data = opened(path);
    for (auto const& row : *data->GetLayerByName("arcs")) {
        OGRLineString const& line = *row->GetGeometryRef()->toLineString();
        double run = 0.0;
        double heading = 0.0;
        for (int i = 1; i < line.getNumPoints(); ++i) {
            double const dx = line.getX(i) - line.getX(i - 1);
            double const dy = line.getY(i) - line.getY(i - 1);
            double const here = std::atan2(dy, dx);
            run = i > 1 && std::fabs(here - heading) < 1e-6 ? run + std::hypot(dx, dy) : std::hypot(dx, dy);
            heading = here;
            longest = std::max(longest, run);
        }
    }
    return longest;
}

double share_without_data(fs::path const& path) {
    auto const data = opened(path);
    GDALRasterBand& band = *data->GetRasterBand(1);
    int const width = band.GetXSize();
    int const height = band.GetYSize();
    std::vector<float> z(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    EXPECT_EQ(band.RasterIO(GF_Read, 0, 0, width, height, z.data(), width, height, GDT_Float32, 0, 0, nullptr),
              CE_None);
    auto const nodata = static_cast<float>(band.GetNoDataValue());
    auto const holes = std::count_if(z.begin(), z.end(), [&](float v) { return std::isnan(v) || v == nodata; });
    return static_cast<double>(holes) / static_cast<double>(z.size());
}

} // namespace

TEST(RiverFiles, NhdPlusWithDivergencesAndCoastlines) {
    std::string const coastal = samples + "coastal_nhdplus.gpkg";
    Workplace const place;
    json const report = made(place, coastal, 572, " --set grid.cell=90");
    ASSERT_TRUE(report.contains("shortened_fields"));
    std::map<std::string, int> reasons;
    auto const data = opened(place / "out/network.gpkg");
    OGRLayer* const secondary = data->GetLayerByName("secondary");
    ASSERT_NE(secondary, nullptr);
    for (auto const& row : *secondary) {
        ++reasons[row->GetFieldAsString("reason")];
        EXPECT_GT(row->GetFieldAsInteger64("COMID"), 0);
        bool const is_minor = std::string(row->GetFieldAsString("reason")) == "minor channel";
        EXPECT_TRUE(!is_minor || row->GetFieldAsInteger("Divergence") == 2) << row->GetFieldAsInteger64("COMID");
    }
    EXPECT_EQ(reasons["FTYPE Coastline"], 37);
    EXPECT_GE(reasons["minor channel"], 5);
    // COMID of every arc is that of its feature: the row of the file.
    auto const source = opened(coastal);
    std::vector<std::int64_t> comid{0};
    for (auto const& row : *source->GetLayer(0)) {
        comid.push_back(row->GetFieldAsInteger64("COMID"));
    }
    for (auto const& arc : *data->GetLayerByName("arcs")) {
        auto const feature = static_cast<std::size_t>(arc->GetFieldAsInteger64("feature"));
        ASSERT_LT(feature, comid.size());
        EXPECT_EQ(arc->GetFieldAsInteger64("COMID"), comid[feature]);
        EXPECT_EQ(arc->IsFieldNull(arc->GetFieldIndex("gnis_name")) != 0,
                  std::string(arc->GetFieldAsString("gnis_name")).empty());
    }
    expect_run(place, "replay out --verify", 0);
    // The sea begins at the coastlines: rivers end there, not on the border behind it.
    double carried_m = 0.0;
    for (json const& repair : report.at("repairs")) {
        carried_m += repair.at("kind") == "carried_outlet" ? repair.at("amount").get<double>() : 0.0;
    }
    EXPECT_LT(carried_m, 5000.0);
    EXPECT_LT(longest_straight_run(place / "out/network.gpkg"), 30.0 * 90.0);
    EXPECT_NEAR(share_without_data(place / "out/dem.tif"), 0.37, 0.02);
}

TEST(RiverFiles, OutletsOfAFileWithoutCoastlinesAreCarriedWithAWarningOrMakeACoast) {
    Workplace const place;
    std::string const coastal = samples + "coastal_nhdplus.gpkg";
    std::string const without = "make '" + coastal + "' --set grid.cell=90 --set network.lines.coastlines=none -o ";
    expect_run(place, without + "carried", 0, "29 rivers", "network.inland=coast");
    Outcome const coast = expect_run(place, without + "coast --set network.inland=coast", 0);
    EXPECT_FALSE(test::has(coast.err, "network.inland=coast"));
    EXPECT_NEAR(share_without_data(place / "coast/dem.tif"), 0.37, 0.04); // as the coastlines say
    expect_run(place, "check coast/network.gpkg --dem coast/dem.tif", 0);
    expect_run(place, "replay coast --verify", 0);
}

TEST(RiverFiles, TheMendedCopyOfNhdPlusKeepsItsColumns) {
    Workplace const place;
    std::string const coastal = samples + "coastal_nhdplus.gpkg";
    expect_run(place, "check '" + coastal + "' --fix mended.gpkg", 3);
    ASSERT_TRUE(fs::exists(place / "mended.gpkg"));
    expect_run(place, "check mended.gpkg", 0);
    expect_all_found(place / "mended.gpkg", 572);
    auto const data = opened(place / "mended.gpkg");
    EXPECT_GE(data->GetLayerByName("arcs")->GetLayerDefn()->GetFieldIndex("COMID"), 0);
    expect_run(place, "convert mended.gpkg -o again.shp", 0);
    auto const again = opened(place / "again_arcs.shp");
    ASSERT_NE(again, nullptr);
    EXPECT_GE(again->GetLayer(0)->GetLayerDefn()->GetFieldIndex("COMID"), 0);
}

TEST(RiverFiles, ABraidedRiver) {
    Workplace const place;
    Lines const lines = braided();
    place.write("braided.geojson", lines.text());
    made(place, "braided.geojson", lines.count(), coarse);
    EXPECT_FALSE(features_in(place / "out/network.gpkg", "secondary").empty());
    expect_refused(place, "make braided.geojson -o no", {"--set network.lines.divergences=error"});
}

TEST(RiverFiles, WaysOfOpenStreetMap) {
    for (std::uint64_t const seed : {1U, 2U, 3U}) {
        Workplace const place;
        Lines const lines = from_osm(seed);
        place.write("osm.geojson", lines.text());
        made(place, "osm.geojson", lines.count(), coarse);
        auto const reasons = texts_of(place / "out/network.gpkg", "secondary", "reason");
        for (char const* const reason : {"waterway canal", "waterway ditch", "tunnel flooded", "closed ring"}) {
            EXPECT_EQ(reasons.count(reason), 1U) << reason;
        }
        // Without a mended copy the links are asked for.
        expect_run(place, "check osm.geojson", 2);
    }
}

TEST(RiverFiles, OfAnExtractOfOpenStreetMapTheRiversAreRead) {
    Workplace const place;
    std::string extract = R"(<?xml version="1.0"?><osm version="0.6">)";
    std::string river;
    for (int i = 1; i <= 40; ++i) {
        std::string const id = std::to_string(i);
        extract += "<node id=\"" + id + "\" version=\"1\" lat=\"47." + std::to_string(1000 + i * 10) + "\" lon=\"9.0" +
                   std::to_string(10 + i % 2) + "\"/>";
        river += "<nd ref=\"" + id + "\"/>";
    }
    auto const way = [&](char const* id, char const* tag) {
        return "<way id=\"" + std::string(id) + "\" version=\"1\">" + river + "<tag " + tag + "/></way>";
    };
    place.write("extract.osm", extract + way("1", R"(k="waterway" v="river")") + way("2", R"(k="power" v="line")") +
                                   way("3", R"(k="ref" v="1")") + "</osm>");
    expect_run(place, "make extract.osm -o out" + std::string(coarse), 0, "1 lines from extract.osm");
    EXPECT_EQ(texts_of(place / "out/network.gpkg", "secondary", "reason"),
              (std::multiset<std::string>{"no waterway", "power line"}));
    EXPECT_EQ(std::distance(fs::directory_iterator(place.path()), fs::directory_iterator()), 2);
}

TEST(RiverFiles, RiversRunThroughLakesOfAnExtract) {
    // Two ways along one meridian, and between their ends a square of water; a wood beside it.
    Workplace const place;
    std::vector<std::pair<double, double>> const nodes{{47.20, 9.01},  {47.16, 9.011}, {47.12, 9.01}, {47.10, 9.01},
                                                       {47.06, 9.011}, {47.02, 9.01},  {47.12, 9.00}, {47.10, 9.00},
                                                       {47.10, 9.02},  {47.12, 9.02},  {47.10, 9.03}};
    std::string extract = R"(<?xml version="1.0"?><osm version="0.6">)";
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        extract += "<node id=\"" + std::to_string(i + 1) + "\" version=\"1\" lat=\"" + std::to_string(nodes[i].first) +
                   "\" lon=\"" + std::to_string(nodes[i].second) + "\"/>";
    }
    auto const way = [](char const* id, std::vector<int> const& of, char const* tag) {
        std::string text = "<way id=\"" + std::string(id) + "\" version=\"1\">";
        for (int const node : of) {
            text += "<nd ref=\"" + std::to_string(node) + "\"/>";
        }
        return text + "<tag " + tag + "/></way>";
    };
    extract += way("1", {1, 2, 3}, R"(k="waterway" v="river")") + way("2", {4, 5, 6}, R"(k="waterway" v="river")") +
               way("3", {3, 7, 8, 4, 9, 10, 3}, R"(k="natural" v="water")") +
               way("4", {9, 11, 10, 9}, R"(k="natural" v="wood")") + "</osm>";
    place.write("extract.osm", extract);
    expect_run(place, "make extract.osm -o out" + std::string(coarse), 0, "1 arcs");
    expect_run(place, "replay out --verify", 0);
}

TEST(RiverFiles, WaysInSeveralPartsAreMended) {
    Workplace const place;
    place.write("parts.geojson", test::geojson(test::feature("MultiLineString",
                                                             "[[[0,8000],[0,4000]],[[3000,8000],[2000,6000],[0,4000]]]",
                                                             R"("name":"a")") +
                                               "," + test::line("[0,4000],[0,0]", R"("name":"b")")));
    made(place, "parts.geojson", 2, coarse);
    EXPECT_EQ(texts_of(place / "mended.gpkg", "arcs", "name"), (std::multiset<std::string>{"a", "a", "b"}));
}

TEST(RiverFiles, HydroRivers) {
    Workplace const place;
    Lines const lines = from_hydrorivers();
    place.write("hydrorivers.geojson", lines.text());
    made(place, "hydrorivers.geojson", lines.count(), coarse);
    expect_run(place, "check hydrorivers.geojson", 0);
}

TEST(RiverFiles, EuHydro) {
    Workplace const place;
    Lines const lines = from_eu_hydro();
    place.write("euhydro.geojson", lines.text());
    json const report = made(place, "euhydro.geojson", lines.count(), coarse);
    EXPECT_EQ(features_in(place / "out/network.gpkg", "secondary"), (std::set<std::int64_t>{9}));
    bool turned = false;
    for (auto const& repair : report["repairs"]) {
        turned = turned || (repair["kind"] == "reversed" && repair["feature"] == 5);
    }
    EXPECT_TRUE(turned);
}

TEST(RiverFiles, NamesOfColumnsAndNull) {
    Workplace const place;
    Lines lines;
    lines.add({{0, 8000}, {3000, 4000}},
              {{"slope", 7}, {"a_very_long_name", "x"}, {"a_very_long_one", 2.5}, {"empty", nullptr}, {"fid", 9}});
    lines.add({{3000, 4000}, {0, 0}}, {{"slope", 8}, {"a_very_long_name", nullptr}, {"a_very_long_one", 1e12}});
    place.write("l.geojson", lines.text());
    json const report = made(place, "l.geojson", 2, coarse);
    EXPECT_EQ(report["shortened_fields"].size(), 2U) << report["shortened_fields"];
    auto const gpkg = opened(place / "out/network.gpkg");
    auto const arc = gpkg->GetLayerByName("arcs")->GetNextFeature();
    ASSERT_NE(arc, nullptr);
    EXPECT_EQ(arc->GetFieldAsInteger("u_slope"), arc->GetFieldAsInteger("feature") + 6);
    OGRFeature::DestroyFeature(arc);
    auto const shp = opened(place / "out/network_arcs.shp");
    EXPECT_GE(shp->GetLayer(0)->GetLayerDefn()->GetFieldIndex("a_very_lon"), 0);
    EXPECT_GE(shp->GetLayer(0)->GetLayerDefn()->GetFieldIndex("a_very_l_2"), 0);
    expect_run(place, "convert out/network.gpkg -o c.gpkg", 0);
    auto const converted = opened(place / "c.gpkg");
    EXPECT_GE(converted->GetLayerByName("arcs")->GetLayerDefn()->GetFieldIndex("u_slope"), 0);
    expect_all_found(place / "c.gpkg", 2);
}

TEST(RiverFiles, SmallDefectsAreLeftOutAndReported) {
    Workplace const place;
    place.write("defects.geojson",
                test::geojson(R"({"type":"Feature","properties":{},"geometry":null},)" + test::line("") + "," +
                              test::line("[5,5],[5,5]") + "," + test::line("[0,8000],[3000,0]")));
    expect_run(place, "make defects.geojson -o out" + coarse, 0);
    json const report = report_of(place / "out");
    std::set<std::int64_t> left_out;
    for (auto const& repair : report["repairs"]) {
        if (repair["kind"] == "left_out") {
            left_out.insert(repair["feature"].get<std::int64_t>());
        }
    }
    EXPECT_EQ(left_out, (std::set<std::int64_t>{1, 2, 3}));
    EXPECT_EQ(features_in(place / "out/network.gpkg", "arcs"), (std::set<std::int64_t>{4}));
}

namespace {

/// Two rivers that end at a lake and one that leaves it; with the lake's outline among the lines, or without.
std::string around_a_lake(std::string const& properties_of_lake) {
    Lines lines;
    lines.add({{500000, 4405000}, {500000, 4403000}}, {{"id", 1}});
    lines.add({{502500, 4403500}, {500300, 4402750}}, {{"id", 2}});
    lines.add({{500000, 4402400}, {500100, 4400000}}, {{"id", 3}});
    lines.add({{498000, 4401000}, {500050, 4401200}}, {{"id", 5}});
    json file = json::parse(lines.text());
    if (!properties_of_lake.empty()) {
        json ring = json::array();
        for (auto const& [x, y] : {Place{499700, 4402700}, Place{500000, 4402400}, Place{500300, 4402700},
                                   Place{500300, 4402800}, Place{500000, 4403000}, Place{499700, 4402700}}) {
            ring.push_back({x, y});
        }
        file["features"].push_back({{"type", "Feature"},
                                    {"properties", json::parse(properties_of_lake)},
                                    {"geometry", {{"type", "Polygon"}, {"coordinates", json::array({ring})}}}});
    }
    return file.dump();
}

} // namespace

TEST(RiverFiles, RiversRunThroughLakesOfTheFile) {
    Workplace const place;
    place.write("bare.geojson", around_a_lake(""));
    place.write("lake.geojson", around_a_lake(R"({"id": 4})"));
    place.write("forest.geojson", around_a_lake(R"({"osm_id": "4", "natural": "wood"})"));
    std::string const make = " --set grid.cell=25 --set surface.method=dilate -o ";
    Outcome const bare =
        expect_run(place, "make bare.geojson" + make + "bare", 0, "2 rivers end at 1 place", "[lake_without_outline]");
    EXPECT_EQ(report_of(place / "bare")["network"]["outlets"], 3);
    expect_run(place, "make forest.geojson" + make + "forest", 0, "[lake_without_outline]");
    Outcome const lake = expect_run(place, "make lake.geojson" + make + "lake", 0);
    EXPECT_EQ(lake.err.find("lake_without_outline"), std::string::npos) << lake.err;
    json const report = report_of(place / "lake");
    EXPECT_EQ(report["network"]["outlets"], 1);
    expect_checks_hold(report);
    expect_run(place, "check lake -q", 0);
    expect_run(place, "replay lake --verify", 0);
    // The outline of another file, which also lies level.
    json only = json::parse(around_a_lake(R"({"id": 4})"));
    only["features"] = json::array({only["features"].back()});
    place.write("outline.geojson", only.dump());
    expect_run(place, "make bare.geojson --set grid.cell=25 --set surface.lakes=outline.geojson -o level", 0);
    EXPECT_EQ(report_of(place / "level")["network"]["outlets"], 1);
    EXPECT_TRUE(fs::exists(place / "level/lakes.tif"));
    expect_run(place, "replay level --verify", 0);
}

namespace {

/// Heights of the vertices of all arcs in their order, as far as the file gives them.
std::vector<double> heights_of_given(fs::path const& gpkg, std::set<std::pair<double, double>> const& at) {
    std::vector<double> heights;
    auto const data = opened(gpkg);
    for (auto const& arc : *data->GetLayerByName("arcs")) {
        for (OGRPoint const& v : *arc->GetGeometryRef()->toLineString()) {
            if (at.contains({v.getX(), v.getY()})) {
                heights.push_back(v.getZ());
            }
        }
    }
    return heights;
}

} // namespace

TEST(RiverFiles, KeysOfOpenStreetMapAreFoundAmongItsTags) {
    Workplace const place;
    std::string const text = R"("type":"way","tags":{)";
    auto const way = [&](char const* vertices, char const* tags) { return test::line(vertices, text + tags + "}"); };
    place.write(
        "tags.geojson",
        test::geojson(way("[500000,5000000],[510000,5000100],[520000,5000000]", R"("natural":"coastline")") + "," +
                      way("[510000,5010000],[510000,5005000],[510000,5000100]", R"("waterway":"river","name":"Alma")") +
                      "," + way("[505000,5009000],[510000,5005000]", R"("waterway":"stream")") + "," +
                      way("[515000,5002000],[515000,5006000]", R"("tunnel":"flooded")")));
    Outcome const made =
        expect_run(place, "make tags.geojson --only dem,network --set network.lines.type_field=waterway -o out", 0,
                   "1 coastlines");
    EXPECT_EQ(report_of(place / "out")["network"]["outlets"], 1);
    EXPECT_EQ(texts_of(place / "out/network.gpkg", "arcs", "type"),
              (std::multiset<std::string>{"river", "river", "stream"}));
    EXPECT_EQ(texts_of(place / "out/network.gpkg", "secondary", "reason"),
              (std::multiset<std::string>{"natural coastline", "tunnel flooded"}));
    expect_run(place, "make tags.geojson --set network.lines.type_field=waterwax -o no", 2, "has no field 'waterwax'");
}

TEST(RiverFiles, HeightsAreMissingWhereAToolCutALine) {
    Workplace const place;
    std::string const above =
        test::line("[500000,5010000,900],[500000,5005000,700],[500000,5000000]", R"("linkno":1,"dslinkno":2)");
    std::string const below =
        test::line("[500000,5000000],[500000,4995000,300],[500000,4990000,200]", R"("linkno":2,"dslinkno":-1)");
    std::string const beside =
        test::line("[509000,5004000,800],[504000,5002000,600],[500000,5000000,500]", R"("linkno":3,"dslinkno":2)");
    place.write("split.geojson", test::geojson(above + "," + below));
    place.write("tributary.geojson", test::geojson(above + "," + below + "," + beside));
    place.write("both.geojson",
                test::geojson(test::line("[500000,5010000],[500000,5005000,700],[500000,5000000]") + "," +
                              test::line("[500000,5000000],[500000,4995000,300],[500000,4990000]")));
    place.write("first.geojson",
                test::geojson(test::line("[500000,5010000],[500000,5005000,700],[500000,5000000,500]")));
    std::set<std::pair<double, double>> const south{
        {500000.0, 4995000.0}, {500000.0, 5005000.0}, {500000.0, 5000000.0}};
    for (auto const& [name, missing, middle] : {std::tuple{"split", 2, 500.0}, std::tuple{"tributary", 2, 500.0},
                                                std::tuple{"both", 4, 500.0}, std::tuple{"first", 1, 500.0}}) {
        SCOPED_TRACE(name);
        std::string const file = fmt::format("{}.geojson", name);
        Outcome const made =
            expect_run(place, fmt::format("make {} --only dem,network -o {}", file, name), 0,
                       fmt::format("count as missing (vertices: {}; the first is of feature 1", missing));
        EXPECT_EQ(made.err.find("reversed"), std::string::npos) << made.err;
        json const report = report_of(place / name);
        EXPECT_EQ(report["network"]["outlets"], 1);
        std::vector<double> const heights = heights_of_given(place / name / "network.gpkg", south);
        ASSERT_GE(heights.size(), 2U);
        EXPECT_NEAR(heights[0], 700.0, 1e-3);
        EXPECT_NEAR(heights[1], middle, 1e-3);
    }
    expect_run(place, "tin tributary.geojson -o mesh.obj", 0, "[placeholder_heights]");
    std::string const mesh = file_bytes(place / "mesh.obj");
    EXPECT_NE(mesh.find("v 500000 5000000 500\n"), std::string::npos) << mesh;
    Outcome const fixed = expect_run(place, "check split.geojson --fix fixed.gpkg", 3);
    EXPECT_TRUE(test::has(fixed.out, "arc 1: heights of 0 count as missing", "2 in all")) << fixed.out;
    EXPECT_NEAR(heights_of_given(place / "fixed.gpkg", south)[1], 500.0, 1e-9);
    // One height is left.
    std::string const last = R"("linkno":1,"dslinkno":-1)";
    place.write("one.geojson",
                test::geojson(test::line("[500000,5010000],[500000,5005000,700],[500000,5000000]", last)));
    expect_run(place, "check one.geojson --fix one.gpkg", 3);
    EXPECT_EQ(heights_of_given(place / "one.gpkg", south), (std::vector<double>{700, 700}));
    // A mouth may lie at 0.
    place.write("mouth.geojson",
                test::geojson(test::line("[500000,5010000,90],[500000,5005000,40],[500000,5000000,0]")));
    Outcome const mouth = expect_run(place, "make mouth.geojson --only dem,network -o mouth", 0);
    EXPECT_EQ(mouth.err.find("placeholder_heights"), std::string::npos) << mouth.err;
    EXPECT_NEAR(heights_of_given(place / "mouth/network.gpkg", south)[1], 0.0, 1e-3);
}

TEST(RiverFiles, OfOtherProgramsAreReadByEveryCommand) {
    Workplace const place;
    std::string const upper = test::line("[500000,5002000,90],[500500,5001000,60]", R"("nr":11,"into":14)");
    std::string const beside = test::line("[502000,5002000,80],[500500,5001000,60]", R"("nr":12,"into":14)");
    std::string const lower = test::line("[500500,5001000,60],[500400,5000000,20]", R"("nr":14,"into":0)");
    place.write("rivers.geojson", test::geojson(upper + "," + beside + "," + lower));
    place.shell("mkdir zipped && ogr2ogr zipped/rivers.shp rivers.geojson && cd zipped && "
                "python3 -c \"import shutil; shutil.make_archive('../rivers', 'zip', '.')\"");
    place.shell(
        "ogr2ogr -f GeoJSON one.geojson rivers.geojson -dialect sqlite -sql 'SELECT ST_Collect(geometry) FROM rivers'");
    std::string const links = " --field arc_id=nr --field ds_arc=into";
    Outcome const zipped = expect_run(place, "check rivers.zip" + links, 0);
    EXPECT_TRUE(test::has(zipped.out, "3 arcs")) << zipped.out;
    for (std::string const file : {"rivers.zip", "one.geojson"}) {
        expect_run(place, "tin " + file + " --overwrite -o mesh.obj", 0);
    }
    // One and the same height is none, and that is said.
    std::string level = file_bytes(place / "rivers.geojson");
    for (std::string const z : {",90]", ",60]", ",80]", ",20]"}) {
        for (std::size_t at = level.find(z); at != std::string::npos; at = level.find(z)) {
            level.replace(at, z.size(), ",5.5]");
        }
    }
    place.write("level.geojson", level);
    expect_run(place, "make level.geojson --only network -o level", 0,
               "same_heights all heights of level.geojson are 5.5 m: they count as none");
}

TEST(RiverFiles, ANetcdfIsNotReadByTheHeaderBesideIt) {
    Workplace const place;
    place.shell("gdal_create -q -of GTiff -outsize 64 48 -bands 1 -burn 105 -ot Int16 -a_srs EPSG:32631 "
                "-a_ullr 500000 5000000 501920 4998560 one.tif && gdal_translate -q -of netCDF one.tif dem.nc && "
                "gdal_translate -q -of ENVI one.tif dem.bil");
    Outcome const stats = expect_run(place, "stats dem.nc --json", 0);
    EXPECT_TRUE(test::has(stats.out, "105")) << stats.out;
}

} // namespace river_files_test
