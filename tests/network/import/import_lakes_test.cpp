// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rivers that end at lakes and run on through them.
#include <thalweg/network/import/import_lines.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <network/rivers.hpp>
#include <rapidcheck/gtest.h>
#include <support.hpp>
#include <thalweg/geometry/polylines.hpp>

namespace import_lakes_test {

using namespace thalweg;
using network::import_lines;
using network::ImportedNetwork;
using network::ImportParams;

namespace {

constexpr ImportParams on_cells{.cell_m = 10.0};
using Line = std::vector<Vec2>;

/// Lines with a direction column, and lakes.
RiverLines with_lakes(std::vector<Line> const& lines, std::vector<std::vector<Line>> const& lakes, int runs = 1) {
    RiverLines rivers = test::flats(lines);
    for (RiverLine& line : rivers.lines) {
        line.runs = runs;
    }
    for (std::vector<Line> const& rings : lakes) {
        rivers.lakes.push_back({static_cast<std::int64_t>(rivers.lakes.size()) + 7, rings});
    }
    return rivers;
}

Line const square{{0, 0}, {200, 0}, {200, 200}, {0, 200}};

/// Of cells as large as those of on_cells.
Grid frame_of(double west, double north, std::int64_t width, std::int64_t height) {
    Grid grid;
    grid.cell_m = on_cells.cell_m;
    grid.west = west;
    grid.north = north;
    grid.width = width;
    grid.height = height;
    return grid;
}

std::vector<Finding> crossed(ImportedNetwork const& imported) {
    std::vector<Finding> found = imported.repairs;
    std::erase_if(found, [](Finding const& f) { return !(f.kind == FindingKind("lake_crossed")); });
    return found;
}

/// [m] Of arcs, what no feature of the file is.
double added_m(ImportedNetwork const& imported) {
    double sum = 0.0;
    for (ArcId a = 0; a < imported.network.arc_count(); ++a) {
        sum += imported.network.length_m(a);
        for (Stretch const& s : imported.stretches[a]) {
            sum -= s.to_m - s.from_m;
        }
    }
    return sum;
}

} // namespace

TEST(ImportLakes, AnInflowRunsOnToTheOutflow) {
    RiverLines const lines = with_lakes({{{100, 500}, {100, 200}}, {{100, 0}, {100, -300}}}, {{square}});
    RiverLines none = lines;
    none.lakes.clear();
    EXPECT_EQ(import_lines(none, on_cells).network.outlets().size(), 2U);
    ImportedNetwork const imported = import_lines(lines, on_cells);
    ASSERT_EQ(imported.network.arc_count(), 1U) << "one arc from spring to mouth";
    EXPECT_EQ(imported.network.arc(0).line.front(), (Vec2{100, 500}));
    EXPECT_EQ(imported.network.arc(0).line.back(), (Vec2{100, -300}));
    EXPECT_NEAR(imported.network.length_m(0), 800.0, 1e-6);
    EXPECT_NEAR(added_m(imported), 200.0, 1e-6);
    ASSERT_EQ(crossed(imported).size(), 1U);
    EXPECT_EQ(crossed(imported)[0].feature, 7);
    EXPECT_NEAR(crossed(imported)[0].amount, 200.0, 1e-6);
    EXPECT_EQ(imported.repairs.size(), 1U) << "the line through the lake is not the file's";
    EXPECT_TRUE(imported.secondary.empty());
}

TEST(ImportLakes, EndsMayLieBesideTheShoreOrInTheLake) {
    // 15 m before the shore; 60 m into the lake; an outflow that begins 4 m beyond the shore.
    RiverLines const lines = with_lakes(
        {{{100, 500}, {100, 215}}, {{-300, 100}, {60, 100}}, {{500, 120}, {202, 120}}, {{100, -4}, {100, -300}}},
        {{square}});
    ImportedNetwork const imported = import_lines(lines, on_cells);
    EXPECT_EQ(imported.network.outlets().size(), 1U);
    ASSERT_EQ(crossed(imported).size(), 1U);
    EXPECT_EQ(crossed(imported)[0].where, (Vec2{100, 0}));
    for (ArcId a = 0; a < imported.network.arc_count(); ++a) {
        EXPECT_TRUE(imported.network.arc(a).feature != 1 || imported.network.arc(a).line.front() == (Vec2{100, 500}));
    }
    // One that begins 15 m away is the outflow if no other is; an inflow that ends 25 m away is none.
    RiverLines const beside = with_lakes({{{100, 500}, {100, 215}}, {{100, -15}, {100, -300}}}, {{square}});
    EXPECT_EQ(crossed(import_lines(beside, on_cells)).size(), 1U);
    RiverLines with_other = beside;
    with_other.lines.push_back(beside.lines.back());
    with_other.lines.back().feature = 3;
    with_other.lines.back().vertices = {{200, 100, 0}, {500, 100, 0}};
    ImportedNetwork const two = import_lines(with_other, on_cells);
    ASSERT_EQ(crossed(two).size(), 1U);
    EXPECT_EQ(crossed(two)[0].where, (Vec2{200, 100}));
    EXPECT_TRUE(
        crossed(import_lines(with_lakes({{{100, 500}, {100, 225}}, {{100, 0}, {100, -300}}}, {{square}}), on_cells))
            .empty());
}

TEST(ImportLakes, LinesDrawnFarIntoIt) {
    RiverLines const lines = with_lakes({{{100, 500}, {100, 130}}, {{100, 70}, {100, -300}}}, {{square}});
    ImportedNetwork const imported = import_lines(lines, on_cells);
    EXPECT_EQ(imported.network.arc_count(), 1U);
    EXPECT_NEAR(added_m(imported), 60.0, 1e-6);
}

TEST(ImportLakes, WithoutAnOutflowTheWaterStays) {
    RiverLines const lines = with_lakes({{{100, 500}, {100, 200}}, {{-300, 100}, {0, 100}}}, {{square}});
    EXPECT_EQ(import_lines(lines, on_cells).network.outlets().size(), 2U);
}

TEST(ImportLakes, OfSeveralOutflowsByHeightsTheLowestTakesItsWater) {
    RiverLines lines =
        with_lakes({{{100, 500}, {100, 200}}, {{0, 100}, {-300, 100}}, {{100, 0}, {100, -900}}}, {{square}});
    lines.has_z = true;
    for (RiverLine& line : lines.lines) {
        line.runs = 0;
        for (Vec3& v : line.vertices) {
            v.z = v.y > 300.0 ? 90.0 : v.x < -100.0 || v.y < -100.0 ? 20.0 : v.x == 0.0 ? 52.0 : 50.0;
        }
    }
    ImportedNetwork const imported = import_lines(lines, on_cells);
    EXPECT_EQ(imported.network.outlets().size(), 2U) << "the other one keeps beginning at the shore";
    EXPECT_NEAR(added_m(imported), 200.0, 1.0);
    lines.lines[0].vertices.back().z = 40.0; // as noise
    EXPECT_EQ(crossed(import_lines(lines, on_cells)).size(), 1U);
    lines.lines[0].vertices.back().z = 25.0; // that far below the lake nothing runs into it
    EXPECT_TRUE(crossed(import_lines(lines, on_cells)).empty());
}

TEST(ImportLakes, TheRiverThatPassesThroughIsJoinedStraight) {
    RiverLines const lines = with_lakes(
        {{{100, 500}, {100, 100}, {100, -300}}, {{-300, 60}, {0, 60}}, {{500, 150}, {200, 150}}}, {{square}});
    ImportedNetwork const imported = import_lines(lines, on_cells);
    EXPECT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_NEAR(added_m(imported), 200.0, 1e-6);
    ASSERT_EQ(crossed(imported).size(), 1U);
    EXPECT_TRUE(test::has(crossed(imported)[0].text, "2 rivers that end at its shore")) << crossed(imported)[0].text;
}

TEST(ImportLakes, AroundTheCornerItIsJoinedAlongTheMiddle) {
    // A lake like an L; the river passes through the end of one arm, another ends at the end of the other.
    Line const arms{{0, 0}, {600, 0}, {600, 100}, {100, 100}, {100, 600}, {0, 600}};
    RiverLines const lines = with_lakes({{{550, 400}, {550, 50}, {550, -300}}, {{50, 900}, {50, 600}}}, {{arms}});
    ImportedNetwork const imported = import_lines(lines, on_cells);
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_NEAR(added_m(imported), 550.0 + 500.0, 120.0);
    for (Arc const& arc : imported.network.arcs()) {
        for (Vec2 const p : arc.line) {
            bool const is_ashore = p.y > 100.0 && p.y < 600.0 && p.x > 100.0 && p.x < 500.0;
            EXPECT_FALSE(is_ashore) << p.x << " " << p.y;
        }
    }
}

TEST(ImportLakes, OneAfterTheOther) {
    Line below = square;
    for (Vec2& p : below) {
        p.y -= 600.0;
    }
    RiverLines const lines = with_lakes({{{100, 500}, {100, 200}}, {{100, 0}, {100, -400}}, {{100, -600}, {100, -900}}},
                                        {{square}, {below}});
    ImportedNetwork const imported = import_lines(lines, on_cells);
    EXPECT_EQ(imported.network.arc_count(), 1U);
    EXPECT_EQ(crossed(imported).size(), 2U);
}

TEST(ImportLakes, DrawnUpstreamItIsTheSame) {
    RiverLines const lines =
        with_lakes({{{100, 200}, {100, 500}}, {{0, 100}, {-300, 100}}, {{100, -300}, {100, 0}}}, {{square}}, -1);
    ImportedNetwork const imported = import_lines(lines, on_cells);
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.network.node(imported.network.outlets()[0]).at, (Vec2{100, -300}));
}

