// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/tin.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/blend/internal/region.hpp>
#include <thalweg/core/run/error.hpp>

#include "lands.hpp"

namespace paste_tin_test {

using namespace thalweg;
using namespace thalweg::blend;
using geometry::Measured;

namespace {

using test::full_message_of;

/// The centres of a land's cells as a TIN, each square halved along either diagonal.
Tin tin_of(Raster<float> const& land, std::uint64_t seed) {
    Tin tin;
    Grid const& grid = land.grid();
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Vec2 const p = grid.centre(grid.at(i));
        tin.vertices.push_back({p.x, p.y, land[i]});
    }
    for (std::int64_t row = 0; row + 1 < grid.height; ++row) {
        for (std::int64_t col = 0; col + 1 < grid.width; ++col) {
            auto const nw = static_cast<std::uint32_t>(grid.index({col, row}));
            std::uint32_t const ne = nw + 1;
            auto const sw = static_cast<std::uint32_t>(grid.index({col, row + 1}));
            std::uint32_t const se = sw + 1;
            if (random_word(seed, nw) % 2 == 0) {
                tin.triangles.push_back({sw, ne, nw});
                tin.triangles.push_back({sw, se, ne});
            } else {
                tin.triangles.push_back({nw, sw, se});
                tin.triangles.push_back({nw, se, ne});
            }
        }
    }
    return tin;
}

std::vector<Vec3> with_heights(Tin const& tin, Raster<float> const& land) {
    std::vector<Vec3> places = tin.vertices;
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i].z = land[static_cast<std::int64_t>(i)];
    }
    return places;
}

} // namespace

TEST(PasteTin, RefusesWhatCannotBePutTogether) {
    Tin const tin{{{0, 0, 1}, {1, 0, 2}, {0, 1, 3}, {5, 5, 0}, {6, 5, 0}, {5, 6, 0}, {9, 9, 9}},
                  {{0, 1, 2}, {3, 4, 5}}};
    auto const own = gradients_of(tin, tin.vertices);
    EXPECT_NE(full_message_of<BadInput>([&] {
                  paste_tin(tin, {}, {{0, {0, 0, 1}}});
              }).find("guidance for 0 triangles"),
              std::string::npos);
    EXPECT_EQ(full_message_of<BadInput>([&] {
                  paste_tin(tin, own, {{0, {0, 0, 1}}});
              }),
              "blend.paste_tin: the part of the mesh with vertex 4 at (5, 5, 0) has no fixed vertex: fix one");
    EXPECT_NE(full_message_of<BadInput>([&] {
                  paste_tin(tin, own, {{7, {}}});
              }).find("vertex 8 of 7"),
              std::string::npos);
    EXPECT_NE(full_message_of<BadInput>([&] {
                  paste_tin(tin, own, {{0, {0, 0, 1}}, {0, {0, 0, 2}}});
              }).find("give one of them"),
              std::string::npos);
    auto wrong = own;
    wrong[1].z.x = std::nan("");
    EXPECT_NE(full_message_of<BadInput>([&] {
                  paste_tin(tin, wrong, {{0, {0, 0, 1}}});
              }).find("triangle 2 is not finite"),
              std::string::npos);
    Tin flat = tin;
    flat.vertices[2] = {2, 0, 9};
    EXPECT_NE(full_message_of<BadInput>([&] { gradients_of(flat, flat.vertices); }).find("has no area in plan"),
              std::string::npos);
    EXPECT_NE(full_message_of<BadInput>([&] { gradients_of(tin, {}); }).find("0 places"), std::string::npos);
    EXPECT_THROW(rotation({0, 0, 0}, 10.0), BadParameter);
    EXPECT_THROW(rotation({0, 0, 1}, std::nan("")), BadParameter);
    EXPECT_EQ(paste_tin({}, {}, {}).tin.vertices.size(), 0U);
    // A vertex in no triangle stays.
    PastedTin const pasted = paste_tin(tin, own, {{0, {0, 0, 1}}, {3, {5, 5, 4}}});
    EXPECT_EQ(pasted.tin.vertices[6], tin.vertices[6]);
    EXPECT_NEAR(pasted.tin.vertices[5].z, 4.0, 1e-12);
}

TEST(PasteTin, OnAGridItIsTheFivePointForm) {
    ASSERT_TRUE(rc::check("to 1e-8, whichever way the squares are halved", [] {
        Grid const grid = test::frame(*rc::gen::inRange<std::int64_t>(3, 20).as("columns"),
                                      *rc::gen::inRange<std::int64_t>(3, 20).as("rows"), 30.0);
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        Raster<float> const target = lands::by_chance(grid, seed);
        Raster<float> const source = lands::by_chance(grid, seed + 1);
        Mask const pins = lands::mask_by_chance(grid, seed + 2, 0.05);
        Tin const tin = tin_of(target, seed + 3);
        std::vector<FixedVertex> fixed;
        Raster<std::uint8_t> kind(grid, static_cast<std::uint8_t>(solver::CellKind::free));
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (grid.on_border(grid.at(i)) || pins[i] != 0) {
                kind[i] = static_cast<std::uint8_t>(solver::CellKind::fixed);
                fixed.push_back({static_cast<std::uint32_t>(i), tin.vertices[static_cast<std::size_t>(i)]});
            }
        }
        solver::PoissonParams tight;
        tight.tolerance = 1e-12;
        auto const on_grid =
            solve_guided(kind, lands::patch_of(target, pins).z, lands::patch_of(source, pins).z, {}, tight);
        PastedTin const on_tin = paste_tin(tin, gradients_of(tin, with_heights(tin, source)), fixed);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            auto const& v = on_tin.tin.vertices[static_cast<std::size_t>(i)];
            RC_ASSERT(std::fabs(v.z - on_grid.value[i]) <= 1e-8);
            RC_ASSERT((v.x == grid.centre(grid.at(i)).x && v.y == grid.centre(grid.at(i)).y));
        }
        RC_ASSERT(on_tin.residual <= 1e-10);
    }));
}

