// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Point clouds: read_points() of LAS.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/sources/sources.hpp>

#include "las_files.hpp"
#include "scratch_folder.hpp"

namespace las_test {

using namespace thalweg;
using las_files::bytes_of;
using las_files::File;
using las_files::keys;
using las_files::Point;
using test::error_of;
using test::has;

namespace {

constexpr int most_points = 1000000;

/// Three points of the ground and one of each other sort.
std::vector<Point> few_points() {
    return {{{500000.25, 4000000.5, 101.75}, 2}, {{500010, 4000000, 102}, 2},      {{500000, 4000010, 103}, 8},
            {{500005, 4000005, 131}, 5},         {{500006, 4000005, 99}, 9},       {{500007, 4000005, 850}, 7},
            {{500008, 4000005, -700}, 18},       {{500009, 4000005, 104}, 2, true}};
}

File utm(std::vector<Point> points) {
    return {.points = std::move(points), .records = {keys({{1024, 1}, {3072, 32631}})}};
}

FeaturePoints read(std::string const& bytes, io::ReadPointsParams params = {}, std::string const& name = "a.las") {
    ScratchFolder const folder;
    folder.write(name, bytes);
    params.path = folder / name;
    return io::read_points(params);
}

FeaturePoints read(File const& file, io::ReadPointsParams const& params = {}) {
    return read(bytes_of(file), params);
}

std::string refusal(std::string const& bytes, io::ReadPointsParams const& params = {},
                    std::string const& name = "a.las") {
    return error_of([&] { read(bytes, params, name); });
}

std::vector<std::string> kinds_of(FeaturePoints const& points) {
    std::vector<std::string> kinds;
    for (Finding const& f : points.findings) {
        kinds.emplace_back(f.kind.name());
    }
    return kinds;
}

/// Points at random in a box, the same on any machine.
std::vector<Point> random_points(int count, double wide, double tall) {
    std::vector<Point> points;
    for (int i = 0; i < count; ++i) {
        auto const at = [&](std::uint64_t axis) {
            return std::floor(100.0 * unit(random_word(axis, static_cast<std::uint64_t>(i))) *
                              (axis == 1 ? wide : tall)) /
                   100.0;
        };
        points.push_back({{500000.0 + at(1), 4000000.0 + at(2), std::floor(at(3))}, 2});
    }
    return points;
}

} // namespace

TEST(ReadLas, EveryVersionAndPointFormat) {
    std::vector<Vec3> const ground{{500000.25, 4000000.5, 101.75}, {500010, 4000000, 102}, {500000, 4000010, 103}};
    for (int minor = 0; minor <= 4; ++minor) {
        for (int format = 0; format <= 10; ++format) {
            for (int const extra_bytes : {0, 7}) {
                File file = utm(few_points());
                file.minor = minor;
                file.format = format;
                file.extra_bytes = extra_bytes;
                file.offset = {400000, 3000000, 0};
                if (minor < 4 && format >= 6) { // whose counts have 64 bits
                    continue;
                }
                FeaturePoints const points = read(file);
                EXPECT_EQ(points.points, ground) << minor << " " << format;
                EXPECT_EQ(points.crs, "EPSG:32631");
                EXPECT_EQ(kinds_of(points), std::vector<std::string>{"cloud_classes"});
            }
        }
    }
}

TEST(ReadLas, WhatWasWrittenIsReadBack) {
    ScratchFolder const folder;
    FeaturePoints points{{}, "EPSG:32631"};
    for (Point const& p : random_points(500, 900.0, 800.0)) {
        points.points.push_back(p.at);
    }
    io::write_points(points, folder / "a.las");
    FeaturePoints const back = io::read_points({folder / "a.las"});
    ASSERT_EQ(back.points.size(), points.points.size());
    EXPECT_EQ(back.crs, "EPSG:32631");
    for (std::size_t i = 0; i < points.points.size(); ++i) {
        EXPECT_LE(distance(in_plan(back.points[i]), in_plan(points.points[i])), 0.0008) << i;
        EXPECT_NEAR(back.points[i].z, points.points[i].z, 0.0005 + 1e-9) << i;
    }
}

TEST(ReadLas, ClassesAreChosen) {
    File const file = utm(few_points());
    auto const heights = [&](char const* classes) {
        std::vector<double> z;
        for (Vec3 const& p : read(file, {.classes = classes}).points) {
            z.push_back(p.z);
        }
        return z;
    };
    EXPECT_EQ(heights(""), (std::vector<double>{101.75, 102, 103}));
    EXPECT_EQ(heights("ground"), heights(""));
    EXPECT_EQ(heights("all"), (std::vector<double>{101.75, 102, 103, 131, 99}));
    EXPECT_EQ(heights("water"), std::vector<double>{99});
    EXPECT_EQ(heights("5, water"), (std::vector<double>{131, 99}));
    EXPECT_EQ(heights("2,7,18"), (std::vector<double>{101.75, 102, 850, -700}));
    std::string const bytes = bytes_of(file);
    for (char const* const wrong : {"256", "-1", "2,", ",", "2.5", "2;9", "trees"}) {
        EXPECT_TRUE(has(refusal(bytes, {.classes = wrong}), "BadParameter io.read_points", "is not a class")) << wrong;
    }
    EXPECT_TRUE(has(refusal(bytes, {.classes = "groud"}), "Did you mean 'ground'?"));
    EXPECT_TRUE(has(refusal(bytes, {.classes = "6"}), "BadInput io.read_points: a.las has no points of the classes 6",
                    "class 2 (2 points), class 5 (1), class 7 (1)", "--classes"));
    ScratchFolder const folder;
    folder.write("a.csv", "x,y,z\n1,2,3\n");
    for (io::ReadPointsParams const& params : {io::ReadPointsParams{.path = folder / "a.csv", .classes = "2"},
                                               io::ReadPointsParams{.path = folder / "a.csv", .thin_m = 2.0}}) {
        EXPECT_TRUE(has(error_of([&] { io::read_points(params); }), "BadParameter", "a.csv is not a point cloud"));
    }
}

TEST(ReadLas, ACloudWithoutClassesIsTakenWithAWarning) {
    std::vector<Point> points = few_points();
    for (Point& p : points) {
        p.kind = p.kind == 7 || p.kind == 18 ? p.kind : p.kind % 2;
    }
    FeaturePoints const all = read(utm(points));
    EXPECT_EQ(all.points.size(), 5U);
    EXPECT_EQ(kinds_of(all), std::vector<std::string>{"cloud_unclassified"});
    EXPECT_TRUE(has(refusal(bytes_of(utm(points)), {.classes = "ground"}), "no points of the classes ground"));
    points[3].kind = 6; // somebody has classified it, but not its ground
    std::string const words = refusal(bytes_of(utm(points)));
    EXPECT_TRUE(has(words, "has no points of ground (classes 2 and 8), but of class 0 (", "class 6 (1)"));
    EXPECT_FALSE(has(words, "--classes")) << "not an option of this caller";
    for (Point& p : points) {
        p.is_withheld = true;
    }
    EXPECT_TRUE(has(refusal(bytes_of(utm(points))), "all 8 points of a.las are marked as withheld"));
    EXPECT_TRUE(has(refusal(bytes_of(utm({}))), "a.las holds no points"));
}

TEST(ReadLas, CrsOfKeysAndOfText) {
    std::string const wkt =
        R"(COMPD_CS["both",PROJCS["WGS 84 / UTM zone 32N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,)"
        R"(298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],)"
        R"(PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],)"
        R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1],AUTHORITY["EPSG","32632"]],)"
        R"(VERT_CS["heights",VERT_DATUM["unknown",2005],UNIT["foot",0.3048]]])";
    auto const record = keys({{1024, 1}, {3072, 32631}});
    las_files::Record const text{2112, wkt + '\0'};
    File file = utm(few_points());
    file.records = {{7, "something else", "LAStools"}, record, text};
    EXPECT_EQ(read(file).crs, "EPSG:32631") << "the header says that keys hold";
    file.is_wkt = true;
    FeaturePoints const points = read(file);
    EXPECT_EQ(points.crs, "EPSG:32632");
    EXPECT_EQ(points.points[1].z, 102 * 0.3048);
    EXPECT_EQ(kinds_of(points), (std::vector<std::string>{"cloud_classes", "heights_in_metres"}));
    file.records = {text};
    file.is_wkt = false;
    EXPECT_EQ(read(file).crs, "EPSG:32632") << "there is nothing else";
    file.records = {};
    file.long_records = {{1, "waveforms", "LASF_Spec"}, text};
    file.minor = 4;
    file.format = 6;
    file.is_wkt = true;
    EXPECT_EQ(read(file).crs, "EPSG:32632");
    file.long_records = {{2112, "PROJCS[\"nonsense\""}};
    EXPECT_TRUE(has(refusal(bytes_of(file)), "BadInput io.read_points: the CRS of a.las (OGC WKT) is not understood"));
    file.is_wkt = false;
    file.long_records = {keys({{1024, 1}, {3072, 32631}})};
    file.long_records[0].data.pop_back();
    EXPECT_TRUE(has(refusal(bytes_of(file)), "the CRS of a.las (GeoTIFF keys) is not understood"));
}

