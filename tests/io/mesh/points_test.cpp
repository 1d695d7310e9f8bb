// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/points.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/sources/sources.hpp>

#include "full_disk.hpp"
#include "point_files.hpp"
#include "vector_files.hpp"

namespace points_test {

using namespace thalweg;
using io::FileContent;
using io::PointFormat;
using io::read_points;
using io::write_points;

namespace {

using test::error_of;
using test::frame_below;
using test::has;

std::string text_file(ScratchFolder const& folder, std::string const& name, std::string const& text) {
    folder.write(name, text);
    return folder / name;
}

std::string refusal(io::ReadPointsParams const& params) {
    return error_of([&] { read_points(params); });
}

std::vector<Vec3> points_of(std::string const& name, std::string const& text) {
    ScratchFolder const folder;
    return read_points({text_file(folder, name, text)}).points;
}

/// A layer of shapes, with a field of heights where one is named.
std::string layer(ScratchFolder const& folder, std::vector<ForeignLayer::Row> const& shapes, int epsg = 32631,
                  char const* field = "") {
    return written(folder, "p.gpkg",
                   {{.name = "spots", .type = wkbUnknown, .epsg = epsg, .fields = field, .rows = shapes}});
}

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// Heights that do not end in binary, a hole in every eleventh cell.
Raster<float> land(std::int64_t width = 13, std::int64_t height = 7, double cell_m = 2.5) {
    Raster<float> z(Grid{width, height, cell_m, 300000.1, 5200000.7, "EPSG:32631"});
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        z[i] = i % 11 == 4 ? none
                           : static_cast<float>(1000.0 * unit(random_word(1, static_cast<std::uint64_t>(i)))) - 50.0F;
    }
    return z;
}

/// The cells a file of a raster shall hold, one of so many rows and columns.
std::vector<Vec3> cells_of(Raster<float> const& z, std::int64_t every = 1) {
    std::vector<Vec3> points;
    for (std::int64_t row = 0; row < z.height(); ++row) {
        for (std::int64_t col = 0; col < z.width(); ++col) {
            Cell const cell{col, row};
            if (row % every == 0 && col % every == 0 && !std::isnan(z[cell])) {
                Vec2 const at = z.grid().centre(cell);
                points.push_back({at.x, at.y, static_cast<double>(z[cell])});
            }
        }
    }
    return points;
}

void expect_near(std::vector<Vec3> const& found, std::vector<Vec3> const& wanted, double within) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].x, wanted[i].x, within) << i;
        EXPECT_NEAR(found[i].y, wanted[i].y, within) << i;
        EXPECT_NEAR(found[i].z, wanted[i].z, within) << i;
    }
}

std::vector<PointFormat> formats() {
    return {PointFormat::las, PointFormat::ply, PointFormat::xyz};
}

} // namespace

TEST(ReadPoints, TextInEveryManner) {
    std::vector<Vec3> const wanted{{1.5, -2, 3e2}, {0.1, 4, 5}};
    EXPECT_EQ(points_of("a.csv", "x,y,z\n1.5,-2,3e2\n0.1,4,5\n"), wanted);
    EXPECT_EQ(points_of("a.csv", "\xEF\xBB\xBFid;Z;\"Y\";X\r\n7;3e2;-2;1.5\r\n8; 5 ;4;+0.1"), wanted);
    EXPECT_EQ(points_of("a.csv", "1.5,-2,3e2\n\n# a remark\n0.1,4,5\n"), wanted);
    EXPECT_EQ(points_of("a.xyz", "  1.5\t-2   300 \n0.1 4 5\n"), wanted);
    EXPECT_EQ(points_of("a.TXT", "x y z\n1.5 -2 300\n0.1 4 5\n"), wanted);
}