TEST(ImportLakes, AllDrawnUpstreamIsTurnedAsAWhole) {
    // Nothing is said but the drawing, which forks at the lake.
    RiverLines lines =
        with_lakes({{{100, 200}, {100, 500}}, {{0, 100}, {-300, 100}}, {{100, -300}, {100, 0}}}, {{square}}, 0);
    ImportedNetwork const imported = import_lines(lines, on_cells);
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.network.node(imported.network.outlets()[0]).at, (Vec2{100, -300}));
    // The same with a river that passes through.
    lines = with_lakes({{{100, -300}, {100, 60}, {100, 500}}, {{0, 100}, {-300, 100}}, {{200, 80}, {500, 80}}},
                       {{square}}, 0);
    ImportedNetwork const through = import_lines(lines, on_cells);
    ASSERT_EQ(through.network.outlets().size(), 1U);
    EXPECT_EQ(through.network.node(through.network.outlets()[0]).at, (Vec2{100, -300}));
}

TEST(ImportLakes, ASecondOutflowBeginsAtTheShore) {
    RiverLines lines = with_lakes(
        {{{100, 500}, {100, 200}}, {{-300, 100}, {0, 100}}, {{100, 0}, {100, -300}}, {{200, 100}, {500, 100}}},
        {{square}}, 0);
    for (auto const asked : {network::Orientation::automatic, network::Orientation::as_drawn}) {
        ImportedNetwork const imported = import_lines(lines, {.orientation = asked, .cell_m = 10.0});
        EXPECT_EQ(imported.network.outlets().size(), 2U);
        EXPECT_TRUE(imported.secondary.empty());
        EXPECT_EQ(std::ranges::count_if(imported.repairs,
                                        [](Finding const& f) { return f.kind == FindingKind("lake_outflows"); }),
                  1);
    }
    for (RiverLine& line : lines.lines) { // no doubt then
        line.runs = 1;
    }
    ImportedNetwork const said = import_lines(lines, on_cells);
    EXPECT_EQ(said.network.outlets().size(), 2U);
    ASSERT_EQ(said.repairs.size(), 1U);
    EXPECT_TRUE(test::has(said.repairs[0].text, "another one begins at its shore")) << said.repairs[0].text;
}