TEST(PasteTin, ItsOwnGradientsGiveTheMeshBitForBit) {
    Grid const grid = test::frame(9, 7, 0.3);
    Tin const tin = tin_of(lands::by_chance(grid, 5), 6);
    for (Measured const measured : {Measured::in_plan, Measured::on_surface}) {
        auto const own = gradients_of(tin, tin.vertices, measured);
        PastedTin const pasted = paste_tin(tin, own, {{11, tin.vertices[11]}, {40, tin.vertices[40]}}, measured);
        EXPECT_EQ(pasted.tin.vertices, tin.vertices);
        EXPECT_EQ(pasted.tin.triangles, tin.triangles);
        EXPECT_EQ(pasted.residual, 0.0);
    }
}

TEST(PasteTin, GuidanceThatIsTurnedAndScaledTurnsAndScalesTheMesh) {
    ASSERT_TRUE(rc::check("about the fixed vertex, to 1e-9", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        Tin const tin = tin_of(lands::by_chance(test::frame(11, 9, 10.0), seed), seed);
        double const angle = *rc::gen::inRange(-180, 181).as("degrees");
        double const scale = *rc::gen::element(1.0, 0.5, 3.0).as("scale");
        bool const upright = *rc::gen::arbitrary<bool>().as("about z");
        Vec3 const axis = upright ? Vec3{0, 0, 2} : Vec3{1, -2, 0.5};
        auto guidance = gradients_of(tin, tin.vertices, Measured::on_surface);
        LinearMap const map = rotation(axis, angle, scale);
        for (CoordinateGradients& g : guidance) {
            g = mapped(map, g);
        }
        Vec3 const hub = tin.vertices[17];
        PastedTin const pasted = paste_tin(tin, guidance, {{17, hub}}, Measured::on_surface);
        double const c = std::cos(angle * 3.14159265358979323846 / 180.0);
        double const s = std::sin(angle * 3.14159265358979323846 / 180.0);
        for (std::size_t i = 0; i < tin.vertices.size(); ++i) {
            Vec3 const& p = tin.vertices[i];
            Vec3 const& q = pasted.tin.vertices[i];
            Vec3 const before{p.x - hub.x, p.y - hub.y, p.z - hub.z};
            Vec3 const after{q.x - hub.x, q.y - hub.y, q.z - hub.z};
            if (upright) {
                RC_ASSERT(std::fabs(after.x - scale * (c * before.x - s * before.y)) <= 1e-9);
                RC_ASSERT(std::fabs(after.y - scale * (s * before.x + c * before.y)) <= 1e-9);
                RC_ASSERT(std::fabs(after.z - scale * before.z) <= 1e-9);
            } else {
                auto const square = [](Vec3 const& v) { return v.x * v.x + v.y * v.y + v.z * v.z; };
                auto const along = [&](Vec3 const& v) { return v.x * axis.x + v.y * axis.y + v.z * axis.z; };
                RC_ASSERT(std::fabs(square(after) - scale * scale * square(before)) <= 1e-8 * (1.0 + square(before)));
                RC_ASSERT(std::fabs(along(after) - scale * along(before)) <= 1e-8);
            }
        }
    }));
}

TEST(PasteTin, StiffnessIsTheDivergenceOfHatGradients) {
    // (14): the share of corners i, j in a triangle is grad B_i . grad B_j |T|, whose off-diagonals are -cot/2.
    ASSERT_TRUE(rc::check("in plan and on the surface", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        Tin const tin = tin_of(lands::by_chance(test::frame(2, 2, 50.0), seed), seed);
        for (Measured const measured : {Measured::in_plan, Measured::on_surface}) {
            auto const cotangents = geometry::half_cotangents(tin, measured);
            for (std::size_t i = 0; i < tin.triangles.size(); ++i) {
                auto const& t = tin.triangles[i];
                auto const hats =
                    hat_gradients_by_area(tin.vertices[t[0]], tin.vertices[t[1]], tin.vertices[t[2]], measured);
                std::vector<Vec3> hat_places(tin.vertices.size());
                hat_places[t[1]] = {1.0, 0.0, 0.0};
                Vec3 const gradient = gradients_of(tin, hat_places, measured)[i].x;
                double const share = hats[0].x * gradient.x + hats[0].y * gradient.y + hats[0].z * gradient.z;
                RC_ASSERT(std::fabs(share + cotangents[i][2]) <= 1e-9);
            }
        }
    }));
}

} // namespace paste_tin_test