TEST(ReadLas, FeetInPlanAndOfHeights) {
    constexpr double foot_m = 1200.0 / 3937.0;
    std::vector<Point> const points{
        {{2000000, 600000, 1000}, 2}, {{2000100, 600000, 1010}, 2}, {{2000000, 600100, 990}, 2}};
    // North Carolina in US survey feet; heights of NAVD88 in these feet, as a system or by their unit alone.
    for (auto const& vertical : {std::array{4096, 6360}, std::array{4099, 9003}}) {
        File file = utm(points);
        file.records = {keys({{1024, 1}, {3072, 2264}, {vertical[0], vertical[1]}})};
        FeaturePoints const read_in = read(file);
        EXPECT_EQ(read_in.crs, "EPSG:32617");
        EXPECT_NEAR(read_in.points[0].z, 1000 * foot_m, 1e-9) << vertical[0];
        EXPECT_NEAR(distance(in_plan(read_in.points[0]), in_plan(read_in.points[1])), 100 * foot_m, 0.05);
        EXPECT_EQ(kinds_of(read_in), (std::vector<std::string>{"cloud_classes", "heights_in_metres"}));
        EXPECT_TRUE(has(read_in.findings[1].text, "heights of a.las in US survey feet are converted"));
        // Cells are in metres: 100 feet are one of 200 m.
        EXPECT_EQ(read(file, {.thin_m = 20.0}).points.size(), 3U);
        EXPECT_LE(read(file, {.thin_m = 200.0}).points.size(), 2U);
    }
    File plain = utm(points);
    plain.records = {keys({{1024, 1}, {3072, 2264}})};
    FeaturePoints const unnamed = read(plain);
    EXPECT_EQ(unnamed.points[0].z, 1000.0);
    EXPECT_TRUE(has(unnamed.findings.back().text, "names no unit of its heights: they count as metres"));
}