// Whatever the drawing says.
TEST(ImportLakes, LinksNodesColumnsHeightsAndRanksDecide) {
    std::vector<Line> const lines{{{100, 500}, {100, 200}}, {{-300, 100}, {0, 100}}, {{100, 0}, {100, -300}}};
    using Say = void (*)(RiverLines&);
    Say const says[] = {[](RiverLines& rivers) { rivers.lines[0].down = rivers.lines[1].down = 3; },
                        [](RiverLines& rivers) {
                            for (RiverLine& line : rivers.lines) {
                                line.from_node = 10 + line.feature;
                                line.to_node = 2;
                            }
                            rivers.lines[2].from_node = 2;
                            rivers.lines[2].to_node = 20;
                        },
                        [](RiverLines& rivers) {
                            for (RiverLine& line : rivers.lines) {
                                line.rank = line.feature == 3 ? 1 : 2;
                            }
                        },
                        [](RiverLines& rivers) {
                            rivers.has_z = true;
                            for (RiverLine& line : rivers.lines) {
                                line.vertices[0].z = line.feature == 3 ? 50 : 90;
                                line.vertices[1].z = line.feature == 3 ? 20 : 50;
                            }
                        },
                        [](RiverLines& rivers) {
                            for (RiverLine& line : rivers.lines) {
                                line.runs = 1;
                            }
                        }};
    for (std::size_t by = 0; by < std::size(says); ++by) {
        for (std::size_t turned = 0; turned < 8; ++turned) {
            RiverLines rivers = with_lakes(lines, {{square}}, 0);
            says[by](rivers);
            for (std::size_t l = 0; l < 3; ++l) {
                if ((turned >> l & 1U) != 0) {
                    std::ranges::reverse(rivers.lines[l].vertices);
                    rivers.lines[l].runs = -rivers.lines[l].runs;
                }
            }
            ImportedNetwork const imported = import_lines(rivers, on_cells);
            ASSERT_EQ(imported.network.outlets().size(), 1U) << by << " " << turned;
            EXPECT_EQ(imported.network.node(imported.network.outlets()[0]).at, (Vec2{100, -300}))
                << by << " " << turned;
            EXPECT_TRUE(imported.secondary.empty()) << by << " " << turned;
        }
    }
}