TEST(ReadPoints, BadTextNamesItsLine) {
    for (auto const& [text, words] :
         std::vector<std::pair<std::string, std::string>>{{"", "p.csv"},
                                                          {"x,y,z\n", "p.csv"},
                                                          {"x,y,h\n1,2,3\n", "first line: no column 'z'"},
                                                          {"x,y,z\n1,2,3\n1,2,three\n", "line 3: z is 'three'"},
                                                          {"1,2,3\n1,nan,3\n", "line 2: y is 'nan'"},
                                                          {"1,2,3\n#\n-inf,2,3\n", "line 3: x is '-inf'"},
                                                          {"1,2,3\n1,2,1e999\n", "line 2: z is '1e999'"},
                                                          {"1,2,3\n1,2\n", "line 2: 2 of the columns, z is missing"},
                                                          {"1,2,3\n1,,3\n", "line 2: y is ''"},
                                                          {"1,2,3\n1,2,3,4\n", "line 2: 4 columns"},
                                                          {"1,5000000.0,500000.0,210.5\n", "line 1: 4 columns"}}) {
        ScratchFolder const folder;
        std::string const words_of_error = refusal({text_file(folder, "p.csv", text)});
        EXPECT_TRUE(has(words_of_error, "BadInput io.read_points", words)) << text;
        EXPECT_FALSE(has(words_of_error, "--columns")) << "not an option of this caller";
    }
    EXPECT_TRUE(has(refusal({"nowhere.csv"}), "BadInput", "nowhere.csv"));
}

TEST(ReadPoints, ColumnsAreNamedOrNumbered) {
    ScratchFolder const folder;
    std::string const bare = text_file(folder, "p.csv", "1,5000000.0,500000.0,210.5\n2,5000100.0,500900.0,180.2\n");
    std::string const named = text_file(folder, "q.csv",
                                        "Punkt;Hoch;Rechts;H;Art\n1;5000000;500000;210.5;Baum\n"
                                        "2;5000100;500900;180.2;\n");
    std::vector<Vec3> const wanted{{500000, 5000000, 210.5}, {500900, 5000100, 180.2}};
    for (auto const& [path, columns] : std::vector<std::pair<std::string, std::string>>{{bare, "3,2,4"},
                                                                                        {bare, "PNEZD"},
                                                                                        {bare, "3 2 4"},
                                                                                        {named, "3 2 4"},
                                                                                        {named, "Rechts,Hoch,H"},
                                                                                        {named, "rechts,2,h"},
                                                                                        {named, "pnezd"}}) {
        EXPECT_EQ(read_points({.path = path, .columns = columns}).points, wanted) << columns;
    }
    for (auto const& [columns, words] : std::vector<std::pair<std::string, std::string>>{
             {"", "BadInput"},
             {"x,y,z", "BadInput io.read_points: q.csv, first line: no column 'x'"},
             {"3,2,9", "line 2: 5 of the columns, z is missing"},
             {"3,2,5", "line 2: z is 'Baum'"},
             {"3,2", "BadParameter"},
             {"1,2,3,4", "BadParameter"},
             {"x,,z", "BadParameter"},
             {"penz", "BadParameter"}}) {
        EXPECT_TRUE(has(refusal({.path = named, .columns = columns}), words)) << columns;
    }
    EXPECT_TRUE(has(refusal({.path = bare, .columns = ""}), "--columns 3,2,4"));
    auto const words = text_file(folder, "n.txt", "7 5000000 500000 210.5 old oak\n");
    EXPECT_EQ(read_points({.path = words, .columns = "pnezd"}).points, (std::vector<Vec3>{wanted[0]}));
    EXPECT_TRUE(has(refusal({.path = layer(folder, {{"POINT Z (1 2 3)"}}), .columns = "pnezd"}), "BadParameter"));
}

