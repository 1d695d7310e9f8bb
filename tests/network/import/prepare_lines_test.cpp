// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/prepare_lines.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <network/rivers.hpp>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/geometry/crossings.hpp>

namespace prepare_lines_test {

using namespace thalweg;
using network::cut_loops;
using network::CutLine;
using Line = std::vector<Vec3>;

namespace {

using test::lines_of;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

RiverLine line(std::int64_t feature, std::vector<Vec2> const& plan, std::string artificial = "") {
    RiverLine one;
    one.feature = feature;
    for (Vec2 const p : plan) {
        one.vertices.push_back({p.x, p.y, none});
    }
    one.artificial = std::move(artificial);
    return one;
}

RiverLines file(std::vector<RiverLine> rivers, std::vector<RiverLine> channels) {
    RiverLines lines;
    lines.lines = std::move(rivers);
    lines.channels = std::move(channels);
    return lines;
}

/// Feature and length of the channels that are kept.
std::vector<std::pair<std::int64_t, double>> kept(RiverLines const& before) {
    RiverLines const after = network::keep_connectors(before, 0.0);
    EXPECT_TRUE(after.channels.empty());
    std::vector<std::pair<std::int64_t, double>> result;
    double of_channels = 0.0;
    for (std::size_t l = 0; l < after.lines.size(); ++l) {
        if (l < before.lines.size()) {
            EXPECT_EQ(after.lines[l].feature, before.lines[l].feature);
        } else {
            EXPECT_FALSE(after.lines[l].artificial.empty());
            result.emplace_back(after.lines[l].feature, length_in_plan(after.lines[l].vertices));
            of_channels += result.back().second;
        }
    }
    EXPECT_EQ(std::ranges::count(after.findings, std::string_view("connector"), &Finding::kind), std::ssize(result));
    for (SecondaryLine const& one : after.secondary) {
        EXPECT_EQ(one.cause, LeftOut::filter);
        EXPECT_EQ(one.reason, "waterway ditch");
        of_channels += length_in_plan(one.vertices);
    }
    double given = 0.0;
    for (RiverLine const& channel : before.channels) {
        given += length_in_plan(channel.vertices);
    }
    EXPECT_NEAR(of_channels, given, 1e-9); // law: each metre is kept or left out
    return result;
}

using ResultCache = std::vector<std::pair<std::int64_t, double>>;

std::string const ditch = "waterway ditch";

Grid const ten{10, 10, 1.0, 0.0, 10.0, ""};

} // namespace

TEST(KeepConnectors, NothingToKeep) {
    EXPECT_EQ(kept(file({}, {})), ResultCache{});
    EXPECT_EQ(kept(file({}, {line(1, {{0, 0}, {5, 0}}, ditch)})), ResultCache{});
    EXPECT_EQ(kept(file({line(1, {{0, 9}, {0, 0}})}, {line(2, {{50, 0}, {60, 0}}, ditch)})), ResultCache{});
}

TEST(KeepConnectors, ARiverContinuesThroughADitch) {
    std::vector<RiverLine> const rivers = {line(1, {{0, 100}, {0, 50}}), line(2, {{0, 30}, {0, 0}})};
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {0, 30}}, ditch)})), (ResultCache{{3, 20.0}}));
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 30}, {0, 50}}, ditch)})), (ResultCache{{3, 20.0}}))
        << "drawn against the flow";
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {0, 40}}, ditch), line(4, {{0, 40}, {0, 30}}, ditch)})),
              (ResultCache{{3, 10.0}, {4, 10.0}}));
    // By the shorter of two ways.
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {15, 40}, {0, 30}}, ditch), line(4, {{0, 50}, {0, 30}}, ditch)})),
              (ResultCache{{4, 20.0}}));
    // Of a canal only the part that is needed.
    EXPECT_EQ(kept(file({line(1, {{0, 100}, {0, 50}}), line(2, {{20, 50}, {20, 0}})},
                        {line(3, {{-40, 50}, {0, 50}, {10, 50}, {20, 50}, {90, 50}}, ditch)})),
              (ResultCache{{3, 20.0}}));
}

