// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/tin.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>
#include <support.hpp>
#include <tins.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/triangulate.hpp>

#include "full_disk.hpp"
#include "point_files.hpp"
#include "vector_files.hpp"

namespace tin_test {

using namespace thalweg;
using io::read_tin;
using io::TinFile;
using io::TinFormat;
using io::write_tin;

namespace {

using test::error_of;
using test::has;

/// Coordinates of many digits, far from the origin.
Tin awkward() {
    auto points = test::random_points(60, 1000.0, 9);
    for (Vec3& p : points) {
        p = {p.x + 300000.1, p.y + 5200000.0 / 3.0, p.z - 50.0};
    }
    points.push_back({300500.0, 1733800.0, 1e-7});
    points.push_back({300501.0, 1733801.0, -0.0});
    return geometry::triangulate(points).tin;
}

std::string written(Tin const& tin, TinFormat format, std::string const& crs = "EPSG:32631",
                    HeightUnit unit = HeightUnit::metre) {
    ScratchFolder const folder;
    write_tin(tin, crs, folder / "tin", format, unit);
    return bytes_of(folder / "tin");
}

using Triangle = std::array<std::uint32_t, 3>;

TinFile mesh(std::string const& name, std::string const& text) {
    ScratchFolder const folder;
    folder.write(name, text);
    return read_tin(folder / name);
}

/// The numbers in a text, words and tags apart.
std::vector<double> numbers_in(std::string const& text) {
    std::istringstream words(std::regex_replace(text, std::regex("<[^>]*>"), " "));
    std::vector<double> numbers;
    for (std::string word; words >> word;) {
        char* end = nullptr;
        double const number = std::strtod(word.c_str(), &end);
        if (*end == '\0') {
            numbers.push_back(number);
        }
    }
    return numbers;
}

double area(Tin const& tin, Triangle const& t) {
    return 0.5 * test::area2(tin.vertices[t[0]], tin.vertices[t[1]], tin.vertices[t[2]]);
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

bool is_same(Tin const& a, Tin const& b) {
    return a.vertices == b.vertices && a.triangles == b.triangles;
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
        for (auto const& [tin, words] : std::vector<std::pair<Tin, std::string>>{
                 {{}, ""},
                 {{{{0, 0, 0}, {0, 0, NAN}}, {}}, "vertex 2"},
                 {{{{0, INFINITY, 0}}, {}}, "vertex 1"},
                 {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}, "triangle 1 has vertex 4"}}) {
            ScratchFolder const folder;
            EXPECT_TRUE(
                has(error_of([&] { write_tin(tin, "", folder / "tin", f.format); }), "BadInput io.write_tin", words));
            EXPECT_EQ(folder.entries(), 0) << f.name;
        }
    }
}

TEST(WriteTin, NothingIsOverwrittenAndBytesAreTheSame) {
    for (auto const& f : io::tin_formats()) {
        ScratchFolder const folder;
        std::string const first = written(awkward(), f.format);
        write_tin(awkward(), "EPSG:32631", folder / "a.gpkg", f.format);
        EXPECT_EQ(first, bytes_of(folder / "a.gpkg")) << f.name;
        EXPECT_THROW(write_tin(awkward(), "", folder / "a.gpkg", f.format), IoError) << f.name;
        EXPECT_EQ(first, bytes_of(folder / "a.gpkg"));
        EXPECT_EQ(folder.entries(), 1);
        FullDisk const full(512);
        EXPECT_THROW(write_tin(awkward(), "", folder / "b.gpkg", f.format), IoError) << f.name;
    }
}

TEST(WriteTin, TextsOfOneTriangle) {
    Tin const tin{{{0.5, 1, -2}, {3, 1, 1e-7}, {0.5, 4, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(written(tin, TinFormat::mesh_2dm), "MESH2D\nMESHNAME \"tin\"\nE3T 1 1 2 3 1\nND 1 0.5 1 -2\n"
                                                 "ND 2 3 1 1e-07\nND 3 0.5 4 0\n");
    EXPECT_EQ(written(tin, TinFormat::obj), "# thalweg; Z up: x eastwards, y northwards, z height\n# crs EPSG:32631\nv "
                                            "0.5 1 -2\nv 3 1 1e-07\nv 0.5 4 0\nf 1 2 3\n");
    EXPECT_EQ(written(tin, TinFormat::off), "OFF\n# crs EPSG:32631\n3 1 0\n0.5 1 -2\n3 1 1e-07\n0.5 4 0\n3 0 1 2\n");
    EXPECT_EQ(written(tin, TinFormat::xyz), "0.5 1 -2\n3 1 1e-07\n0.5 4 0\n");
    EXPECT_TRUE(has(written(tin, TinFormat::landxml), "<CoordinateSystem epsgCode=\"32631\"/>",
                    "elevMax=\"1e-07\" elevMin=\"-2\"", "<P id=\"1\">1 0.5 -2</P>\n<P id=\"2\">1 3 1e-07</P>",
                    "<F>1 2 3</F>"));
    EXPECT_TRUE(has(written(tin, TinFormat::landxml, "PROJCS[\"a<b\"]"), "ogcWktCode=\"PROJCS[&quot;a&lt;b&quot;]\""));
}

// Law: coordinates read back bit for bit, triangles in their order.
TEST(WriteTin, RoundTripIsExact) {
    Tin const tin = awkward();
    for (auto const& [name, format] : {std::pair("a.2dm", TinFormat::mesh_2dm), std::pair("a.obj", TinFormat::obj),
                                       std::pair("a.off", TinFormat::off)}) {
        Tin const read = mesh(name, written(tin, format)).tin;
        EXPECT_EQ(read.vertices, tin.vertices) << name;
        EXPECT_EQ(read.triangles, tin.triangles) << name;
    }
    auto const ply = point_files::read_ply(written(tin, TinFormat::ply));
    EXPECT_EQ(ply.vertices, tin.vertices);
    EXPECT_EQ(ply.triangles, tin.triangles);
    EXPECT_EQ(point_files::read_ply(written(tin, TinFormat::ply_points)).vertices, tin.vertices);
    EXPECT_EQ(point_files::read_xyz(written(tin, TinFormat::xyz)), tin.vertices);
    std::vector<double> wanted;
    for (Vec3 const& v : tin.vertices) {
        wanted.insert(wanted.end(), {v.y, v.x, v.z});
    }
    for (Triangle const& t : tin.triangles) {
        wanted.insert(wanted.end(), {t[0] + 1.0, t[1] + 1.0, t[2] + 1.0});
    }
    EXPECT_EQ(numbers_in(written(tin, TinFormat::landxml)), wanted);
}

TEST(WriteTin, GeoPackageHoldsFaces) {
    ScratchFolder const folder;
    Tin tin = awkward();
    auto const n = static_cast<std::uint32_t>(tin.vertices.size());
    tin.vertices.insert(tin.vertices.end(), {{0, 0, 7}, {10, 0, 10}, {0, 10, 11}});
    tin.triangles.push_back({n, n + 1, n + 2}); // rises by 0.3 to the east and 0.4 to the north
    write_tin(tin, "EPSG:32631", folder / "tin.gpkg", TinFormat::geopackage);
    auto const data = opened(folder / "tin.gpkg");
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
        EXPECT_TRUE(i < tin.triangles.size() || std::fabs(feature->GetFieldAsDouble("slope") - 0.5) < 1e-12);
    }
}

TEST(WriteTin, Las) {
    Tin const tin = awkward();
    auto const las = point_files::read_las(written(tin, TinFormat::las));
    EXPECT_EQ(las.epsg, 32631);
    ASSERT_EQ(las.points.size(), tin.vertices.size());
    for (std::size_t i = 0; i < las.points.size(); ++i) {
        EXPECT_NEAR(las.points[i].x, tin.vertices[i].x, 0.0005 + 1e-9);
        EXPECT_NEAR(las.points[i].y, tin.vertices[i].y, 0.0005 + 1e-9);
        EXPECT_NEAR(las.points[i].z, tin.vertices[i].z, 0.0005 + 1e-9);
        EXPECT_EQ(las.classes[i], 2); // ground
    }
}

// Law: the unit of heights is written, and changes no coordinate; in metres nothing is written.
TEST(WriteTin, HeightsInFeetAreWritten) {
    Tin const tin = awkward();
    for (auto const& f : io::tin_formats()) {
        EXPECT_FALSE(has(written(tin, f.format), "heights in")) << f.name;
        if (f.format == TinFormat::geopackage || f.format == TinFormat::landxml || f.format == TinFormat::las ||
            f.format == TinFormat::xyz) {
            EXPECT_THROW(written(tin, f.format, "", HeightUnit::foot), BadParameter) << f.name;
            continue;
        }
        std::string text = written(tin, f.format, "EPSG:32631", HeightUnit::foot);
        bool const is_name = f.format == TinFormat::mesh_2dm;
        bool const is_ply = f.format == TinFormat::ply || f.format == TinFormat::ply_points;
        std::string const words = is_name  ? ", heights in ft"
                                  : is_ply ? "comment heights in ft\n"
                                           : "# heights in ft\n";
        std::size_t const at = text.find(words);
        ASSERT_NE(at, std::string::npos) << f.name;
        EXPECT_EQ(text.erase(at, words.size()), written(tin, f.format)) << f.name;
    }
    EXPECT_THROW(mesh("a.obj", written(tin, TinFormat::obj, "", HeightUnit::foot)), BadInput);
}

TEST(ReadTin, BadFacesAreRefused) {
    std::string const nodes = "MESH2D\nND 1 0 0 0\nND 2 1 0 0\nND 3 1 1 0\nND 4 0 1 0\n";
    std::string const corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    std::string const counts = "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n";
    for (auto const& [name, text, words] :
         std::vector<std::array<std::string, 3>>{{"a.2dm", nodes + "E4Q 1 1 2 3 5 1\n", "face 1"},
                                                 {"a.2dm", nodes + "E4Q 1 1 2 3\n", "line 6: ''"},
                                                 {"a.2dm", nodes + "E4Q 1 1 1 2 2 1\n", "face 1"},
                                                 {"a.2dm", nodes + "E8Q 1 1 2 3 4 1 2 3 4 1\n", "line 6: E8Q"},
                                                 {"a.2dm", nodes + "ND 4 1 1 1\n", "line 6"},
                                                 {"a.2dm", "MESH2D\n", ""},
                                                 {"a.obj", corners + "f 1 2\n", "line 4: ''"},
                                                 {"a.obj", corners + "f 1 2 3 x\n", "line 4: 'x'"},
                                                 {"a.obj", corners + "f 1 2 4\n", "face 1"},
                                                 {"a.obj", corners + "f 0 1 2\n", "face 1"},
                                                 {"a.obj", "v 0 0 nan\n", "line 1: 'nan'"},
                                                 {"a.off", counts + "2 0 1\n", "line 6: a face with 2 corners"},
                                                 {"a.off", counts + "9999999999 0 1\n", "9999999999"},
                                                 {"a.off", "OFF\n99999999999 1 0\n0 0 0\n", "1 of 99999999999"}}) {
        EXPECT_TRUE(has(error_of([&] { mesh(name, text); }), "BadInput io.read_tin", words)) << text;
    }
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
    TinFile const wall = mesh("a.obj", "# Z up\nv 0 0 0\nv 10 0 0\nv 10 0 5\nv 0 0 3\nf 1 2 3 4\n");
    ASSERT_EQ(wall.tin.triangles.size(), 2U);
    EXPECT_TRUE(has_edge(wall.tin, 1, 3));
}

TEST(ReadTin, NumbersCountBackFromTheLastVertexAndLinesGoOn) {
    std::string const corners = "v 0 0 1\nv 10 0 2\nv 10 10 3\n";
    Tin const absolute = mesh("a.obj", corners + "f 1/1/1 2/2/2 3/3/3\nv 0 10 4\nf 1 3 4\n").tin;
    Tin const relative = mesh("b.obj", corners + "f -3/-3/-3 -2/-2/-2 -1/-1/-1\nv 0 10 4\nf -4 -2 -1\n").tin;
    EXPECT_TRUE(is_same(relative, absolute));
    Tin const parts = mesh("c.obj", "v 0 0 \\\n1\nv 10 0 2\nv 10 10 3\nf 1 \\\n  2 \\\n3\nv 0 10 4\nf 1 3 4\n").tin;
    EXPECT_TRUE(is_same(parts, absolute));
    EXPECT_TRUE(has(error_of([&] { mesh("d.obj", corners + "f -4 -2 -1\n"); }), "face 1"));
}

TEST(ReadTin, OffHasManyHeads) {
    Tin const plain = mesh("a.off", "OFF\n3 1 0\n0 0 1\n10 0 2\n10 10 3\n3 0 1 2\n").tin;
    for (char const* text :
         {"OFF 3 1 0\n0 0 1\n10 0 2\n10 10 3\n3 0 1 2\n",
          "COFF\n3 1 0\n0 0 1 255 0 0 255\n10 0 2 0 255 0 255\n10 10 3 0 0 255 255\n3 0 1 2 9 9 9\n",
          "# made by hand\nNOFF # with normals\n\n3 1 3\n0 0 1 0 0 1\n10 0 2 0 0 1\n10 10 3 0 0 1\n3 0 1 2\n",
          "STCOFF 3 1 0\n0 0 1 1 1 1 1 0 0\n10 0 2 1 1 1 1 1 0\n10 10 3 1 1 1 1 1 1\n3 0 1 2\n"}) {
        EXPECT_TRUE(is_same(mesh("b.off", text).tin, plain)) << text;
    }
    EXPECT_TRUE(has(error_of([&] { mesh("c.off", "OFF BINARY\n"); }), "'BINARY'"));
    EXPECT_TRUE(has(error_of([&] { mesh("c.off", "4OFF\n3 1 0\n"); }), "begins with OFF"));
}

TEST(ReadTin, YMayBeUp) {
    // A ridge between two slopes; north is -z.
    std::string const faces = "v 0 5 0\nv 10 6 0\nv 10 7 -10\nv 0 8 -10\nv 10 2 -20\nv 0 3 -20\n"
                              "f 1 2 3\nf 1 3 4\nf 4 3 5\nf 4 5 6\n";
    TinFile const turned =
        mesh("a.obj", "# thalweg; metres, Y up: x eastwards\n# origin 500 4000 100 (east)\n" + faces);
    EXPECT_EQ(turned.tin.vertices[2], (Vec3{510, 4010, 107}));
    EXPECT_DOUBLE_EQ(area(turned.tin), 200.0);
    ASSERT_EQ(turned.findings.size(), 1U);
    EXPECT_TRUE(has(turned.findings[0].text, "Y is up in it"));
    EXPECT_EQ(mesh("b.obj", "#Y-up\n" + faces).tin.vertices[2], (Vec3{10, 10, 7}));
    std::string const refused = error_of([&] { mesh("c.obj", faces); });
    EXPECT_TRUE(has(refused, "folded in plan, with its heights on the y axis")) << refused;
    EXPECT_EQ(mesh("d.obj", "# z is up\n" + faces).tin.vertices[2], (Vec3{10, 7, -10}));
}

TEST(ReadTin, TrianglesByThemselvesAreWelded) {
    Tin const whole = awkward();
    std::string text;
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
        for (std::uint32_t const v : whole.triangles[t]) {
            Vec3 const& p = whole.vertices[v];
            text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
        }
        text += "f -3 -2 -1\n";
    }
    TinFile const soup = mesh("a.obj", text);
    EXPECT_EQ(soup.tin.vertices.size(), whole.vertices.size());
    EXPECT_EQ(soup.tin.triangles.size(), whole.triangles.size());
    ASSERT_EQ(soup.findings.size(), 1U);
    EXPECT_EQ(soup.findings[0].amount, static_cast<double>(3 * whole.triangles.size() - whole.vertices.size()));
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
        EXPECT_DOUBLE_EQ(area(soup.tin, soup.tin.triangles[t]), area(whole, whole.triangles[t]));
    }
}

} // namespace tin_test
