// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/tin.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

#include "scratch_folder.hpp"

namespace read_tin_test {

using namespace thalweg;
using io::read_tin;
using io::TinFile;

namespace {

using test::has;
using test::message_of;
using Triangle = std::array<std::uint32_t, 3>;

TinFile mesh(std::string const& name, std::string const& text) {
    ScratchFolder const folder;
    std::ofstream(folder / name, std::ios::binary) << text;
    return read_tin(folder / name);
}

std::string refusal(std::string const& name, std::string const& text) {
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

TEST(ReadTin, BadFacesAreRefused) {
    std::string const nodes = "MESH2D\nND 1 0 0 0\nND 2 1 0 0\nND 3 1 1 0\nND 4 0 1 0\n";
    EXPECT_TRUE(has(refusal("a.2dm", nodes + "E4Q 1 1 2 3 5 1\n"), "face 1 names a vertex that is not there"));
    EXPECT_TRUE(has(refusal("a.2dm", nodes + "E4Q 1 1 2 3\n"), "line 6: '' is not the number of a vertex"));
    EXPECT_TRUE(has(refusal("a.2dm", nodes + "E4Q 1 1 1 2 2 1\n"), "face 1 has fewer than three corners"));
    EXPECT_TRUE(has(refusal("a.2dm", nodes + "E8Q 1 1 2 3 4 1 2 3 4 1\n"),
                    "line 6: E8Q is neither a triangle (E3T) nor a quadrilateral (E4Q)"));
    std::string const corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    EXPECT_TRUE(has(refusal("a.obj", corners + "f 1 2\n"), "line 4: '' is not the number of a vertex"));
    EXPECT_TRUE(has(refusal("a.obj", corners + "f 1 2 3 x\n"), "line 4: 'x' is not the number of a vertex"));
    EXPECT_TRUE(has(refusal("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n2 0 1\n"), "line 6: a face with 2 corners"));
    EXPECT_TRUE(has(refusal("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n9999999999 0 1\n"), "9999999999 corners"));
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

} // namespace read_tin_test