TEST(ReadPoints, DegreesNeedACrs) {
    ScratchFolder const folder;
    auto const text = text_file(folder, "p.csv", "x,y,z\n10.96,47.12,700\n11,47.05,650\n");
    EXPECT_TRUE(has(refusal({.path = text, .source_crs = ""}), "BadInput io.read_points", "p.csv"));
    EXPECT_EQ(read_points({.path = text, .source_crs = "EPSG:4326"}).crs, "EPSG:32632");
    EXPECT_EQ(read_points({.path = text, .crs = "EPSG:32632", .source_crs = ""}).points[0].x, 10.96);
    EXPECT_EQ(read_points({.path = text}).points[0].x, 10.96); // the caller says what they are
    for (char const* const metres : {"1,2,3\n0,1,2\n", "10.5,90.5,3\n", "180.5,45.5,1\n10.5,45.5,1\n"}) {
        EXPECT_NO_THROW(read_points({.path = text_file(folder, "m.csv", metres), .source_crs = ""})) << metres;
    }
}

TEST(ReadPoints, TextTakesTheCrsAsked) {
    ScratchFolder const folder;
    std::string const path = text_file(folder, "a.xyz", "1 2 3\n");
    EXPECT_EQ(read_points({path}).crs, "");
    EXPECT_EQ(read_points({path, {}, "z", "EPSG:32632"}).crs, "EPSG:32632");
    EXPECT_TRUE(has(refusal({path, {}, "z", "EPSG:4326"}), "4326"));
}

TEST(ReadPoints, LayersGiveTheirZOrAField) {
    ScratchFolder const folder;
    auto const read = read_points({layer(folder, {{"POINT Z (1.25 2 3)"}, {"MULTIPOINT Z (4 5 6, 7 8 9)"}})});
    EXPECT_EQ(read.points, (std::vector<Vec3>{{1.25, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    EXPECT_EQ(read.crs, "EPSG:32631");
    for (char const* const field : {"z:r", "z:s"}) {
        auto const fields = read_points({layer(folder, {{"POINT (1 2)", "3.5"}, {"POINT (4 5)", "-6"}}, 32631, field)});
        EXPECT_EQ(fields.points, (std::vector<Vec3>{{1, 2, 3.5}, {4, 5, -6}}));
    }
}

TEST(ReadPoints, OthersAreProjectedToTheirZone) {
    struct Case {
        int epsg;
        std::vector<ForeignLayer::Row> points;
        std::string crs;
        Vec2 apart; ///< [m] from the first to the second
    };
    for (auto const& [epsg, points, crs, apart] : {
             Case{4326, {{"POINT Z (3 0 7)"}, {"POINT Z (3 0.001 8)"}}, "EPSG:32631", {0.0, 110.53}},
             Case{3857, // at 45 degrees north
                  {{"POINT Z (333958.4724 5621521.486 7)"}, {"POINT Z (333958.4724 5622521.486 8)"}},
                  "EPSG:32631",
                  {0.0, 707.0}},
             Case{4326, // on both sides of the antimeridian, 0.02 degrees at 16 degrees south
                  {{"POINT Z (179.99 -16 7)"}, {"POINT Z (-179.99 -16 8)"}},
                  "EPSG:32701",
                  {2140.0, 0.0}},
         }) {
        ScratchFolder const folder;
        std::string const path = layer(folder, points, epsg);
        auto const read = read_points({path});
        EXPECT_EQ(read.crs, crs);
        EXPECT_EQ(read.points[0].z, 7.0);
        EXPECT_NEAR(read.points[1].x - read.points[0].x, apart.x, 0.01 + 0.003 * apart.x);
        EXPECT_NEAR(read.points[1].y - read.points[0].y, apart.y, apart.x > 0.0 ? 60.0 : 0.003 * apart.y);
        EXPECT_EQ(read_points({path, {}, "z", "EPSG:32632"}).crs, "EPSG:32632");
    }
    ScratchFolder const folder;
    auto const zone = read_points({layer(folder, {{"POINT Z (3 0 7)"}}, 4326)});
    EXPECT_EQ(zone.points[0], (Vec3{500000, 0, 7}));
    auto const kept =
        read_points({layer(folder, {{"POINT Z (333958.4724 5621521.486 7)"}}, 3857), {}, "z", "EPSG:3857"});
    EXPECT_EQ(kept.points[0].x, 333958.4724);
}

TEST(ReadPoints, BadLayersNameTheFeature) {
    struct Case {
        std::string words;
        std::vector<ForeignLayer::Row> shapes;
        char const* field = "";
        int epsg = 32631;
    };
    for (auto const& [words, shapes, field, epsg] : {
             Case{"p.gpkg", {}},
             Case{"feature 1 of p.gpkg has no height", {{"POINT (1 2)"}}},
             Case{"feature 2 of p.gpkg has no height", {{"POINT (1 2)", "5"}, {"POINT (1 2)"}}, "z:r"},
             Case{"z is 'high'", {{"POINT (1 2)", "high"}}, "z:s"},
             Case{"feature 1", {{"LINESTRING (1 2, 3 4)", "5"}}, "z:r"},
             Case{"feature 1", {{"POINT EMPTY", "5"}}, "z:r"},
             Case{"no CRS", {{"POINT Z (1 2 3)"}}, "", 0},
         }) {
        ScratchFolder const folder;
        EXPECT_TRUE(has(refusal({layer(folder, shapes, epsg, field)}), "BadInput io.read_points", words));
    }
    EXPECT_TRUE(has(refusal({"nowhere.gpkg"}), "BadInput", "nowhere.gpkg"));
    ScratchFolder const folder;
    EXPECT_TRUE(has(refusal({layer(folder, {}, 0), "other"}), "BadInput", "(spots)"));
}

TEST(ReadPoints, FeaturesAreCountedFromOne) {
    ScratchFolder const folder;
    auto const feature = [](std::string const& z) {
        return R"({"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2)" + z + "]}}";
    };
    auto const path = text_file(folder, "p.geojson", test::geojson(feature(",3") + "," + feature("")));
    EXPECT_TRUE(has(refusal({path}), "feature 2 of p.geojson has no height")); // which GDAL calls 1
}