TEST(KeepConnectors, DitchesThatNoRiverNeedsAreLeftOut) {
    std::vector<RiverLine> const rivers = {line(1, {{0, 100}, {0, 50}, {0, 0}}), line(2, {{80, 90}, {80, 0}})};
    EXPECT_EQ(kept(file(rivers, {line(3, {{30, 60}, {0, 50}}, ditch)})), ResultCache{}) << "it drains a field";
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {30, 40}}, ditch)})), ResultCache{}) << "it irrigates one";
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 50}, {80, 90}}, ditch)})), ResultCache{}) << "it feeds another river";
    EXPECT_EQ(kept(file(rivers, {line(3, {{0, 0}, {0, -50}}, ditch)})), ResultCache{}) << "it leads to no river";
}

TEST(KeepConnectors, RiversThatAreDrawnUpstreamEndWhereTheyBegin) {
    // One source and two ends: the group is drawn upstream, and so is the river without a tributary.
    EXPECT_EQ(kept(file({line(1, {{0, 50}, {0, 80}}), line(2, {{0, 80}, {9, 99}}), line(3, {{0, 80}, {-9, 99}}),
                         line(4, {{0, 0}, {0, 30}})},
                        {line(5, {{0, 50}, {0, 30}}, ditch)})),
              (ResultCache{{5, 20.0}}));
}

TEST(KeepConnectors, HeightsDecideWhereARiverEnds) {
    RiverLines lines =
        file({line(1, {{0, 50}, {0, 100}}), line(2, {{0, 30}, {0, 0}})}, {line(3, {{0, 50}, {0, 30}}, ditch)});
    EXPECT_EQ(kept(lines), ResultCache{});
    lines.lines[0].vertices[0].z = 5.0;
    lines.lines[0].vertices[1].z = 9.0;
    lines.lines[1].vertices[0].z = lines.lines[1].vertices[1].z = 1.0;
    lines.has_z = true;
    EXPECT_EQ(kept(lines), (ResultCache{{3, 20.0}}));
    EXPECT_FALSE(network::keep_connectors(lines, 0.0).has_z); // the ditch has none yet
}

TEST(KeepConnectors, EndsMeetWithinTheSnappingDistance) {
    RiverLines const lines =
        file({line(1, {{0, 100}, {0, 52}}), line(2, {{1, 29}, {0, 0}})}, {line(3, {{0, 50}, {0, 30}}, ditch)});
    EXPECT_EQ(kept(lines), ResultCache{});
    EXPECT_EQ(network::keep_connectors(lines, 3.0).lines.size(), 3U);
}

TEST(ClipLines, NothingInside) {
    EXPECT_TRUE(network::clip_lines({}, ten).lines.empty());
    EXPECT_TRUE(network::clip_lines(lines_of({{{-5, 5, 1}, {-1, 5, 0}}}), ten).lines.empty());
    EXPECT_TRUE(network::clip_lines(lines_of({{{-5, 0, 1}, {0, -5, 0}}}), ten).lines.empty());
    EXPECT_TRUE(network::clip_lines(lines_of({{{0, 5, 1}, {-3, 5, 0}}}), ten).lines.empty())
        << "touches the edge in one point";
}

TEST(ClipLines, AllInsideIsKeptBitForBit) {
    RiverLines const lines = lines_of({{{0.1, 0.2, 3}, {5, 5, 2}, {10, 10, 1}}});
    RiverLines const out = network::clip_lines(lines, ten);
    ASSERT_EQ(out.lines.size(), 1U);
    EXPECT_EQ(out.lines[0].vertices, lines.lines[0].vertices);
}

