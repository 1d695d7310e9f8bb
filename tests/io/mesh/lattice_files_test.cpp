// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/io/mesh/lattice_files.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/mesh/tin.hpp>

namespace lattice_files_test {

using namespace thalweg;

namespace {

Lattice land() {
    Grid grid = test::frame(3, 2, 10.0);
    grid.west = 500000.0;
    return {test::raster_of(grid, [](Cell c) { return static_cast<float>(100 + 3 * c.col + 7 * c.row * c.col); }),
            10.0};
}

std::array<float, 12> facet(std::string const& bytes, std::size_t number) {
    std::array<float, 12> numbers{};
    std::memcpy(numbers.data(), bytes.data() + 84 + 50 * number, sizeof numbers);
    return numbers;
}

} // namespace

TEST(LatticeFiles, StlHasTheTrianglesAndTheirNormals) {
    ScratchFolder const folder;
    LatticeMesh const solid = solid_mesh(land(), 5.0);
    io::write_stl(solid, folder / "a.stl");
    std::string const bytes = test::bytes_of(folder / "a.stl");
    ASSERT_EQ(bytes.size(), 84 + 50 * solid.triangles.size());
    EXPECT_NE(bytes.substr(0, 5), "solid");
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    ASSERT_EQ(count, solid.triangles.size());
    for (std::size_t i = 0; i < count; ++i) {
        auto const numbers = facet(bytes, i);
        for (std::size_t k = 0; k < 3; ++k) {
            Vec3 const v = solid.vertices[solid.triangles[i][k]];
            EXPECT_EQ(numbers[3 + 3 * k], static_cast<float>(v.x));
            EXPECT_EQ(numbers[4 + 3 * k], static_cast<float>(v.y));
            EXPECT_EQ(numbers[5 + 3 * k], static_cast<float>(v.z));
        }
        EXPECT_NEAR(norm(Vec3{numbers[0], numbers[1], numbers[2]}), 1.0, 1e-6);
    }
    EXPECT_GT(facet(bytes, 0)[2], 0.5F);          // the surface looks up
    EXPECT_EQ(facet(bytes, count - 1)[2], -1.0F); // the base down
}

TEST(LatticeFiles, ObjIsYUpWithPlacesFromTheSouthWest) {
    ScratchFolder const folder;
    LatticeMesh const mesh = surface_mesh(land());
    io::write_textured_obj(mesh, folder / "a.obj", {"EPSG:32631", "a.mtl", "ground"});
    std::string const text = test::bytes_of(folder / "a.obj");
    EXPECT_TRUE(test::has(text, "# crs EPSG:32631\n", "# origin 500015 10 100 ", "mtllib a.mtl\nusemtl ground\n",
                          "v -10 0 -5\n", "v 10 20 5\n", "vt 0 1\n", "vt 1 0\n", "f 4/4 5/5 2/2\nf 4/4 2/2 1/1\n"));
    io::TinFile const read = io::read_tin(folder / "a.obj");
    EXPECT_EQ(read.tin.triangles, mesh.triangles);
    EXPECT_EQ(read.tin.vertices[5], (Vec3{500025.0, 5.0, 120.0})) << "upright again, at its place";
}

TEST(LatticeFiles, BadMeshesAreRefused) {
    ScratchFolder const folder;
    LatticeMesh mesh = surface_mesh(land());
    mesh.vertices[2].z = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { io::write_stl(mesh, folder / "a.stl"); }),
                          "vertex 3 is not finite"));
    EXPECT_NE(test::message_of<BadInput>([&] { io::write_textured_obj(mesh, folder / "a.obj", {}); }), "");
    EXPECT_NE(test::message_of<BadInput>([&] { io::write_stl({}, folder / "a.stl"); }), "");
    EXPECT_NE(
        test::message_of<BadInput>([&] { io::write_textured_obj(solid_mesh(land(), 1.0), folder / "a.obj", {}); }), "");
    EXPECT_EQ(folder.entries(), 0);
}

} // namespace lattice_files_test