TEST(ReadLas, WithoutACrsAsTextIs) {
    File file = utm(few_points());
    file.records = {};
    EXPECT_EQ(read(file).crs, "");
    EXPECT_EQ(read(file, {.crs = "EPSG:32633"}).crs, "EPSG:32633");
    EXPECT_EQ(read(file, {.source_crs = "EPSG:32633"}).crs, "EPSG:32633");
    file.points = {{{9.001, 45.001, 100}, 2}, {{9.002, 45.001, 120}, 2}, {{9.001, 45.002, 140}, 2}};
    file.scale = 1e-6;
    EXPECT_TRUE(has(refusal(bytes_of(file), {.source_crs = ""}), "longitudes and latitudes"));
    EXPECT_EQ(read(file, {.source_crs = "EPSG:4326"}).crs, "EPSG:32632");
    EXPECT_EQ(read(file, {.source_crs = "EPSG:4326", .thin_m = 10.0}).points.size(), 3U) << "metres, not degrees";
    EXPECT_EQ(read(file, {.source_crs = "EPSG:4326", .thin_m = 10000.0}).points.size(), 1U);
}

TEST(ReadLas, HeightsThatStandForNoData) {
    std::vector<Point> points = random_points(20, 100.0, 100.0);
    points[3].at.z = -9999.0;
    File const file = utm(points);
    EXPECT_TRUE(has(refusal(bytes_of(file)), "1 of 20 points of a.las have the height -9999"));
    for (double const thin_m : {0.0, 0.01}) {
        FeaturePoints const some = read(file, {.nodata = -9999.0, .thin_m = thin_m});
        EXPECT_EQ(some.points.size(), 19U);
        EXPECT_EQ(some.left_out, 1);
    }
    EXPECT_EQ(read(file, {.heights = io::PointHeights::passed_over}).points.size(), 20U);
}

