// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>
#include <tins.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/gdal/driver.hpp>

#include "full_disk.hpp"
#include "point_files.hpp"
#include "scratch_folder.hpp"

namespace tin_test {

using namespace thalweg;
using io::read_tin;
using io::TinFile;
using io::TinFormat;
using io::write_tin;
using point_files::number_at;

namespace {

using test::has;
using test::message_of;

/// Coordinates of many digits, far from the origin.
Tin awkward() {
    auto points = test::points_by_chance(60, 1000.0, 9);
    for (Vec3& p : points) {
        p = {p.x + 300000.1, p.y + 5200000.0 / 3.0, p.z - 50.0};
    }
    points.push_back({300500.0, 1733800.0, 1e-7});
    points.push_back({300501.0, 1733801.0, -0.0});
    return geometry::triangulate(points).tin;
}

bool same(Tin const& a, Tin const& b) {
    return a.vertices == b.vertices && a.triangles == b.triangles;
}

std::string written(ScratchFolder const& folder, Tin const& tin, TinFormat format, std::string const& name = "tin") {
    write_tin(tin, "EPSG:32631", folder / name, format);
    return bytes_of(folder / name);
}

std::string refusal(Tin const& tin, TinFormat format) {
    ScratchFolder const folder;
    std::string const message = message_of<BadInput>([&] { write_tin(tin, "", folder / "tin", format); });
    EXPECT_TRUE(message.empty() || folder.entries() == 0) << message;
    return message;
}

Tin read_2dm(std::string const& text, std::string const& title = "MESHNAME \"tin\"") {
    std::istringstream in(text);
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(line, "MESH2D");
    std::getline(in, line);
    EXPECT_EQ(line, title);
    Tin tin;
    while (std::getline(in, line)) {
        std::istringstream card(line);
        std::string name;
        std::size_t id = 0;
        card >> name >> id;
        if (name == "ND") {
            Vec3 v;
            card >> v.x >> v.y >> v.z;
            tin.vertices.push_back(v);
            EXPECT_EQ(id, tin.vertices.size());
        } else if (name == "E3T") {
            std::array<std::uint32_t, 3> t{};
            int material = 0;
            card >> t[0] >> t[1] >> t[2] >> material;
            EXPECT_EQ(material, 1);
            tin.triangles.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
            EXPECT_EQ(id, tin.triangles.size());
        }
        EXPECT_FALSE(card.fail()) << line;
    }
    return tin;
}

Tin read_ply(std::string const& bytes, bool faces = true) {
    std::istringstream in(bytes);
    std::string line;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::vector<std::string> properties;
    std::getline(in, line);
    EXPECT_EQ(line, "ply");
    std::getline(in, line);
    EXPECT_EQ(line, "format binary_little_endian 1.0");
    while (std::getline(in, line) && line != "end_header") {
        std::istringstream words(line);
        std::string kind;
        std::string name;
        words >> kind >> name;
        if (kind == "element") {
            words >> (name == "vertex" ? vertices : triangles);
        } else if (kind == "property") {
            properties.push_back(line.substr(9));
        }
    }
    std::vector<std::string> wanted{"double x", "double y", "double z"};
    if (faces) {
        wanted.emplace_back("list uchar int vertex_indices");
    }
    EXPECT_EQ(properties, wanted);
    auto at = static_cast<std::size_t>(in.tellg());
    Tin tin;
    for (std::size_t i = 0; i < vertices; ++i, at += 24) {
        tin.vertices.push_back(
            {number_at<double>(bytes, at), number_at<double>(bytes, at + 8), number_at<double>(bytes, at + 16)});
    }
    for (std::size_t i = 0; i < triangles; ++i, at += 13) {
        EXPECT_EQ(bytes[at], 3);
        tin.triangles.push_back({number_at<std::uint32_t>(bytes, at + 1), number_at<std::uint32_t>(bytes, at + 5),
                                 number_at<std::uint32_t>(bytes, at + 9)});
    }
    EXPECT_EQ(at, bytes.size());
    return tin;
}

Tin read_obj(std::string const& text) {
    std::istringstream in(text);
    Tin tin;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "v") {
            Vec3 v;
            words >> v.x >> v.y >> v.z;
            tin.vertices.push_back(v);
        } else if (kind == "f") {
            std::array<std::uint32_t, 3> t{};
            words >> t[0] >> t[1] >> t[2];
            tin.triangles.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
        } else {
            EXPECT_EQ(kind, "#");
        }
    }
    return tin;
}

