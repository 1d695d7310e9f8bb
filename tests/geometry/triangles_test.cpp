// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/geometry/triangles.hpp>

#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace triangles_test {

using namespace thalweg;
using namespace thalweg::geometry;

namespace {

/// A 4 x 4 grid of vertices whose squares are halved along one diagonal or, at random, either.
Tin grid_tin(double side, double west, double north, std::uint64_t seed) {
    Tin tin;
    for (int row = 0; row < 4; ++row) {
        for (int col = 0; col < 4; ++col) {
            tin.vertices.push_back({west + side * col, north - side * row, 0.0});
        }
    }
    for (std::uint32_t row = 0; row < 3; ++row) {
        for (std::uint32_t col = 0; col < 3; ++col) {
            std::uint32_t const nw = 4 * row + col;
            std::uint32_t const ne = nw + 1;
            std::uint32_t const sw = nw + 4;
            std::uint32_t const se = nw + 5;
            bool const rising = seed == 0 || (seed > 1 && random_word(seed, nw) % 2 == 0);
            if (rising) {
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

std::map<std::uint32_t, double> stiffness_row(Tin const& tin, std::uint32_t vertex, Measured measured) {
    auto const cotangents = half_cotangents(tin, measured);
    std::map<std::uint32_t, double> row;
    for (std::size_t i = 0; i < tin.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t const a = tin.triangles[i][(k + 1) % 3];
            std::uint32_t const b = tin.triangles[i][(k + 2) % 3];
            if (a == vertex || b == vertex) {
                row[vertex] += cotangents[i][k];
                row[a == vertex ? b : a] -= cotangents[i][k];
            }
        }
    }
    return row;
}

} // namespace

TEST(Cotangents, RefuseTrianglesWithoutArea) {
    EXPECT_TRUE(half_cotangents({}).empty());
    Tin tin{{{0, 0, 0}, {1, 0, 0}, {2, 0, 5}, {0, 1, 0}}, {{0, 1, 3}, {0, 1, 2}}};
    EXPECT_THROW(half_cotangents(tin), BadInput);
    EXPECT_EQ(half_cotangents(tin, Measured::on_surface).size(), 2U);
    tin.vertices[2].z = 0.0;
    EXPECT_THROW(half_cotangents(tin, Measured::on_surface), BadInput);
    tin.triangles[1] = {0, 1, 4};
    EXPECT_THROW(half_cotangents(tin), BadInput);
    tin.triangles[1] = {0, 1, 3};
    tin.vertices[3].z = std::numeric_limits<double>::infinity();
    EXPECT_THROW(half_cotangents(tin), BadInput);
}

TEST(Cotangents, OfAGridAreTheFivePointStencilWithAnyDiagonal) {
    for (double const side : {1.0, 30.0, 0.1}) {
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            for (Measured const measured : {Measured::in_plan, Measured::on_surface}) {
                bool const exact = side != 0.1; // steps of 0.1 m are not all the same in doubles
                Tin const tin = grid_tin(side, 500000.0, 4649760.0, seed);
                for (std::uint32_t const v : {5U, 6U, 9U, 10U}) {
                    std::map<std::uint32_t, double> const wanted{
                        {v, 4.0}, {v - 1, -1.0}, {v + 1, -1.0}, {v - 4, -1.0}, {v + 4, -1.0}};
                    for (auto const& [other, weight] : stiffness_row(tin, v, measured)) {
                        double const expected = wanted.contains(other) ? wanted.at(other) : 0.0;
                        if (exact) {
                            EXPECT_EQ(weight, expected) << v << " " << other;
                        } else {
                            EXPECT_NEAR(weight, expected, 1e-6) << v << " " << other;
                        }
                    }
                }
            }
        }
    }
}

TEST(Cotangents, AreThoseOfTheAngles) {
    ASSERT_TRUE(rc::check("in plan and in space, in either direction", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1000000).as("seed");
        Tin tin{{}, {{0, 1, 2}}};
        for (std::uint64_t i = 0; i < 3; ++i) {
            auto const words = random_block(seed, i);
            tin.vertices.push_back({unit(words[0]), unit(words[1]), unit(words[2])});
        }
        for (Measured const measured : {Measured::in_plan, Measured::on_surface}) {
            auto const cotangents = half_cotangents(tin, measured)[0];
            for (std::size_t k = 0; k < 3; ++k) {
                auto const side = [&](std::size_t to) {
                    Vec3 const& p = tin.vertices[k];
                    Vec3 const& q = tin.vertices[(k + to) % 3];
                    return Vec3{q.x - p.x, q.y - p.y, measured == Measured::in_plan ? 0.0 : q.z - p.z};
                };
                Vec3 const u = side(1);
                Vec3 const v = side(2);
                double const along = u.x * v.x + u.y * v.y + u.z * v.z;
                double const lengths =
                    std::sqrt((u.x * u.x + u.y * u.y + u.z * u.z) * (v.x * v.x + v.y * v.y + v.z * v.z));
                double const angle = std::acos(std::max(-1.0, std::min(1.0, along / lengths)));
                if (angle > 0.01 && angle < 3.13) {
                    RC_ASSERT(std::fabs(2.0 * cotangents[k] * std::sin(angle) - std::cos(angle)) <= 1e-9);
                }
            }
        }
    }));
}

} // namespace triangles_test