TEST(ClipLines, LeavesAndReturns) {
    RiverLines const out = network::clip_lines(lines_of({{{2, 5, 8}, {12, 5, 6}, {12, 7, 4}, {2, 7, 2}}}), ten);
    ASSERT_EQ(out.lines.size(), 2U);
    EXPECT_EQ(out.lines[0].vertices, (std::vector<Vec3>{{2, 5, 8}, {10, 5, 6.4}}));
    EXPECT_EQ(out.lines[1].vertices, (std::vector<Vec3>{{10, 7, 3.6}, {2, 7, 2}}));
    EXPECT_EQ(out.lines[1].feature, 1);
    // Without a vertex inside.
    RiverLines const across = network::clip_lines(lines_of({{{-10, 5, 30}, {20, 5, 0}}}), ten);
    ASSERT_EQ(across.lines.size(), 1U);
    EXPECT_EQ(across.lines[0].vertices, (std::vector<Vec3>{{0, 5, 20}, {10, 5, 10}}));
}

// Law: every metre is inside or beyond.
TEST(ClipLines, WhatLiesBeyondIsSecondary) {
    auto const lines = lines_of({{{-10, 5, 30}, {2, 5, 8}, {12, 5, 6}, {12, 7, 4}, {2, 7, 2}, {2, 20, 0}}});
    RiverLines const out = network::clip_lines(lines, ten);
    double inside = 0.0;
    double beyond = 0.0;
    for (RiverLine const& line : out.lines) {
        inside += length_in_plan(line.vertices);
    }
    for (SecondaryLine const& line : out.secondary) {
        EXPECT_EQ(line.cause, LeftOut::grid);
        EXPECT_EQ(line.record, line.feature);
        beyond += length_in_plan(line.vertices);
    }
    EXPECT_EQ(out.secondary.size(), 3U);
    EXPECT_NEAR(inside + beyond, length_in_plan(lines.lines.front().vertices), 1e-9);
    EXPECT_TRUE(network::clip_lines(lines_of({{{2, 5, 8}, {3, 5, 6}}}), ten).secondary.empty());
    EXPECT_EQ(network::clip_lines(lines_of({{{-5, 0, 1}, {0, -5, 0}}}), ten).secondary.size(), 1U);
}

namespace {

/// Of the outermost cells, lines have only those of their ends.
void expect_ended(RiverLines const& lines, Grid const& grid) {
    for (RiverLine const& line : lines.lines) {
        std::vector<Vec2> plan;
        for (Vec3 const& v : line.vertices) {
            plan.push_back(in_plan(v));
        }
        std::vector<Cell> const cells = cells_along(plan, grid); // throws off the grid
        for (std::size_t i = 1; i + 1 < cells.size(); ++i) {
            EXPECT_FALSE(grid.on_border(cells[i])) << "line " << line.feature << ", cell " << i;
        }
        EXPECT_TRUE(cells.size() > 1 || (!line.begins_at_edge && !line.ends_at_edge));
        EXPECT_TRUE(!line.begins_at_edge || grid.on_border(cells.front()));
        EXPECT_TRUE(!line.ends_at_edge || grid.on_border(cells.back()));
    }
}

RiverLines ended(std::vector<Line> const& drawn) {
    RiverLines const out = network::end_at_edge(lines_of(drawn), ten);
    expect_ended(out, ten);
    return out;
}

} // namespace