TEST(ReadPoints, UnequalHeightsAtOnePlace) {
    ScratchFolder const folder;
    io::ReadPointsParams params{.path = text_file(folder, "p.csv", "5,5,1\n7,7,4\n5,5,2\n7,7,4\n5,5,6\n")};
    EXPECT_TRUE(has(refusal(params), "points 1 and 3 of p.csv lie both at"));
    params.duplicates = io::DuplicatePoints::averaged;
    FeaturePoints const read = read_points(params);
    EXPECT_EQ(read.points, (std::vector<Vec3>{{5, 5, 3}, {7, 7, 4}, {5, 5, 3}, {7, 7, 4}, {5, 5, 3}}));
    EXPECT_EQ(read.averaged, 1);
    EXPECT_EQ(read.averaged_dz_m, 5.0);
    std::string text;
    for (int i = 0; i < 8; ++i) {
        text += std::to_string(80 - i) + ",0,1\n" + std::to_string(80 - i) + ",0,2\n";
    }
    std::string const many = refusal({text_file(folder, "q.csv", text)});
    EXPECT_TRUE(has(many, "q.csv has 8 places", "points 1 and 2 of q.csv lie both at (80, 0)", "points 9 and 10"));
    EXPECT_FALSE(has(many, "points 11 and 12"));
}

TEST(ReadPoints, InPlanTheyNeedNoHeights) {
    ScratchFolder const folder;
    thalweg::io::ReadPointsParams params;
    params.heights = thalweg::io::PointHeights::passed_over;
    params.path = text_file(folder, "a.csv", "y,x\n2,1\n5,4\n");
    std::vector<Vec3> const wanted{{1, 2, 0}, {4, 5, 0}};
    EXPECT_EQ(read_points(params).points, wanted);
    params.path = text_file(folder, "a.xyz", "1 2 3\n4 5 high\n");
    EXPECT_EQ(read_points(params).points, wanted);
    params.path = layer(folder, {{"POINT (1 2)"}, {"POINT Z (4 5 6)"}});
    EXPECT_EQ(read_points(params).points, wanted);
    params.path = text_file(folder, "b.csv", "1\n");
    EXPECT_TRUE(has(refusal(params), "line 1: 1 of the columns, y is missing"));
}

