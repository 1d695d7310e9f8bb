// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/points.hpp>

#include <cmath>
#include <fstream>
#include <limits>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/gdal/driver.hpp>
#include <thalweg/io/gdal/sources.hpp>

#include "full_disk.hpp"
#include "point_files.hpp"
#include "scratch_folder.hpp"

namespace points_test {

using namespace thalweg;
using io::FileContent;
using io::PointFormat;
using io::read_points;
using io::write_points;

namespace {

using test::frame_below;
using test::has;
using test::message_of;

std::string text_file(ScratchFolder const& folder, std::string const& name, std::string const& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
}

std::string refusal(io::ReadPointsParams const& params) {
    return message_of([&] { read_points(params); });
}

/// What a text file is refused for.
std::string refusal_of(std::string const& text) {
    ScratchFolder const folder;
    return refusal({text_file(folder, "p.csv", text)});
}

std::vector<Vec3> points_of(std::string const& name, std::string const& text) {
    ScratchFolder const folder;
    return read_points({text_file(folder, name, text)}).points;
}

/// A layer of WKT shapes, with a text or real field where one is named.
std::string layer(ScratchFolder const& folder, std::vector<std::pair<std::string, std::string>> const& shapes, int epsg,
                  char const* field = nullptr, OGRFieldType type = OFTReal) {
    std::string const path = folder / "p.gpkg";
    io::Driver const driver;
    auto* const maker = GetGDALDriverManager()->GetDriverByName("GPKG");
    GDALDatasetUniquePtr const data(maker->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRSpatialReference crs;
    if (epsg != 0) {
        crs.importFromEPSG(epsg);
        crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    }
    auto* const out = data->CreateLayer("spots", epsg != 0 ? &crs : nullptr, wkbUnknown, nullptr);
    if (field != nullptr) {
        OGRFieldDefn definition(field, type);
        out->CreateField(&definition);
    }
    for (auto const& [wkt, value] : shapes) {
        OGRFeature feature(out->GetLayerDefn());
        if (field != nullptr && !value.empty()) {
            feature.SetField(field, value.c_str());
        }
        OGRGeometry* geometry = nullptr;
        OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &geometry);
        feature.SetGeometryDirectly(geometry);
        EXPECT_EQ(out->CreateFeature(&feature), OGRERR_NONE);
    }
    return path;
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
    EXPECT_TRUE(has(refusal_of(""), "p.csv holds no points"));
    EXPECT_TRUE(has(refusal_of("x,y,z\n"), "holds no points"));
    EXPECT_TRUE(has(refusal_of("x,y,h\n1,2,3\n"), "first line: no column 'z'"));
    EXPECT_TRUE(has(refusal_of("x,y,z\n1,2,3\n1,2,three\n"), "line 3: z is 'three'"));
    EXPECT_TRUE(has(refusal_of("1,2,3\n1,nan,3\n"), "line 2: y is 'nan'"));
    EXPECT_TRUE(has(refusal_of("1,2,3\n#\n-inf,2,3\n"), "line 3: x is '-inf'"));
    EXPECT_TRUE(has(refusal_of("1,2,3\n1,2,1e999\n"), "line 2: z is '1e999'"));
    EXPECT_TRUE(has(refusal_of("1,2,3\n1,2\n"), "line 2: 2 of the columns, z is missing"));
    EXPECT_TRUE(has(refusal_of("1,2,3\n1,,3\n"), "line 2: y is ''"));
    EXPECT_TRUE(has(refusal({"nowhere.csv"}), "does not exist"));
}

TEST(ReadPoints, ColumnsWithoutNamesAreThree) {
    std::string const surveyed = "1,5000000.0,500000.0,210.5\n2,5000100.0,500900.0,180.2\n";
    EXPECT_TRUE(has(refusal_of(surveyed), "p.csv, line 1: 4 columns without names"));
    EXPECT_FALSE(has(refusal_of(surveyed), "--columns")); // no option of that caller
    EXPECT_TRUE(has(refusal_of("1,2,3\n1,2,3,4\n"), "line 2: 4 columns without names"));
    ScratchFolder const folder;
    io::ReadPointsParams params{.path = text_file(folder, "p.csv", surveyed), .columns = ""};
    EXPECT_TRUE(has(refusal(params), "or by number (--columns 3,2,4"));
    std::vector<Vec3> const wanted{{500000, 5000000, 210.5}, {500900, 5000100, 180.2}};
    for (char const* const columns : {"3,2,4", "PNEZD", "3 2 4"}) {
        params.columns = columns;
        EXPECT_EQ(read_points(params).points, wanted) << columns;
    }
    params.path = text_file(folder, "q.csv",
                            "Punkt;Hoch;Rechts;H;Art\n1;5000000;500000;210.5;Baum\n"
                            "2;5000100;500900;180.2;\n");
    EXPECT_EQ(read_points(params).points, wanted);
    for (char const* const columns : {"Rechts,Hoch,H", "rechts,2,h", "pnezd"}) {
        params.columns = columns;
        EXPECT_EQ(read_points(params).points, wanted) << columns;
    }
    params.columns = "x,y,z";
    EXPECT_TRUE(has(refusal(params), "q.csv, first line: no column 'x'"));
    params.columns = "3,2,9";
    EXPECT_TRUE(has(refusal(params), "line 2: 5 of the columns, z is missing"));
    params.columns = "3,2,5";
    EXPECT_TRUE(has(refusal(params), "line 2: z is 'Baum'"));
    for (char const* const columns : {"3,2", "1,2,3,4", "x,,z", "penz"}) {
        params.columns = columns;
        EXPECT_TRUE(has(message_of<BadParameter>([&] { read_points(params); }), "give three names or numbers"))
            << columns;
    }
    params = {.path = text_file(folder, "n.txt", "7 5000000 500000 210.5 old oak\n"), .columns = "pnezd"};
    EXPECT_EQ(read_points(params).points, (std::vector<Vec3>{{500000, 5000000, 210.5}}));
    params.path = layer(folder, {{"POINT Z (1 2 3)", ""}}, 32631);
    EXPECT_TRUE(has(message_of<BadParameter>([&] { read_points(params); }), "p.gpkg is not text of points"));
}

TEST(ReadPoints, DegreesNeedACrs) {
    ScratchFolder const folder;
    auto const text = text_file(folder, "p.csv", "x,y,z\n10.96,47.12,700\n11,47.05,650\n");
    EXPECT_TRUE(has(refusal({.path = text, .source_crs = ""}), "the numbers of p.csv are longitudes and latitudes"));
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

TEST(ReadPoints, LayersGiveTheirZ) {
    ScratchFolder const folder;
    auto const read =
        read_points({layer(folder, {{"POINT Z (1.25 2 3)", ""}, {"MULTIPOINT Z (4 5 6, 7 8 9)", ""}}, 32631)});
    EXPECT_EQ(read.points, (std::vector<Vec3>{{1.25, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    EXPECT_EQ(read.crs, "EPSG:32631");
}

TEST(ReadPoints, LayersGiveTheirField) {
    for (OGRFieldType const type : {OFTReal, OFTString}) {
        ScratchFolder const folder;
        auto const read =
            read_points({layer(folder, {{"POINT (1 2)", "3.5"}, {"POINT (4 5)", "-6"}}, 32631, "z", type)});
        EXPECT_EQ(read.points, (std::vector<Vec3>{{1, 2, 3.5}, {4, 5, -6}}));
    }
}

TEST(ReadPoints, GeographicOnesAreProjected) {
    ScratchFolder const folder;
    std::string const path = layer(folder, {{"POINT Z (3 0 7)", ""}, {"POINT Z (3 0.001 8)", ""}}, 4326);
    auto const read = read_points({path});
    EXPECT_EQ(read.crs, "EPSG:32631");
    EXPECT_EQ(read.points[0], (Vec3{500000, 0, 7}));
    EXPECT_NEAR(read.points[1].y, 110.53, 0.02);
    EXPECT_EQ(read_points({path, {}, "z", "EPSG:32632"}).crs, "EPSG:32632");
}

TEST(ReadPoints, WebMercatorIsProjected) {
    ScratchFolder const folder;
    std::string const path =
        layer(folder, {{"POINT Z (333958.4724 5621521.486 7)", ""}, {"POINT Z (333958.4724 5622521.486 8)", ""}}, 3857);
    auto const read = read_points({path});
    EXPECT_EQ(read.crs, "EPSG:32631");
    EXPECT_NEAR(read.points[0].x, 500000.0, 0.01);
    EXPECT_NEAR(read.points[1].y - read.points[0].y, 707.0, 2.0); // at 45 degrees north
    EXPECT_EQ(read_points({path, {}, "z", "EPSG:3857"}).points[0].x, 333958.4724);
}

TEST(ReadPoints, OnBothSidesOf180DegreesTheyLieNear) {
    ScratchFolder const folder;
    std::string const path = layer(folder, {{"POINT Z (179.99 -16 7)", ""}, {"POINT Z (-179.99 -16 8)", ""}}, 4326);
    auto const read = read_points({path});
    EXPECT_EQ(read.crs, "EPSG:32701");
    EXPECT_NEAR(read.points[1].x - read.points[0].x, 2140.0, 5.0); // 0.02 degrees at 16 degrees south
}

TEST(ReadPoints, BadLayersNameTheFeature) {
    using Shapes = std::vector<std::pair<std::string, std::string>>;
    auto const why = [](Shapes const& shapes, int epsg = 32631, char const* field = nullptr,
                        OGRFieldType type = OFTReal) {
        ScratchFolder const folder;
        return refusal({layer(folder, shapes, epsg, field, type)});
    };
    EXPECT_TRUE(has(why({}), "holds no points"));
    EXPECT_TRUE(has(why({{"POINT (1 2)", ""}}), "feature 1 of p.gpkg has no height: neither Z nor a field 'z'"));
    EXPECT_TRUE(has(why({{"POINT (1 2)", "5"}, {"POINT (1 2)", ""}}, 32631, "z"), "feature 2 of p.gpkg has no height"));
    EXPECT_TRUE(has(why({{"POINT (1 2)", "high"}}, 32631, "z", OFTString), "z is 'high', not a number"));
    EXPECT_TRUE(has(why({{"LINESTRING (1 2, 3 4)", "5"}}, 32631, "z"), "is Line String, not a point"));
    EXPECT_TRUE(has(why({{"POINT EMPTY", "5"}}, 32631, "z"), "is empty"));
    EXPECT_TRUE(has(why({{"POINT Z (1 2 3)", ""}}, 0), "has no CRS"));
    EXPECT_TRUE(has(refusal({"nowhere.gpkg"}), "does not exist"));
    ScratchFolder const folder;
    EXPECT_TRUE(has(refusal({layer(folder, {}, 0), "other"}), "no layer of points named 'other' (spots)"));
}

TEST(ReadPoints, FeaturesAreCountedFromOne) {
    ScratchFolder const folder;
    std::string const head = R"({"type":"FeatureCollection","features":[)";
    auto const feature = [](std::string const& z) {
        return R"({"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[1,2)" + z + "]}}";
    };
    auto const path = text_file(folder, "p.geojson", head + feature(",3") + "," + feature("") + "]}");
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
    EXPECT_TRUE(has(many, "q.csv has 8 places where points have unequal heights; keep one point at each. The first "
                          "are: points 1 and 2 of q.csv lie both at (80, 0), at heights of 1 and 2 m; points 3 and 4"));
    EXPECT_TRUE(has(many, "points 9 and 10") && !has(many, "points 11 and 12")) << many;
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
    params.path = layer(folder, {{"POINT (1 2)", ""}, {"POINT Z (4 5 6)", ""}}, 32631);
    EXPECT_EQ(read_points(params).points, wanted);
    params.path = text_file(folder, "b.csv", "1\n");
    EXPECT_TRUE(has(refusal(params), "line 1: 1 of the columns, y is missing"));
}

TEST(ReadPoints, AFileWithoutCrsTakesTheOneAsked) {
    ScratchFolder const folder;
    auto const read = read_points({layer(folder, {{"POINT Z (1 2 3)", ""}}, 0), {}, "z", "EPSG:32632"});
    EXPECT_EQ(read.crs, "EPSG:32632");
    EXPECT_EQ(read.points[0], (Vec3{1, 2, 3}));
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
    auto const bare = layer(folder, {{"POINT Z (9 0 3)", ""}}, 0);
    EXPECT_TRUE(has(refusal({.path = bare, .source_crs = ""}), "or name it (--source-crs EPSG:n)"));
    EXPECT_NEAR(read_points({.path = bare, .source_crs = "EPSG:4326"}).points[0].x, 500000.0, 1e-3);
    EXPECT_TRUE(has(refusal({.path = text, .source_crs = "here"}), "'here' is not a coordinate system"));
}

TEST(ContentOf, TellsWhatAFileHolds) {
    ScratchFolder const folder;
    EXPECT_EQ(io::content_of(text_file(folder, "a.xyz", "")).kind, FileContent::Kind::points);
    EXPECT_EQ(io::content_of(text_file(folder, "a.pgm", "P5 1 1 255\na")).kind, FileContent::Kind::raster);
    EXPECT_EQ(io::content_of(layer(folder, {{"POINT (1 2)", ""}}, 0)).kind, FileContent::Kind::points);
    ScratchFolder const other;
    EXPECT_EQ(io::content_of(layer(other, {{"LINESTRING (1 2, 3 4)", ""}}, 0)).kind, FileContent::Kind::lines);
    EXPECT_THROW(io::content_of(other.path().string()), BadInput); // no network.gpkg in it
    EXPECT_THROW(io::content_of("nowhere.csv"), BadInput);
    EXPECT_THROW(io::content_of(text_file(folder, "a.tif", "no raster")), BadInput);
    ScratchFolder const areas;
    EXPECT_THROW(io::content_of(layer(areas, {{"POLYGON ((0 0, 1 0, 0 1, 0 0))", ""}}, 0)), BadInput);
}

TEST(OutputFile, AppearsWholeOrNotAtAll) {
    ScratchFolder const folder;
    {
        io::OutputFile const file(folder / "a.txt");
        std::ofstream(file.staging()) << "half";
        EXPECT_EQ(folder.entries(), 1);
    }
    EXPECT_EQ(folder.entries(), 0);
    {
        io::OutputFile file(folder / "a.txt");
        std::ofstream(file.staging()) << "whole";
        file.commit();
    }
    EXPECT_EQ(bytes_of(folder / "a.txt"), "whole");
    EXPECT_EQ(folder.entries(), 1);
}

TEST(OutputFile, ReplacesOnlyWhenAsked) {
    ScratchFolder const folder;
    text_file(folder, "a.txt", "old");
    EXPECT_THROW(io::OutputFile(folder / "a.txt"), BadInput);
    {
        io::OutputFile file(folder / "a.txt", io::Existing::replace);
        std::ofstream(file.staging()) << "new";
        EXPECT_EQ(bytes_of(folder / "a.txt"), "old");
        file.commit();
    }
    EXPECT_EQ(bytes_of(folder / "a.txt"), "new");
    io::OutputFile late(folder / "b.txt");
    std::ofstream(late.staging()) << "late";
    text_file(folder, "b.txt", "early");
    EXPECT_THROW(late.commit(), BadInput);
    EXPECT_EQ(bytes_of(folder / "b.txt"), "early");
}

TEST(OutputFile, BadPlacesAreRefused) {
    ScratchFolder const folder;
    EXPECT_THROW(io::OutputFile(""), BadParameter);
    EXPECT_THROW(io::OutputFile(folder / ""), BadParameter);
    EXPECT_THROW(io::OutputFile(folder / "none/a.txt"), BadInput);
    EXPECT_THROW(io::OutputFile(folder.path().string(), io::Existing::replace), BadInput);
    std::filesystem::create_symlink("elsewhere", folder / "link");
    EXPECT_THROW(io::OutputFile(folder / "link", io::Existing::replace), BadInput);
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
        auto const refused = [&](auto const& what) {
            return message_of<BadInput>([&] { write_points(what, folder / "points", {.format = format}); });
        };
        EXPECT_TRUE(has(refused(FeaturePoints{}), "there is no point"));
        EXPECT_TRUE(has(refused(Raster<float>()), "there is no point"));
        EXPECT_TRUE(has(refused(Raster<float>(frame_below(2, 2), none)), "there is no point"));
        EXPECT_TRUE(has(refused(FeaturePoints{{{1, 2, 3}, {1, NAN, 3}}, ""}), "point 2 is not finite"));
        Raster<float> endless(frame_below(2, 2), 1.0F);
        endless[3] = std::numeric_limits<float>::infinity();
        EXPECT_TRUE(has(refused(endless), "the cell at (1.5, -1.5) is inf"));
        EXPECT_THROW(write_points(land(), folder / "points", {.format = format, .every = 0}), BadParameter);
        EXPECT_THROW(write_points(FeaturePoints{{{1, 2, 3}}, ""}, folder / "points", {.every = -1}), BadParameter);
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
    EXPECT_EQ(point_files::read_ply_points(bytes_of(folder / "a.ply")), one.points);
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
                EXPECT_EQ(point_files::read_ply_points(bytes), wanted);
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
    EXPECT_EQ(point_files::read_ply_points(bytes_of(folder / "a.ply")), points.points);
    EXPECT_EQ(write_points(points, folder / "a.xyz", {.format = PointFormat::xyz}), 10000U);
    EXPECT_EQ(point_files::read_xyz(bytes_of(folder / "a.xyz")), points.points);
    EXPECT_EQ(write_points(points, folder / "a.las"), 10000U);
    auto const las = point_files::read_las(bytes_of(folder / "a.las"));
    expect_near(las.points, points.points, 0.0005 + 1e-9);
    EXPECT_EQ(las.classes, std::vector<int>(10000, 8));
    EXPECT_EQ(las.epsg, 2154);
    EXPECT_EQ(write_points(points, folder / "b.ply", {.format = PointFormat::ply, .every = 3}), 3334U);
    EXPECT_EQ(point_files::read_ply_points(bytes_of(folder / "b.ply"))[3333], points.points[9999]);
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
    }
}

TEST(WritePoints, FullDiskIsAnErrorAndStopsWhenAsked) {
    for (PointFormat const format : formats()) {
        ScratchFolder const folder;
        {
            FullDisk const full(512);
            EXPECT_THROW(write_points(land(), folder / "a", {.format = format}), IoError);
            EXPECT_THROW(write_points(land(400, 400), folder / "b", {.format = format}), IoError);
        }
        std::stop_source stop;
        stop.request_stop();
        thalweg::Run run;
        run.stop = stop.get_token();
        EXPECT_THROW(write_points(land(), folder / "c", {.format = format}, run), Cancelled);
    }
}

} // namespace points_test