TEST(ImportLakes, ALakeWithoutAnOutflowIsNamed) {
    RiverLines const lines =
        with_lakes({{{100, 500}, {100, 200}}, {{-300, 100}, {0, 100}}, {{100, -45}, {100, -300}}}, {{square}});
    ImportedNetwork const imported = import_lines(lines, on_cells);
    EXPECT_EQ(imported.network.outlets().size(), 3U);
    ASSERT_EQ(imported.repairs.size(), 1U);
    EXPECT_TRUE(test::has(imported.repairs[0].text, "2 rivers end at the shore of a lake that no river leaves"))
        << imported.repairs[0].text;
    EXPECT_TRUE(test::has(imported.repairs[0].text, "begins 45 m from its shore")) << imported.repairs[0].text;
    EXPECT_TRUE(test::has(imported.repairs[0].remedy, "network.lines.snap=45")) << imported.repairs[0].remedy;
}

TEST(ImportLakes, ItsWaterMayLeaveItWhereTheBorderIsNearest) {
    RiverLines const lines =
        with_lakes({{{100, 500}, {100, 200}}, {{-300, 100}, {0, 100}}, {{100, 900}, {200, 150}}}, {{square}});
    Grid const grid = frame_of(-400.0, 1000.0, 100, 110);
    ImportedNetwork const imported = import_lines(lines, {.cell_m = 10.0, .frame = &grid, .drains_lakes = true});
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.network.node(imported.network.outlets()[0]).at.y, 0.0);
    EXPECT_EQ(crossed(imported).size(), 1U);
}

TEST(ImportLakes, OneTooSmallForAnOutflowKeepsItsWater) {
    // Nowhere is its shore two cells away from both mouths, 36 m apart.
    Line const pond{{0, 98}, {36, 98}, {36, 102}, {0, 102}};
    RiverLines const lines = with_lakes({{{400, 100}, {36, 100}}, {{-300, 100}, {0, 100}}}, {{pond}});
    Grid const grid = frame_of(-400.0, 1000.0, 100, 110);
    ImportedNetwork const imported = import_lines(lines, {.cell_m = 10.0, .frame = &grid, .drains_lakes = true});
    EXPECT_EQ(imported.network.outlets().size(), 2U);
    ASSERT_EQ(imported.repairs.size(), 1U);
    EXPECT_FALSE(test::has(imported.repairs[0].text, "its water leaves it")) << imported.repairs[0].text;
}

TEST(ImportLakes, ARiverFarBelowItIsNamed) {
    RiverLines lines =
        with_lakes({{{100, 500}, {100, 200}}, {{-300, 100}, {0, 100}}, {{100, 0}, {100, -300}}}, {{square}}, 0);
    lines.has_z = true;
    double const z[3][2] = {{90, 50}, {80, 10}, {50, 20}};
    for (std::size_t l = 0; l < 3; ++l) {
        lines.lines[l].vertices[0].z = z[l][0];
        lines.lines[l].vertices[1].z = z[l][1];
    }
    ImportedNetwork const imported = import_lines(lines, on_cells);
    EXPECT_EQ(imported.network.outlets().size(), 2U);
    auto const below =
        std::ranges::find_if(imported.repairs, [](Finding const& f) { return f.kind == FindingKind("below_lake"); });
    ASSERT_NE(below, imported.repairs.end());
    EXPECT_EQ(below->feature, 2);
    EXPECT_NEAR(below->amount, 40.0, 1e-9);
}