Tin read_off(std::string const& text) {
    std::istringstream in(std::regex_replace(text, std::regex("#[^\n]*\n"), ""));
    std::string head;
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    std::size_t edges = 1;
    in >> head >> vertices >> triangles >> edges;
    EXPECT_EQ(head, "OFF");
    EXPECT_EQ(edges, 0U);
    Tin tin;
    tin.vertices.resize(vertices);
    tin.triangles.resize(triangles);
    for (Vec3& v : tin.vertices) {
        in >> v.x >> v.y >> v.z;
    }
    for (auto& t : tin.triangles) {
        int corners = 0;
        in >> corners >> t[0] >> t[1] >> t[2];
        EXPECT_EQ(corners, 3);
    }
    EXPECT_FALSE(in.fail());
    return tin;
}

/// What lies between tags, in their order; tags must be closed in turn.
Tin read_landxml(std::string const& text) {
    Tin tin;
    std::vector<std::string> open;
    std::size_t at = text.find("?>") + 2;
    while (at < text.size()) {
        std::size_t const tag = text.find('<', at);
        if (tag == std::string::npos) {
            break;
        }
        std::istringstream inside(text.substr(at, tag - at));
        if (!open.empty() && open.back() == "P") {
            Vec3 v;
            inside >> v.y >> v.x >> v.z;
            EXPECT_FALSE(inside.fail());
            tin.vertices.push_back(v);
        } else if (!open.empty() && open.back() == "F") {
            std::array<std::uint32_t, 3> t{};
            inside >> t[0] >> t[1] >> t[2];
            EXPECT_FALSE(inside.fail());
            tin.triangles.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
        }
        at = text.find('>', tag) + 1;
        std::string const words = text.substr(tag + 1, at - tag - 2);
        if (words[0] == '/') {
            EXPECT_EQ(open.back(), words.substr(1));
            open.pop_back();
            at += open.empty() ? text.size() : 0;
        } else if (words.back() != '/') {
            open.push_back(words.substr(0, words.find(' ')));
            if (open.back() == "P") {
                EXPECT_EQ(words, "P id=\"" + std::to_string(tin.vertices.size() + 1) + "\"");
            }
        }
    }
    EXPECT_TRUE(open.empty());
    return tin;
}

using Triangle = std::array<std::uint32_t, 3>;

TinFile mesh(std::string const& name, std::string const& text) {
    ScratchFolder const folder;
    std::ofstream(folder / name, std::ios::binary) << text;
    return read_tin(folder / name);
}

std::string refusal_of_text(std::string const& name, std::string const& text) {
    return message_of<BadInput>([&] { mesh(name, text); });
}

double area(Tin const& tin, Triangle const& t) {
    Vec3 const a = tin.vertices[t[0]];
    Vec3 const b = tin.vertices[t[1]];
    Vec3 const c = tin.vertices[t[2]];
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

/// The sum, if no triangle is turned over.
double area(Tin const& tin) {
    double sum = 0.0;
    for (Triangle const& t : tin.triangles) {
        EXPECT_GT(area(tin, t), 0.0);
        sum += area(tin, t);
    }
    return sum;
}

bool has_edge(Tin const& tin, std::uint32_t a, std::uint32_t b) {
    for (Triangle const& t : tin.triangles) {
        std::set<std::uint32_t> const corners(t.begin(), t.end());
        if (corners.contains(a) && corners.contains(b)) {
            return true;
        }
    }
    return false;
}

} // namespace

TEST(WriteTin, FormatsByNameAndEnding) {
    EXPECT_EQ(io::tin_format("", "a/b.2dm"), TinFormat::mesh_2dm);
    EXPECT_EQ(io::tin_format("", "B.GPKG"), TinFormat::geopackage);
    EXPECT_EQ(io::tin_format("", "b.xml"), TinFormat::landxml);
    EXPECT_EQ(io::tin_format("las", "b.2dm"), TinFormat::las);
    EXPECT_EQ(io::tin_format("ply-points", "b.ply"), TinFormat::ply_points);
    EXPECT_THROW(io::tin_format("", "tin"), BadParameter);
    EXPECT_THROW(io::tin_format("", "tin.dxf"), BadParameter);
    EXPECT_THROW(io::tin_format("dxf", "tin.2dm"), BadParameter);
}

TEST(WriteTin, UnsoundTinsAreRefused) {
    for (auto const& f : io::tin_formats()) {
        EXPECT_TRUE(has(refusal({}, f.format), "no vertices"));
        EXPECT_TRUE(has(refusal({{{0, 0, NAN}}, {}}, f.format), "vertex 1 is not finite"));
        EXPECT_TRUE(has(refusal({{{0, INFINITY, 0}}, {}}, f.format), "vertex 1 is not finite"));
        EXPECT_TRUE(
            has(refusal({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}, f.format), "triangle 1 has vertex 4"));
    }
}

