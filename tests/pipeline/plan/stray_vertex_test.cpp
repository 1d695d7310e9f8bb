// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/plan/internal/plan.hpp>

#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace stray_vertex_test {

using namespace thalweg;
using pipeline::require_no_stray_vertex;

namespace {

using test::has;
using test::message_of;

/// Two rivers of 40 vertices each, a few kilometres long.
RiverLines two_rivers() {
    RiverLines rivers;
    rivers.name = "rivers.gpkg";
    for (int r = 0; r < 2; ++r) {
        RiverLine& line = rivers.lines.emplace_back();
        line.feature = r + 1;
        for (int i = 0; i < 40; ++i) {
            line.vertices.push_back({500000.0 + 90.0 * i + 20.0 * (i % 3), 4500000.0 + 2000.0 * r + 60.0 * i, 0.0});
        }
    }
    return rivers;
}

} // namespace

TEST(StrayVertex, NothingAndLittleTellNothing) {
    EXPECT_NO_THROW(require_no_stray_vertex({}));
    RiverLines one;
    one.lines.emplace_back().vertices = {{0.0, 0.0, 0.0}, {500000.0, 0.0, 0.0}, {500010.0, 0.0, 0.0}};
    EXPECT_NO_THROW(require_no_stray_vertex(one));
}

TEST(StrayVertex, AnyLineThatReachesFarInStepsStays) {
    EXPECT_NO_THROW(require_no_stray_vertex(two_rivers()));
    RiverLines far = two_rivers();
    for (int i = 0; i < 10; ++i) {
        far.lines[0].vertices.push_back({504000.0 + 20000.0 * i, 4503000.0, 0.0});
    }
    EXPECT_NO_THROW(require_no_stray_vertex(far));
}

TEST(StrayVertex, ALostCoordinateIsNamed) {
    for (Vec3 const lost : {Vec3{0.0, 4500100.0, 0.0}, Vec3{500100.0, 0.3, 0.0}, Vec3{0.0, 0.0, 0.0},
                            Vec3{5.0e6, 4500100.0, 0.0}, Vec3{500100.0, 4.5e7, 0.0}}) {
        RiverLines rivers = two_rivers();
        rivers.lines[1].vertices[17] = lost;
        EXPECT_TRUE(has(message_of<BadInput>([&] { require_no_stray_vertex(rivers); }),
                        "river 2 in rivers.gpkg has a vertex at"))
            << lost.x << " " << lost.y;
    }
}

} // namespace stray_vertex_test