// Law: what is kept is that of a slow search over all points, in whatever order they stand in the file.
TEST(ReadLas, ThinningKeepsTheMiddleOfEachCell) {
    std::vector<Point> points = random_points(3000, 120.0, 70.0);
    points.push_back({{500001, 4000001, 7}, 2}); // ties: all around the centre of a cell of 4 m
    points.push_back({{500003, 4000001, 7}, 2});
    points.push_back({{500001, 4000003, 7}, 2});
    points.push_back({{500001, 4000003, 6}, 2});
    for (double const side_m : {4.0, 0.5, 33.0}) {
        std::map<std::pair<double, double>, Vec3> wanted;
        auto const order = [&](Vec3 const& p) {
            double const x = p.x / side_m - std::floor(p.x / side_m) - 0.5;
            double const y = p.y / side_m - std::floor(p.y / side_m) - 0.5;
            return std::tuple(x * x + y * y, p.x, p.y, p.z);
        };
        for (Point const& p : points) {
            auto const [at, is_new] =
                wanted.emplace(std::pair(std::floor(p.at.y / side_m), std::floor(p.at.x / side_m)), p.at);
            if (!is_new && order(p.at) < order(at->second)) {
                at->second = p.at;
            }
        }
        std::vector<Vec3> kept;
        for (auto const& [cell, p] : wanted) {
            kept.push_back(p);
        }
        File file = utm(points);
        file.offset = {500000, 4000000, 0};
        FeaturePoints const thin = read(file, {.thin_m = side_m});
        ASSERT_EQ(thin.points, kept) << side_m;
        EXPECT_EQ(thin.findings.back().kind, "cloud_thinned");
        EXPECT_EQ(thin.findings.back().amount, side_m);
        std::ranges::reverse(file.points);
        std::ranges::rotate(file.points, file.points.begin() + 1234);
        EXPECT_EQ(read(file, {.thin_m = side_m}).points, kept);
    }
    std::string const bytes = bytes_of(utm(points));
    EXPECT_EQ(read(bytes, {.duplicates = io::DuplicatePoints::averaged, .thin_m = 0.0}).points.size(), points.size());
    for (double const wrong :
         {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_TRUE(has(refusal(bytes, {.thin_m = wrong}), "BadParameter", "thin"));
    }
    EXPECT_TRUE(has(refusal(bytes, {.thin_m = 1e-9}), "BadParameter", "such cells wide"));
}

// By default a million points stay at most: here of a strip across a large box.
TEST(ReadLas, ALargeCloudIsThinnedToAMillion) {
    File file = utm({});
    file.minor = 1;
    constexpr int count = most_points + 200000;
    for (int i = 0; i < count; ++i) {
        double const along = 3000.0 * unit(random_word(1, static_cast<std::uint64_t>(i)));
        double const across = 100.0 * unit(random_word(2, static_cast<std::uint64_t>(i)));
        file.points.push_back({{500000.0 + along + across, 4000000.0 + along - across, 5.0}, 2});
    }
    FeaturePoints const thin = read(file);
    ASSERT_EQ(thin.findings.size(), 2U);
    EXPECT_EQ(thin.findings[1].amount, 1.0);
    EXPECT_LE(thin.points.size(), static_cast<std::size_t>(most_points));
    EXPECT_GE(thin.points.size(), static_cast<std::size_t>(most_points / 4));
    EXPECT_TRUE(has(thin.findings[1].text, "1200000 points of a.las are thinned to", "one in each cell of 1 m"));
    file.points.resize(most_points);
    EXPECT_EQ(read(file).points.size(), static_cast<std::size_t>(most_points));
}

TEST(ReadLas, BadHeadersAreRefusedWithWhatIsWrong) {
    using las_files::with;
    File four = utm(few_points());
    four.minor = 4;
    four.format = 7;
    four.long_records = {{2112, "x"}};
    std::string const old = bytes_of(utm(few_points()));
    std::string const latest = bytes_of(four);
    double const nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::tuple<std::string, char const*, char const*>> const cases{
        {with(old, 0, 'X'), "is not LAS", "does not begin with LASF"},
        {with(old, 24, char{2}), "is LAS 2.2", "1.0 to 1.4 are read"},
        {with(old, 25, char{5}), "is LAS 1.5", "pdal translate"},
        {with(old, 94, std::uint16_t{226}), "the header of a.las is 226 bytes long", "copy it again"},
        {with(old, 25, char{4}), "the header of a.las is 227 bytes long", "375"},
        {with(old, 96, std::uint32_t{200}), "begin at byte 200", "the header ends at 227"},
        {with(old, 96, std::uint32_t{4000000000U}), "begin at byte 4000000000", "the file at"},
        {with(old, 100, std::uint32_t{2}), "variable-length record 2 of 2", "copy it again"},
        {with(old, 100, std::uint32_t{4000000000U}), "variable-length record 2 of 4000000000", "copy it again"},
        {with(old, 104, char{11}), "have format 11", "there are 0 to 10"},
        {with(old, 105, std::uint16_t{19}), "are 19 bytes long", "at least 20"},
        {with(old, 105, std::uint16_t{0}), "are 0 bytes long", "at least 20"},
        {with(old, 107, std::uint32_t{9}), "has room for 8 points, and its header says 9", "copy it again"},
        {with(old, 131, 0.0), "x scale of 0", "write it again"},
        {with(old, 139, nan), "y scale of nan", "write it again"},
        {with(old, 147, -0.01), "z scale of -0.01", "write it again"},
        {with(old, 155, std::numeric_limits<double>::infinity()), "offset of inf", "write it again"},
        {with(old, 227 + 20, std::uint16_t{60000}), "variable-length record 1 of 1", "at byte 227"},
        {with(latest, 247, std::uint64_t{1} << 60U), "has room for", "1152921504606846976"},
        {with(latest, 235, std::uint64_t{1} << 62U), "variable-length record 1 of 1", "at byte 4611686018427387904"},
        {with(latest, 243, std::uint32_t{3}), "variable-length record 2 of 3", "copy it again"},
        {with(latest, latest.size() - 41, std::uint64_t{1} << 63U), "variable-length record 1 of 1", "copy it again"}};
    EXPECT_EQ(refusal(old), "");
    EXPECT_EQ(refusal(latest), "");
    for (auto const& [bytes, what, remedy] : cases) {
        EXPECT_TRUE(has(refusal(bytes), "BadInput io.read_points", "a.las", what, remedy));
    }
}

// Law: a file cut off anywhere is refused, and nothing else happens.
TEST(ReadLas, AFileCutOffAnywhereIsRefused) {
    File four = utm(few_points());
    four.minor = 4;
    four.format = 6;
    four.long_records = {keys({{1024, 1}, {3072, 32632}})};
    ScratchFolder const folder;
    for (std::string const& bytes : {bytes_of(utm(few_points())), bytes_of(four)}) {
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            folder.write("a.las", bytes.substr(0, size));
            EXPECT_TRUE(has(error_of([&] { io::read_points({folder / "a.las"}); }), "BadInput io.")) << size;
        }
    }
}