TEST(WriteTin, NothingIsOverwrittenAndBytesAreTheSame) {
    for (auto const& f : io::tin_formats()) {
        ScratchFolder const folder;
        std::string const first = written(folder, awkward(), f.format, "a.gpkg");
        EXPECT_EQ(first, written(folder, awkward(), f.format, "b.gpkg")) << f.name;
        EXPECT_THROW(write_tin(awkward(), "", folder / "a.gpkg", f.format), IoError) << f.name;
        EXPECT_EQ(first, bytes_of(folder / "a.gpkg"));
        EXPECT_EQ(folder.entries(), 2);
    }
}

TEST(WriteTin, FullDiskIsAnError) {
    for (auto const& f : io::tin_formats()) {
        ScratchFolder const folder;
        FullDisk const full(512);
        EXPECT_THROW(write_tin(awkward(), "", folder / "a.gpkg", f.format), IoError) << f.name;
    }
}

// Law: coordinates read back bit for bit, triangles in their order.
TEST(WriteTin, RoundTripIsExact) {
    ScratchFolder const folder;
    Tin const tin = awkward();
    EXPECT_TRUE(same(read_2dm(written(folder, tin, TinFormat::mesh_2dm, "1")), tin));
    EXPECT_TRUE(same(read_ply(written(folder, tin, TinFormat::ply, "2")), tin));
    EXPECT_TRUE(same(read_obj(written(folder, tin, TinFormat::obj, "3")), tin));
    EXPECT_TRUE(same(read_off(written(folder, tin, TinFormat::off, "4")), tin));
    EXPECT_TRUE(same(read_landxml(written(folder, tin, TinFormat::landxml, "5")), tin));
    EXPECT_EQ(read_ply(written(folder, tin, TinFormat::ply_points, "6"), false).vertices, tin.vertices);
    std::istringstream in(written(folder, tin, TinFormat::xyz, "7"));
    for (Vec3 const& wanted : tin.vertices) {
        Vec3 v;
        in >> v.x >> v.y >> v.z;
        EXPECT_EQ(v, wanted);
    }
    std::string rest;
    EXPECT_FALSE(in >> rest);
}

TEST(WriteTin, LandXmlNamesItsCrs) {
    ScratchFolder const folder;
    EXPECT_TRUE(has(written(folder, awkward(), TinFormat::landxml), "<CoordinateSystem epsgCode=\"32631\"/>"));
    write_tin(awkward(), "PROJCS[\"a<b\"]", folder / "wkt.xml", TinFormat::landxml);
    EXPECT_TRUE(has(bytes_of(folder / "wkt.xml"), "ogcWktCode=\"PROJCS[&quot;a&lt;b&quot;]\""));
}

TEST(WriteTin, GeoPackageHoldsFaces) {
    ScratchFolder const folder;
    Tin const tin = awkward();
    written(folder, tin, TinFormat::geopackage, "tin.gpkg");
    io::Driver const driver;
    GDALDatasetUniquePtr const data(GDALDataset::Open((folder / "tin.gpkg").c_str(), GDAL_OF_VECTOR));
    ASSERT_TRUE(data);
    OGRLayer* const layer = data->GetLayerByName("faces");
    ASSERT_NE(layer, nullptr);
    EXPECT_EQ(layer->GetGeomType(), wkbPolygon25D);
    EXPECT_STREQ(layer->GetSpatialRef()->GetAuthorityCode(nullptr), "32631");
    ASSERT_EQ(layer->GetFeatureCount(), static_cast<GIntBig>(tin.triangles.size()));
    std::size_t i = 0;
    for (auto const& feature : layer) {
        auto const& t = tin.triangles[i++];
        EXPECT_EQ(feature->GetFieldAsInteger64("face_id"), static_cast<GIntBig>(i));
        auto const* const ring = feature->GetGeometryRef()->toPolygon()->getExteriorRing();
        ASSERT_EQ(ring->getNumPoints(), 4);
        for (int k = 0; k < 4; ++k) {
            std::uint32_t const v = t[static_cast<std::size_t>(k % 3)];
            EXPECT_EQ((Vec3{ring->getX(k), ring->getY(k), ring->getZ(k)}), tin.vertices[v]);
            EXPECT_EQ(feature->GetFieldAsInteger64(("v" + std::to_string(k % 3 + 1)).c_str()), v + 1);
        }
        EXPECT_EQ(ring->isClockwise(), 0);
        EXPECT_NEAR(feature->GetFieldAsDouble("area"), feature->GetGeometryRef()->toPolygon()->get_Area(), 1e-3);
        EXPECT_GE(feature->GetFieldAsDouble("slope"), 0.0);
    }
}