TEST(ReadPoints, ACrsThatIsMissingCanBeNamed) {
    ScratchFolder const folder;
    auto const text = text_file(folder, "a.csv", "x,y,z\n9,0,100\n9.5,1,200\n");
    auto const moved = read_points({.path = text, .source_crs = "EPSG:4326"});
    EXPECT_EQ(moved.crs, "EPSG:32632"); // whose central meridian is 9 degrees east
    EXPECT_NEAR(moved.points[0].x, 500000.0, 1e-3);
    EXPECT_NEAR(moved.points[0].y, 0.0, 1e-3);
    EXPECT_EQ(moved.points[1].z, 200.0);
    EXPECT_EQ(read_points({.path = text, .crs = "EPSG:32631", .source_crs = "EPSG:4326"}).crs, "EPSG:32631");
    EXPECT_TRUE(has(refusal({.path = text, .source_crs = "here"}), "BadInput", "'here'"));
    auto const bare = layer(folder, {{"POINT Z (9 0 3)"}}, 0);
    EXPECT_TRUE(has(refusal({.path = bare, .source_crs = ""}), "BadInput", "--source-crs"));
    EXPECT_NEAR(read_points({.path = bare, .source_crs = "EPSG:4326"}).points[0].x, 500000.0, 1e-3);
    auto const asked = read_points({bare, {}, "z", "EPSG:32632"}); // which it then has
    EXPECT_EQ(asked.crs, "EPSG:32632");
    EXPECT_EQ(asked.points[0], (Vec3{9, 0, 3}));
}

TEST(ContentOf, TellsWhatAFileHolds) {
    ScratchFolder const folder;
    EXPECT_EQ(io::content_of(text_file(folder, "a.xyz", "")).kind, FileContent::Kind::points);
    EXPECT_EQ(io::content_of(text_file(folder, "a.pgm", "P5 1 1 255\na")).kind, FileContent::Kind::raster);
    EXPECT_EQ(io::content_of(layer(folder, {{"POINT (1 2)"}}, 0)).kind, FileContent::Kind::points);
    EXPECT_EQ(io::content_of(layer(folder, {{"LINESTRING (1 2, 3 4)"}}, 0)).kind, FileContent::Kind::lines);
    ScratchFolder const empty;
    for (std::string const& path : {empty.path().string(), // no network.gpkg in it
                                    std::string("nowhere.csv"), text_file(folder, "a.tif", "no raster"),
                                    layer(folder, {{"POLYGON ((0 0, 1 0, 0 1, 0 0))"}}, 0)}) {
        EXPECT_THROW(io::content_of(path), BadInput) << path;
    }
}

TEST(WritePoints, FormatsByNameAndEnding) {
    EXPECT_EQ(io::point_format("", "a/b.las"), PointFormat::las);
    EXPECT_EQ(io::point_format("", "B.PLY"), PointFormat::ply);
    EXPECT_EQ(io::point_format("xyz", "b.las"), PointFormat::xyz);
    EXPECT_THROW(io::point_format("", "b.laz"), BadParameter);
    EXPECT_THROW(io::point_format("", "las"), BadParameter);
    EXPECT_THROW(io::point_format("laz", "b.las"), BadParameter);
}