TEST(EndAtEdge, WhatEndsThereIsKeptBitForBit) {
    for (Line const& line : {Line{{2, 5, 3}, {5, 5, 2}, {8, 5, 1}}, Line{{2, 5, 3}, {9.7, 5.2, 1}},
                             Line{{0.1, 5, 3}, {5, 5, 2}, {10, 5, 1}}}) {
        RiverLines const out = ended({line});
        ASSERT_EQ(out.lines.size(), 1U);
        EXPECT_EQ(out.lines[0].vertices, line);
        EXPECT_FALSE(out.lines[0].begins_at_edge || out.lines[0].ends_at_edge);
        EXPECT_TRUE(out.secondary.empty());
    }
    Line const trunk{{5, 5, 2}, {10, 5, 1}}; // drawn twice, with a tributary at its mouth
    EXPECT_TRUE(ended({trunk, trunk, {{5, 8, 2}, {8.9, 5.2, 1.5}, {10, 5, 1}}}).secondary.empty());
    Grid const small{4, 4, 1.0, 0.0, 4.0, ""};
    EXPECT_EQ(network::end_at_edge(lines_of({{{-1, 2, 1}, {5, 2, 0}}}), small).lines.size(), 1U);
}

TEST(EndAtEdge, ALineThatLeavesIsDrawnOnStraight) {
    RiverLines const out = ended({{{5, 5, 5}, {15, 10, 0}}}); // through two outermost cells
    ASSERT_EQ(out.lines.size(), 1U);
    Line const& line = out.lines[0].vertices;
    ASSERT_EQ(line.size(), 3U);
    EXPECT_EQ(line.front(), (Vec3{5, 5, 5}));
    EXPECT_NEAR(line[1].x, 8.999, 1e-9);
    EXPECT_NEAR(line[1].y, 6.9995, 1e-9);
    EXPECT_EQ(line[2].x, 10.0);
    EXPECT_EQ(line[2].y, line[1].y);
    EXPECT_LT(line[2].z, line[1].z) << "it goes on falling";
    EXPECT_TRUE(out.lines[0].ends_at_edge && !out.lines[0].begins_at_edge);
    ASSERT_EQ(out.secondary.size(), 1U);
    EXPECT_EQ(out.secondary[0].cause, LeftOut::grid);
    // The same upstream.
    RiverLines const back = ended({{{15, 10, 9}, {5, 5, 5}}});
    ASSERT_EQ(back.lines.size(), 1U);
    EXPECT_EQ(back.lines[0].vertices.front().x, 10.0);
    EXPECT_TRUE(back.lines[0].begins_at_edge && !back.lines[0].ends_at_edge);
}

TEST(EndAtEdge, ALineAlongTheEdgeIsCut) {
    RiverLines const out = ended({{{5, 2, 9}, {9.5, 2.5, 7}, {9.5, 7.5, 3}, {5, 8, 1}}});
    ASSERT_EQ(out.lines.size(), 2U);
    EXPECT_TRUE(out.lines[0].ends_at_edge && out.lines[1].begins_at_edge);
    EXPECT_EQ(ended({{{9.5, 2.5, 7}, {9.5, 7.5, 3}}}).lines.size(), 0U);
    EXPECT_EQ(ended({{{20, 2.5, 7}, {20, 7.5, 3}}}).lines.size(), 0U);
    // It comes back at once.
    RiverLines const bend = ended({{{5, 5, 9}, {12, 5.5, 5}, {5, 6, 1}}});
    ASSERT_EQ(bend.lines.size(), 1U);
    EXPECT_FALSE(bend.lines[0].begins_at_edge || bend.lines[0].ends_at_edge);
    EXPECT_EQ(bend.secondary.size(), 1U);
}

// Without land between them.
TEST(EndAtEdge, EndsSideBySideAreJoined) {
    RiverLines const both = ended({{{5, 5.2, 9}, {20, 5.4, 5}}, {{5, 4.2, 9}, {20, 4.4, 5}}});
    ASSERT_EQ(both.lines.size(), 2U);
    EXPECT_TRUE(both.lines[0].ends_at_edge && !both.lines[1].ends_at_edge);
    EXPECT_EQ(both.lines[1].vertices.back(), both.lines[0].vertices[1]);
    // Out, and in again in another line.
    RiverLines const back = ended({{{5, 5.2, 9}, {20, 5.4, 5}}, {{20, 4.4, 5}, {5, 4.2, 1}}});
    ASSERT_EQ(back.lines.size(), 2U);
    EXPECT_FALSE(back.lines[0].ends_at_edge || back.lines[1].begins_at_edge);
    EXPECT_EQ(back.lines[0].vertices.back(), back.lines[1].vertices.front());
    // Two heads.
    RiverLines const heads = ended({{{20, 5.4, 9}, {5, 5.2, 5}}, {{20, 4.4, 9}, {5, 4.2, 5}}});
    EXPECT_TRUE(heads.lines[0].begins_at_edge && heads.lines[1].begins_at_edge);
}