TEST(WriteTin, Las) {
    ScratchFolder const folder;
    Tin const tin = awkward();
    auto const las = point_files::read_las(written(folder, tin, TinFormat::las));
    EXPECT_EQ(las.epsg, 32631);
    ASSERT_EQ(las.points.size(), tin.vertices.size());
    for (std::size_t i = 0; i < las.points.size(); ++i) {
        EXPECT_NEAR(las.points[i].x, tin.vertices[i].x, 0.0005 + 1e-9);
        EXPECT_NEAR(las.points[i].y, tin.vertices[i].y, 0.0005 + 1e-9);
        EXPECT_NEAR(las.points[i].z, tin.vertices[i].z, 0.0005 + 1e-9);
        EXPECT_EQ(las.classes[i], 2); // ground
    }
}

// Law: the unit of heights is said, and changes no coordinate; in metres nothing is said.
TEST(WriteTin, HeightsInFeetAreSaid) {
    ScratchFolder const folder;
    Tin const tin = awkward();
    auto const in_feet = [&](TinFormat format, std::string const& name) {
        write_tin(tin, "EPSG:32631", folder / name, format, HeightUnit::foot);
        return bytes_of(folder / name);
    };
    Tin const mesh = read_2dm(in_feet(TinFormat::mesh_2dm, "a.2dm"), "MESHNAME \"tin, heights in ft\"");
    EXPECT_EQ(mesh.vertices, tin.vertices);
    std::string const ply = in_feet(TinFormat::ply, "a.ply");
    EXPECT_TRUE(has(ply, "\ncomment heights in ft\n"));
    EXPECT_EQ(read_ply(ply).vertices, tin.vertices);
    EXPECT_TRUE(has(in_feet(TinFormat::ply_points, "points.ply"), "\ncomment heights in ft\n"));
    EXPECT_TRUE(has(in_feet(TinFormat::obj, "a.obj"), "\n# heights in ft\n"));
    EXPECT_TRUE(has(in_feet(TinFormat::off, "a.off"), "\n# heights in ft\n"));
    for (auto const& f : io::tin_formats()) {
        std::string const name = std::string("metres") + f.ending;
        write_tin(tin, "EPSG:32631", folder / name, f.format);
        EXPECT_FALSE(has(bytes_of(folder / name), "heights in")) << f.name;
        std::filesystem::remove(folder / name);
    }
    for (TinFormat const other : {TinFormat::geopackage, TinFormat::landxml, TinFormat::las, TinFormat::xyz}) {
        EXPECT_THROW(in_feet(other, "b"), BadParameter);
        EXPECT_FALSE(std::filesystem::exists(folder / "b"));
    }
}

TEST(WriteTin, LasOfAWholeContinentTakesCoarserSteps) {
    ScratchFolder const folder;
    Tin const tin{{{-9e6, 0, 0}, {9e6, 0, 1}, {0, 1, 2e9}}, {{0, 1, 2}}};
    write_tin(tin, "", folder / "tin.las", TinFormat::las);
    std::string const las = bytes_of(folder / "tin.las");
    EXPECT_EQ(number_at<std::uint32_t>(las, 100), 0U);
    EXPECT_DOUBLE_EQ(number_at<double>(las, 131), 0.01);
    EXPECT_DOUBLE_EQ(number_at<double>(las, 147), 1.0);
    EXPECT_EQ(number_at<double>(las, 179), 9e6);
    EXPECT_EQ(number_at<double>(las, 187), -9e6);
}

TEST(ReadTin, BadFacesAreRefused) {
    std::string const nodes = "MESH2D\nND 1 0 0 0\nND 2 1 0 0\nND 3 1 1 0\nND 4 0 1 0\n";
    EXPECT_TRUE(has(refusal_of_text("a.2dm", nodes + "E4Q 1 1 2 3 5 1\n"), "face 1 names a vertex that is not there"));
    EXPECT_TRUE(has(refusal_of_text("a.2dm", nodes + "E4Q 1 1 2 3\n"), "line 6: '' is not the number of a vertex"));
    EXPECT_TRUE(has(refusal_of_text("a.2dm", nodes + "E4Q 1 1 1 2 2 1\n"), "face 1 has fewer than three corners"));
    EXPECT_TRUE(
        has(refusal_of_text("a.2dm", nodes + "E8Q 1 1 2 3 4 1 2 3 4 1\n"), "line 6: E8Q is neither a triangle"));
    std::string const corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    EXPECT_TRUE(has(refusal_of_text("a.obj", corners + "f 1 2\n"), "line 4: '' is not the number of a vertex"));
    EXPECT_TRUE(has(refusal_of_text("a.obj", corners + "f 1 2 3 x\n"), "line 4: 'x' is not the number of a vertex"));
    EXPECT_TRUE(
        has(refusal_of_text("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n2 0 1\n"), "line 6: a face with 2 corners"));
    EXPECT_TRUE(
        has(refusal_of_text("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n9999999999 0 1\n"), "9999999999 corners"));
}

