// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <io/scratch_folder.hpp>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/io/mesh/tin.hpp>

namespace glb_test {

using namespace thalweg;

namespace {

std::string word(std::uint32_t value) {
    std::string bytes;
    for (unsigned k = 0; k < 4; ++k) {
        bytes += static_cast<char>((value >> (8 * k)) & 0xFFU);
    }
    return bytes;
}

std::string numbers(std::vector<float> const& of) {
    std::string bytes;
    for (float const number : of) {
        bytes += word(std::bit_cast<std::uint32_t>(number));
    }
    return bytes;
}

std::string glb(std::string text, std::string const& bin) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    auto const size = static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bin.size());
    return word(0x46546C67) + word(2) + word(size) + word(static_cast<std::uint32_t>(text.size())) + word(0x4E4F534A) +
           text + word(static_cast<std::uint32_t>(bin.size())) + word(0x004E4942) + bin;
}

/// A square in the plane y = 0 of two triangles, corners of 16 bits, vertices 16 bytes apart; and a line.
std::string square(std::string const& node, std::string const& more = "") {
    std::string bin = numbers({0, 0, 0, 9, 1, 0, 0, 9, 0, 0, 1, 9, 1, 0, 1, 9});
    for (int const corner : {0, 2, 1, 1, 2, 3}) {
        bin += static_cast<char>(corner);
        bin += '\0';
    }
    std::string const text =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0])" + more + R"(}],"nodes":[{"children":[1]},)" +
        R"({"mesh":0)" + node + R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1},)" +
        R"({"attributes":{"POSITION":0},"mode":1}]}],"accessors":[{"bufferView":0,"componentType":5126,"count":4,)" +
        R"("type":"VEC3"},{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],"bufferViews":[)" +
        R"({"buffer":0,"byteLength":64,"byteStride":16},{"buffer":0,"byteOffset":64,"byteLength":12}],)" +
        R"("buffers":[{"byteLength":76}]})";
    return glb(text, bin);
}

io::TinFile read(ScratchFolder const& folder, std::string const& bytes) {
    std::ofstream(folder / "a.glb", std::ios::binary) << bytes;
    return io::read_tin(folder / "a.glb");
}

} // namespace

TEST(Glb, IsTurnedUprightAtThePlaceOfItsNodes) {
    ScratchFolder const folder;
    io::TinFile const plain = read(folder, square(""));
    EXPECT_EQ(plain.tin.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {1, -1, 0}}));
    EXPECT_EQ(plain.tin.triangles.size(), 2U);
    ASSERT_EQ(plain.findings.size(), 1U);
    EXPECT_EQ(plain.findings[0].kind, FindingKind("mesh_turned"));
    io::TinFile const moved = read(folder, square(R"(,"translation":[10,5,2],"scale":[2,1,3])"));
    EXPECT_EQ(moved.tin.vertices[3], (Vec3{12, -5, 5}));
    // A quarter turn around y takes x to -z, the north.
    io::TinFile const turned = read(folder, square(R"(,"rotation":[0,0.7071067811865476,0,0.7071067811865476])"));
    EXPECT_NEAR(turned.tin.vertices[1].y, 1.0, 1e-12);
    io::TinFile const by_matrix = read(folder, square(R"(,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,7,8,9,1])"));
    EXPECT_EQ(by_matrix.tin.vertices[0], (Vec3{7, -9, 8}));
}

TEST(Glb, OfThalwegLiesInItsCrsWithoutExaggeration) {
    ScratchFolder const folder;
    io::TinFile const file =
        read(folder,
             square(R"(,"translation":[0,6,0])",
                    R"(,"extras":{"thalweg":"1","origin":[500000,4000000,100],"exaggeration":3,"crs":"EPSG:32631"})"));
    EXPECT_EQ(file.crs, "EPSG:32631");
    EXPECT_EQ(file.tin.vertices[0], (Vec3{500000, 4000000, 102}));
}

TEST(Glb, DamagedFilesAreRefusedOrReadAndNeverMore) {
    ScratchFolder const folder;
    std::string const whole = square("");
    for (std::size_t size = 0; size < whole.size(); ++size) {
        EXPECT_FALSE(test::message_of<Error>([&] { read(folder, whole.substr(0, size)); }).empty()) << size;
    }
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
        test::message_of<Error>([&] { read(folder, damaged); }); // refused or read
    }
    std::string around = whole;
    around.replace(around.find(R"("children":[1])"), 14, R"("children":[0])");
    EXPECT_TRUE(test::has(test::message_of<BadInput>([&] { read(folder, around); }), "without end"));
    std::string packed = whole;
    packed.replace(packed.find(R"("scene":0)"), 9, R"("extensionsRequired":["KHR_draco_mesh_compression"])");
    EXPECT_FALSE(test::message_of<BadInput>([&] { read(folder, packed); }).empty());
}

} // namespace glb_test