// A confluence in the outermost cells: both rivers end at the edge, each by itself.
TEST(EndAtEdge, LinesThatMeetThereAreParted) {
    RiverLines const out =
        ended({{{8, 2, 9}, {9.5, 5.5, 5}}, {{8, 9, 9}, {9.5, 5.5, 5}}, {{9.5, 5.5, 5}, {12, 5.5, 0}}});
    ASSERT_EQ(out.lines.size(), 2U);
    EXPECT_NE(out.lines[0].vertices.back(), out.lines[1].vertices.back());
    EXPECT_TRUE(out.lines[0].ends_at_edge && out.lines[1].ends_at_edge);
}

TEST(EndAtEdge, AnyLineEndsThere) {
    ASSERT_TRUE(rc::check("no line runs along the edge", [] {
        std::vector<Line> drawn;
        for (int k = *rc::gen::inRange(1, 4); k > 0; --k) {
            Line line;
            for (int n = *rc::gen::inRange(2, 9); n > 0; --n) {
                line.push_back({*rc::gen::inRange(-30, 130) / 10.0, *rc::gen::inRange(-30, 130) / 10.0, 1.0 * n});
            }
            drawn.push_back(std::move(line));
        }
        ended(drawn);
        RC_ASSERT(!testing::Test::HasFailure());
    }));
}

// Law: every metre is inside or beyond, and no vertex lies in a cell that is not marked.
TEST(ClipLines, CutsWhereTheLandEnds) {
    Mask land(Grid{10, 10, 1.0, 0.0, 10.0, ""}, 1);
    for (std::int64_t row = 0; row < 10; ++row) {
        land[Cell{4, row}] = land[Cell{5, row}] = 0;
    }
    auto const lines = lines_of({{{0.5, 5.5, 9}, {9.5, 5.5, 0}},
                                 {{4.2, 3.5, 1}, {4.2, 1.5, 0}},
                                 {{9.5, 9.5, 1}, {6, 9, 0}},
                                 {{8, 3, 2}, {7, 2, 1}, {6, 1.5, 0}, {5.5, 1, 0}}});
    RiverLines const out = network::clip_lines(lines, land);
    ASSERT_EQ(out.lines.size(), 4U);
    EXPECT_EQ(out.lines[0].vertices.front(), (Vec3{0.5, 5.5, 9}));
    EXPECT_NEAR(out.lines[0].vertices.back().x, 3.5, 1e-9);
    EXPECT_NEAR(out.lines[1].vertices.front().x, 6.5, 1e-9);
    EXPECT_NEAR(out.lines[1].vertices.front().z, 3.0, 1e-9);
    EXPECT_EQ(out.lines[2].vertices, lines.lines[2].vertices);
    double metres = 0.0;
    for (RiverLine const& line : out.lines) {
        metres += length_in_plan(line.vertices);
        for (Vec3 const& v : line.vertices) {
            EXPECT_NE(land[land.grid().cell_of(in_plan(v))], 0) << v.x << " " << v.y;
        }
    }
    EXPECT_EQ(out.secondary.size(), 3U);
    for (SecondaryLine const& line : out.secondary) {
        metres += length_in_plan(line.vertices);
    }
    double asked = 0.0;
    for (RiverLine const& line : lines.lines) {
        asked += length_in_plan(line.vertices);
    }
    EXPECT_NEAR(metres, asked, 1e-9);
    // A vertex on the edge of a cell that is no land leaves the line whole.
    RiverLines const along = network::clip_lines(lines_of({{{3.5, 8, 3}, {4, 7, 2}, {3.5, 6, 1}}}), land);
    ASSERT_EQ(along.lines.size(), 1U);
    EXPECT_EQ(along.lines[0].vertices.front(), (Vec3{3.5, 8, 3}));
    EXPECT_EQ(along.lines[0].vertices.back(), (Vec3{3.5, 6, 1}));
    EXPECT_TRUE(along.secondary.empty());
}