TEST(ReadTin, QuadrilateralsAreCutAlongTheShorterDiagonal) {
    std::string const nodes = "MESH2D\nND 7 0 0 1\nND 2 10 0 2\nND 5 10 10 5\nND 4 0 10 1\nND 9 20 0 1\n";
    TinFile const upright = mesh("a.2dm", nodes + "E4Q 1 7 2 5 4 1\nE3T 2 2 9 5 1\n");
    EXPECT_EQ(upright.split, 1);
    ASSERT_EQ(upright.tin.triangles.size(), 3U);
    EXPECT_TRUE(has_edge(upright.tin, 1, 3)); // alike in plan, 3 m shorter with heights
    EXPECT_DOUBLE_EQ(area(upright.tin), 150.0);
    TinFile const round = mesh("a.2dm", nodes + "E4Q 1 4 5 2 7 1\n"); // clockwise
    EXPECT_EQ(round.tin.triangles.size(), 2U);
    EXPECT_TRUE(has_edge(round.tin, 1, 3));
    for (Triangle const& t : round.tin.triangles) {
        EXPECT_DOUBLE_EQ(area(round.tin, t), -50.0);
    }
    TinFile const three = mesh("a.2dm", nodes + "E4Q 1 7 2 5 5 1\n"); // as some programs write triangles
    EXPECT_EQ(three.split, 0);
    EXPECT_EQ(three.tin.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(ReadTin, ADiagonalOutsideItsFaceIsNotTaken) {
    // An arrowhead: the short diagonal between its tips lies outside.
    TinFile const arrow = mesh("a.obj", "v 0 0 0\nv 4 10 0\nv 8 0 0\nv 4 9 0\nf 1/1/1 3/2/1 2/1/1 4/4/1\n"
                                        "v 100 0 0\nv 104 100 0\nv 108 0 0\nv 104 90 0\nf 5 8 7 6\n");
    ASSERT_EQ(arrow.tin.triangles.size(), 4U);
    EXPECT_TRUE(has_edge(arrow.tin, 5, 7));
    EXPECT_FALSE(has_edge(arrow.tin, 4, 6));
    // A corner on the line between its neighbours.
    TinFile const flat = mesh("b.obj", "v 0 0 0\nv 5 0 0\nv 10 0 0\nv 5 3 0\nf 1 2 3 4\n");
    EXPECT_DOUBLE_EQ(area(flat.tin), 15.0);
    EXPECT_TRUE(has_edge(flat.tin, 1, 3));
}

TEST(ReadTin, FacesOfManyCornersAreCutWhole) {
    // A comb, which is far from convex.
    std::string text = "OFF\n";
    std::vector<Vec2> ring{{0, 0}, {60, 0}};
    for (int tooth = 5; tooth >= 0; --tooth) {
        ring.push_back({10.0 * tooth + 10.0, 30});
        ring.push_back({10.0 * tooth + 4.0, 2});
    }
    text += std::to_string(ring.size()) + " 1 0\n";
    double wanted = 0.0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        Vec2 const a = ring[i];
        Vec2 const b = ring[(i + 1) % ring.size()];
        wanted += 0.5 * (a.x * b.y - a.y * b.x);
        text += std::to_string(a.x) + " " + std::to_string(a.y) + " 0\n";
    }
    text += std::to_string(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i) {
        text += " " + std::to_string(i);
    }
    TinFile const comb = mesh("a.off", text + "\n");
    EXPECT_EQ(comb.tin.triangles.size(), ring.size() - 2);
    EXPECT_NEAR(area(comb.tin), wanted, 1e-9);
}

TEST(ReadTin, UprightFacesAreCutToo) {
    TinFile const wall = mesh("a.obj", "v 0 0 0\nv 10 0 0\nv 10 0 5\nv 0 0 3\nf 1 2 3 4\n");
    ASSERT_EQ(wall.tin.triangles.size(), 2U);
    EXPECT_TRUE(has_edge(wall.tin, 1, 3));
}

} // namespace tin_test