TEST(ImportLakes, RiversOfIslandsAndLinesAfloatReachTheWater) {
    Line const island{{80, 80}, {120, 80}, {120, 120}, {80, 120}};
    RiverLines const lines = with_lakes({{{100, 500}, {100, 200}},
                                         {{100, 0}, {100, -300}},
                                         {{100, 100}, {80, 100}}, // to the island's shore
                                         {{160, 20}, {160, 40}}}, // all of it in the lake
                                        {{square, island}});
    ImportedNetwork const imported = import_lines(lines, on_cells);
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.network.node(imported.network.outlets()[0]).at, (Vec2{100, -300}));
}

TEST(ImportLakes, ALakeMayLieBeyondTheGrid) {
    Line const large{{0, 0}, {200, 0}, {2000, 200}, {0, 200}};
    RiverLines const lines = with_lakes({{{20, 500}, {20, 200}}, {{20, 0}, {20, -300}}}, {{large}});
    Grid const grid = frame_of(-10.0, 520.0, 12, 90);
    ImportedNetwork const imported = import_lines(lines, {.cell_m = 10.0, .frame = &grid});
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    for (Arc const& arc : imported.network.arcs()) {
        for (Vec2 const p : arc.line) {
            EXPECT_LE(p.x, 110.0 - 20.0);
        }
    }
}

TEST(ImportLakes, HeightsAreThoseOfTheOutflow) {
    RiverLines lines =
        with_lakes({{{100, 500}, {100, 200}}, {{0, 100}, {-300, 100}}, {{100, 0}, {100, -300}}}, {{square}});
    lines.lines.erase(lines.lines.begin() + 1);
    lines.has_z = true;
    for (Vec3& v : lines.lines[0].vertices) {
        v.z = v.y > 300.0 ? 90.0 : 50.0;
    }
    for (Vec3& v : lines.lines[1].vertices) {
        v.z = v.y > -100.0 ? 48.0 : 20.0;
    }
    ImportedNetwork const imported = import_lines(lines, on_cells);
    ASSERT_EQ(imported.arc_z.size(), 1U);
    for (double const z : imported.arc_z[0]) {
        EXPECT_TRUE(z == 90.0 || z == 50.0 || z == 48.0 || z == 20.0) << z;
    }
    EXPECT_TRUE(std::ranges::is_sorted(imported.arc_z[0], std::greater()));
}

// Lakes of any shape around a middle, with islands; one outflow.
RC_GTEST_PROP(ImportLakes, AllInflowsReachTheOutflow, ()) {
    auto const corners = *rc::gen::inRange(5, 40);
    std::vector<int> const far =
        *rc::gen::container<std::vector<int>>(static_cast<std::size_t>(corners), rc::gen::inRange(150, 400));
    auto const islands = *rc::gen::inRange(0, 4);
    auto const at = [](double turn, double m) {
        double const angle = 2.0 * std::numbers::pi * turn;
        return Vec2{m * std::cos(angle), m * std::sin(angle)};
    };
    Line shore;
    for (int i = 0; i < corners; ++i) {
        shore.push_back(rounded(at(static_cast<double>(i) / corners, far[static_cast<std::size_t>(i)])));
    }
    std::vector<Line> lake{shore};
    for (int i = 0; i < islands; ++i) {
        Vec2 const middle = at(0.1 + static_cast<double>(i) / 4.0, 60.0);
        lake.push_back({middle + Vec2{-15, -15}, middle + Vec2{15, -12}, middle + Vec2{2, 20}});
    }
    auto const mouths = *rc::gen::inRange(2, std::min(corners, 8));
    std::vector<Line> lines;
    for (int m = 0; m < mouths; ++m) {
        auto const i = static_cast<std::size_t>(m * corners / mouths);
        Vec2 const outside = rounded((1000.0 / norm(shore[i])) * shore[i]);
        lines.push_back(m == 0 ? Line{shore[i], outside} : Line{outside, shore[i]});
    }
    RiverLines const rivers = with_lakes(lines, {lake});
    ImportedNetwork const imported = import_lines(rivers, on_cells);
    RC_ASSERT(imported.network.outlets().size() == 1U);
    RC_ASSERT(imported.network.node(imported.network.outlets()[0]).at == lines[0].back());
    for (Arc const& arc : imported.network.arcs()) {
        for (Vec2 const p : arc.line) {
            for (std::size_t r = 1; r < lake.size(); ++r) {
                RC_ASSERT(!geometry::contains(lake[r], p));
            }
        }
    }
    RC_ASSERT(crossed(imported).size() == 1U);
    RC_ASSERT(std::fabs(crossed(imported)[0].amount - added_m(imported)) < 1e-3);
}

} // namespace import_lakes_test