// Law: a file with any byte changed is read or refused.
TEST(ReadLas, AFileWithAnyByteChangedIsReadOrRefused) {
    File four = utm(few_points());
    four.minor = 4;
    four.format = 6;
    std::string const bytes = bytes_of(four);
    ScratchFolder const folder;
    for (std::size_t at = 0; at < 375 + 54 + 24; ++at) {
        for (char const value : {'\x00', '\x7f', '\xff'}) {
            folder.write("a.las", las_files::with(bytes, at, value));
            std::string const words = error_of([&] { io::read_points({.path = folder / "a.las", .thin_m = 1.0}); });
            EXPECT_TRUE(words.empty() || has(words, "io.")) << at;
        }
    }
}

TEST(ReadLas, CloudsAreKnownByTheirContent) {
    ScratchFolder const folder;
    std::string const bytes = bytes_of(utm(few_points()));
    for (char const* const name : {"a.las", "b", "c.LAZ", "d.copc.laz", "e.bin"}) {
        folder.write(name, bytes);
        EXPECT_EQ(io::content_of(folder / name).kind, io::FileContent::Kind::points) << name;
        EXPECT_TRUE(io::is_point_cloud(folder / name));
        EXPECT_EQ(io::read_points({folder / name}).points.size(), 3U);
        EXPECT_EQ(io::read_points({{folder / name, io::Access::recipe}}).points.size(), 3U);
    }
    folder.write("f.las", "x,y,z\n1,2,3\n");
    EXPECT_TRUE(has(error_of([&] { io::read_points({folder / "f.las"}); }), "BadInput io.read_points", "f.las"));
    folder.write("a scan.e57", "ASTM-E57" + std::string(40, '\0'));
    for (std::string const& words : {error_of([&] { io::content_of(folder / "a scan.e57"); }),
                                     error_of([&] { io::read_points({folder / "a scan.e57"}); })}) {
        EXPECT_TRUE(has(words, "BadInput", "is E57", "pdal translate '", "a scan.las'"));
    }
    EXPECT_FALSE(io::is_point_cloud(folder.path().string()));
    EXPECT_FALSE(io::is_point_cloud(folder / "nowhere.las"));
    EXPECT_TRUE(has(error_of([&] { io::read_points({.path = folder / "a.las", .height_column = "z"}); }),
                    "BadParameter", "a.las is a point cloud"));
    EXPECT_TRUE(has(error_of([&] { io::read_points({.path = folder / "a.las", .columns = "1,2,3"}); }), "BadParameter",
                    "is not text of points"));
}

TEST(ReadLas, StopsWhenAsked) {
    ScratchFolder const folder;
    folder.write("a.las", bytes_of(utm(few_points())));
    EXPECT_THROW(io::read_points({folder / "a.las"}, test::stopped_run()), Cancelled);
}

} // namespace las_test