TEST(CutLoops, NothingToCut) {
    EXPECT_TRUE(cut_loops({}).line.empty());
    EXPECT_EQ(cut_loops({{1, 2, 3}}).line, (Line{{1, 2, 3}}));
    Line const bend{{0, 0, 3}, {1, 0, 2}, {1, 1, 1}};
    EXPECT_EQ(cut_loops(bend).line, bend);
    EXPECT_EQ(cut_loops(bend).cut_m, 0.0);
    EXPECT_EQ(cut_loops({{0, 0, 2}, {0, 0, 2}, {1, 0, 1}}).line, (Line{{0, 0, 2}, {1, 0, 1}}));
    EXPECT_THROW(cut_loops({{0, 0, 0}, {std::numeric_limits<double>::infinity(), 0, 0}, {1, 1, 0}}), BadInput);
}

TEST(CutLoops, ACrossingBecomesAVertexAndARingAPoint) {
    CutLine const cut = cut_loops({{0, 0, 5}, {4, 0, 4}, {4, 2, 3}, {2, 2, 2}, {2, -2, 1}});
    EXPECT_EQ(cut.line, (Line{{0, 0, 5}, {2, 0, 4.5}, {2, -2, 1}}));
    EXPECT_EQ(cut.cut_m, 8.0);
    EXPECT_EQ(cut_loops({{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 0, 1}}).line.size(), 1U);
}

TEST(CutLoops, SpikesGo) {
    EXPECT_EQ(cut_loops({{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {1, 0, 2}, {2, 0, 1}}).line,
              (Line{{0, 0, 2}, {1, 0, 2}, {2, 0, 1}}));
    // Back along itself: it goes on from where it turned.
    EXPECT_EQ(cut_loops({{0, 0, 2}, {2, 0, 2}, {1, 0, 2}, {1, 1, 1}}).line, (Line{{0, 0, 2}, {1, 0, 2}, {1, 1, 1}}));
    // Nearly.
    Line const nearly{{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {1.001, 0, 2}, {2, 0, 1}};
    EXPECT_EQ(cut_loops(nearly).line, nearly);
    EXPECT_EQ(cut_loops(nearly, 0.01).line, (Line{{0, 0, 2}, {1, 0, 2}, {1.001, 0, 2}, {2, 0, 1}}));
}

TEST(CutLoops, AnyLineBecomesSimple) {
    ASSERT_TRUE(rc::check("ends stay, nothing meets itself, nothing is added", [] {
        auto const whole = [](int beyond) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, beyond)); };
        Line line(static_cast<std::size_t>(2 + whole(9)));
        for (Vec3& p : line) {
            p = {static_cast<double>(whole(7)), static_cast<double>(whole(7)), static_cast<double>(whole(3))};
        }
        CutLine const cut = cut_loops(line);
        std::vector<Vec2> plan;
        for (Vec3 const p : cut.line) {
            plan.push_back({p.x, p.y});
        }
        RC_ASSERT(geometry::crossings({plan}).empty());
        RC_ASSERT(plan.front() == (Vec2{line.front().x, line.front().y}));
        RC_ASSERT(plan.back() == (Vec2{line.back().x, line.back().y}));
        RC_ASSERT(cut.cut_m >= 0.0);
    }));
}

} // namespace prepare_lines_test