TEST(WritePoints, NothingAndWrongNumbersAreRefused) {
    ScratchFolder const folder;
    for (PointFormat const format : formats()) {
        auto const refused = [&](auto const& what, std::int64_t every = 1) {
            return error_of([&] { write_points(what, folder / "points", {.format = format, .every = every}); });
        };
        EXPECT_TRUE(has(refused(FeaturePoints{}), "BadInput io.write_points"));
        EXPECT_TRUE(has(refused(Raster<float>()), "BadInput io.write_points"));
        EXPECT_TRUE(has(refused(Raster<float>(frame_below(2, 2), none)), "BadInput io.write_points"));
        EXPECT_TRUE(has(refused(FeaturePoints{{{1, 2, 3}, {1, NAN, 3}}, ""}), "BadInput", "point 2"));
        Raster<float> endless(frame_below(2, 2), 1.0F);
        endless[3] = std::numeric_limits<float>::infinity();
        EXPECT_TRUE(has(refused(endless), "BadInput", "(1.5, -1.5)"));
        EXPECT_TRUE(has(refused(land(), 0), "BadParameter"));
        EXPECT_TRUE(has(refused(FeaturePoints{{{1, 2, 3}}, ""}, -1), "BadParameter"));
        EXPECT_THROW(write_points(Skeleton{land()}, Mask(frame_below(13, 7)), folder / "points", {.format = format}),
                     BadInput);
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WritePoints, OnePoint) {
    ScratchFolder const folder;
    FeaturePoints const one{{{0.1, -0.25, 1e-7}}, ""};
    std::int64_t const most = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(write_points(one, folder / "a.las", {.every = most}), 1U);
    EXPECT_EQ(write_points(one, folder / "a.ply", {.format = PointFormat::ply, .every = most}), 1U);
    EXPECT_EQ(write_points(one, folder / "a.xyz", {.format = PointFormat::xyz, .every = most}), 1U);
    expect_near(point_files::read_las(bytes_of(folder / "a.las")).points, one.points, 0.0005);
    EXPECT_EQ(point_files::read_ply(bytes_of(folder / "a.ply")).vertices, one.points);
    EXPECT_EQ(point_files::read_xyz(bytes_of(folder / "a.xyz")), one.points);
}

// Law: all cells with a height, row by row; bit for bit but for LAS.
TEST(WritePoints, CellsReadBack) {
    Raster<float> const z = land();
    for (std::int64_t const every : {1, 2, 3, 12, 100}) {
        ScratchFolder const folder;
        auto const wanted = cells_of(z, every);
        for (PointFormat const format : formats()) {
            std::string const name = folder / std::to_string(static_cast<int>(format));
            EXPECT_EQ(write_points(z, name, {.format = format, .every = every}), wanted.size());
            std::string const bytes = bytes_of(name);
            if (format == PointFormat::las) {
                auto const las = point_files::read_las(bytes);
                expect_near(las.points, wanted, 0.0005 + 1e-9);
                EXPECT_EQ(las.classes, std::vector<int>(wanted.size(), 2));
                EXPECT_EQ(las.epsg, 32631);
            } else if (format == PointFormat::ply) {
                EXPECT_EQ(point_files::read_ply(bytes).vertices, wanted);
                EXPECT_TRUE(has(bytes, "\ncomment crs EPSG:32631\n"));
            } else {
                auto found = point_files::read_xyz(bytes);
                for (Vec3& p : found) {
                    p.z = static_cast<double>(static_cast<float>(p.z));
                }
                EXPECT_EQ(found, wanted);
            }
        }
    }
}

TEST(WritePoints, TextIsShort) {
    ScratchFolder const folder;
    Raster<float> z(Grid{2, 1, 1.0, 0.0, 1.0, ""});
    z[0] = 0.1F;
    z[1] = -7.0F;
    write_points(z, folder / "a.xyz", {.format = PointFormat::xyz});
    EXPECT_EQ(bytes_of(folder / "a.xyz"), "0.5 0.5 0.1\n1.5 0.5 -7\n");
}

TEST(WritePoints, PointsOfAFileKeepTheirOrder) {
    ScratchFolder const folder;
    FeaturePoints points{{}, "EPSG:2154"};
    for (std::uint64_t i = 0; i < 10000; ++i) {
        auto const words = random_block(3, i);
        points.points.push_back({1e6 * unit(words[0]), 7e6 / 3.0 - unit(words[1]), unit(words[2])});
    }
    EXPECT_EQ(write_points(points, folder / "a.ply", {.format = PointFormat::ply}), 10000U);
    EXPECT_EQ(point_files::read_ply(bytes_of(folder / "a.ply")).vertices, points.points);
    EXPECT_EQ(write_points(points, folder / "a.xyz", {.format = PointFormat::xyz}), 10000U);
    EXPECT_EQ(point_files::read_xyz(bytes_of(folder / "a.xyz")), points.points);
    EXPECT_EQ(write_points(points, folder / "a.las"), 10000U);
    auto const las = point_files::read_las(bytes_of(folder / "a.las"));
    expect_near(las.points, points.points, 0.0005 + 1e-9);
    EXPECT_EQ(las.classes, std::vector<int>(10000, 8));
    EXPECT_EQ(las.epsg, 2154);
    EXPECT_EQ(write_points(points, folder / "b.ply", {.format = PointFormat::ply, .every = 3}), 3334U);
    EXPECT_EQ(point_files::read_ply(bytes_of(folder / "b.ply")).vertices[3333], points.points[9999]);
}

TEST(WritePoints, SkeletonsTellRiversFromTheRest) {
    ScratchFolder const folder;
    Skeleton const skeleton{land()};
    Mask rivers(skeleton.z.grid());
    std::vector<int> wanted;
    for (std::int64_t i = 0; i < rivers.cells(); ++i) {
        rivers[i] = i % 3 == 0 ? 1 : 0;
        if (!std::isnan(skeleton.z[i])) {
            wanted.push_back(i % 3 == 0 ? 9 : 8);
        }
    }
    EXPECT_EQ(write_points(skeleton, rivers, folder / "a.las"), wanted.size());
    auto const las = point_files::read_las(bytes_of(folder / "a.las"));
    expect_near(las.points, cells_of(skeleton.z), 0.0005 + 1e-9);
    EXPECT_EQ(las.classes, wanted);
}

TEST(WritePoints, LasStepsFollowTheLand) {
    ScratchFolder const folder;
    Raster<float> const small = land(5, 5, 0.04);
    write_points(small, folder / "small.las");
    auto const fine = point_files::read_las(bytes_of(folder / "small.las"));
    EXPECT_EQ(fine.scale, (std::array<double, 3>{1e-5, 1e-5, 1e-5}));
    expect_near(fine.points, cells_of(small), 0.5e-5 + 1e-9);
    write_points(FeaturePoints{{{-9e6, 0, 0}, {9e6, 0, 2e9}}, ""}, folder / "wide.las");
    auto const wide = point_files::read_las(bytes_of(folder / "wide.las"));
    EXPECT_DOUBLE_EQ(wide.scale[0], 0.01);
    EXPECT_DOUBLE_EQ(wide.scale[1], 0.001);
    EXPECT_DOUBLE_EQ(wide.scale[2], 1.0);
    EXPECT_EQ(wide.points[1], (Vec3{9e6, 0.0, 2e9}));
}

TEST(WritePoints, NothingIsOverwrittenAndBytesAreTheSame) {
    for (PointFormat const format : formats()) {
        ScratchFolder const folder;
        write_points(land(), folder / "a", {.format = format});
        write_points(land(), folder / "b", {.format = format});
        std::string const first = bytes_of(folder / "a");
        EXPECT_EQ(first, bytes_of(folder / "b"));
        EXPECT_THROW(write_points(land(5, 5), folder / "a", {.format = format}), IoError);
        EXPECT_EQ(first, bytes_of(folder / "a"));
        EXPECT_THROW(write_points(land(), folder / "none/a", {.format = format}), IoError);
        EXPECT_THROW(write_points(land(), folder / "c", {.format = format}, test::stopped_run()), Cancelled);
        FullDisk const full(512);
        EXPECT_THROW(write_points(land(), folder / "d", {.format = format}), IoError);
        EXPECT_THROW(write_points(land(400, 400), folder / "e", {.format = format}), IoError);
    }
}

} // namespace points_test
