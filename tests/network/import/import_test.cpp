// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/import_lines.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>
#include <network/rivers.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/core/vec.hpp>

namespace import_test {

using namespace thalweg;
using network::Divergences;
using network::import_lines;
using network::ImportedNetwork;
using network::ImportParams;
using network::Orientation;

namespace {

using test::count;
using test::flats;
using test::has;
using test::refused;
using test::step;
using test::Step;
using test::steps_of;

constexpr ImportParams strictly{.divergences = Divergences::error};
constexpr double no_z = std::numeric_limits<double>::quiet_NaN();

RiverLines with_heights(std::vector<std::vector<Vec3>> const& all) {
    RiverLines lines = test::lines_of(all);
    lines.has_z = true;
    return lines;
}

Finding first(ImportedNetwork const& imported, std::string const& kind) {
    auto const found = std::ranges::find(imported.repairs, kind, &Finding::kind);
    return found == imported.repairs.end() ? Finding{"removed"} : *found;
}

// Law: trees; lines end bit for bit in their nodes; nothing repeats.
void expect_trees(StreamNetwork const& net) {
    EXPECT_EQ(net.node_count(), net.arc_count() + net.outlets().size());
    EXPECT_EQ(net.upstream_order().size(), net.node_count());
    for (NodeId n = 0; n < net.node_count(); ++n) {
        EXPECT_LE(net.out_arcs(n).size(), 1U);
        EXPECT_GT(net.basin(n), 0);
    }
    std::size_t segments = 0;
    for (std::size_t i = 0; i < net.arc_count(); ++i) {
        auto const& line = net.arc(i).line;
        segments += line.size() - 1;
        EXPECT_EQ(line.front(), net.node(net.from(i)).at);
        EXPECT_EQ(line.back(), net.node(net.to(i)).at);
        EXPECT_GT(net.length_m(i), 0.0);
        EXPECT_EQ(std::adjacent_find(line.begin(), line.end()), line.end());
    }
    EXPECT_EQ(steps_of(net).size(), segments);
}

// Law: from every vertex of a line the network leads to the next one, over added vertices on the segment only.
void expect_kept(StreamNetwork const& net, std::vector<RiverLine> const& lines) {
    std::map<std::pair<double, double>, std::vector<std::pair<double, double>>> beside;
    for (auto const& [a, b] : steps_of(net)) {
        beside[a].push_back(b);
        beside[b].push_back(a);
    }
    for (auto const& line : lines) {
        for (std::size_t i = 0; i + 1 < line.vertices.size(); ++i) {
            Vec2 const a{line.vertices[i].x, line.vertices[i].y};
            Vec2 const b{line.vertices[i + 1].x, line.vertices[i + 1].y};
            double const length = distance(a, b);
            std::pair<double, double> here{a.x, a.y};
            double along = 0.0;
            while (here != std::pair{b.x, b.y}) {
                auto const next = std::ranges::find_if(beside[here], [&](auto const& p) {
                    double const t = ((p.first - a.x) * (b.x - a.x) + (p.second - a.y) * (b.y - a.y)) / length;
                    double const off = ((p.first - a.x) * (b.y - a.y) - (p.second - a.y) * (b.x - a.x)) / length;
                    return std::fabs(off) <= 1e-6 && t > along && t <= length + 1e-6;
                });
                ASSERT_NE(next, beside[here].end())
                    << "river " << line.feature << " is lost after (" << here.first << ", " << here.second << ")";
                here = *next;
                along = ((here.first - a.x) * (b.x - a.x) + (here.second - a.y) * (b.y - a.y)) / length;
            }
        }
    }
}

} // namespace

TEST(AdoptRefuses, LinesThatMakeNoForest) {
    struct Case {
        std::string words;
        RiverLines lines;
        ImportParams params = {};
    };
    RiverLines const one = flats({{{0, 0}, {1, 0}}});
    RiverLines const fork = flats({{{0, 0}, {0, -5}}, {{0, -5}, {-4, -9}}, {{0, -5}, {3, -9}}});
    RiverLines ranked = flats({{{0, 0}, {1, 0}}, {{1, 0}, {2, 0}}, {{2, 0}, {3, 0}}});
    ranked.lines[0].rank = 1;
    ranked.lines[1].rank = 5;
    ranked.lines[2].rank = 2;
    for (auto const& [words, lines, params] : std::vector<Case>{
             {"no lines", flats({})},
             {"river 2 in rivers.gpkg has no length", flats({{{0, 0}, {1, 0}}, {}})},
             {"river 1 in rivers.gpkg has no length at (4.0", flats({{{4, 5}}})},
             {"river 2 in rivers.gpkg has no length at (7.0", flats({{{0, 0}, {1, 0}}, {{7, 7}, {7, 7}, {7, 7}}})},
             {"vertex 2 of river 1 in rivers.gpkg", flats({{{0, 0}, {1, no_z}, {2, 0}}})},
             {"vertex 1 of river 1", flats({{{INFINITY, 0}, {1, 0}}})},
             {"vertex 2 of river 1", with_heights({{{0, 0, 1}, {1, 0, no_z}}})},
             {"is shorter", flats({{{0, -15}, {0, 15}}, {{-17, 0}, {17, 0}}}), {.snap_m = 20.0}},
             {"rivers 1, 2 and 3 in rivers.gpkg form a cycle through (2.000000, 3.000000)",
              flats({{{0, 0}, {4, 0}}, {{4, 0}, {2, 3}}, {{2, 3}, {0, 0}}, {{9, 9}, {4, 0}}}), strictly},
             {"rivers 1 and 2", flats({{{0, 0}, {2, 1}, {4, 0}}, {{0, 0}, {2, -1}, {4, 0}}}), strictly},
             {"river 1 in rivers.gpkg forms a cycle", flats({{{0, 0}, {2, 1}, {4, 0}, {0, 0}}}), strictly},
             {"cycle through (2.000000, 0.000000)", flats({{{0, 0}, {4, 0}, {2, 2}, {2, -2}}}), strictly},
             {"rivers 1 and 2", flats({{{0, 0}, {9, 0}}, {{1, 1}, {2, -1}, {3, 1}}}), strictly},
             {"rivers 3 and 2 in rivers.gpkg both run away from (0.000000, -5.000000) by height",
              with_heights({{{0, 0, 9}, {0, -5, 5}}, {{0, -5, 5}, {-4, -9, 1}}, {{0, -5, 5}, {3, -9, 2}}}), strictly},
             {"both run away from (0.000000, -5.000000) by the drawn direction",
              fork,
              {.orientation = Orientation::as_drawn, .divergences = Divergences::error}},
             {"by rank", ranked, strictly},
             {"no heights", one, {.orientation = Orientation::height}},
             {"no rank", one, {.orientation = Orientation::rank}}}) {
        auto const act = [&] { import_lines(lines, params); };
        EXPECT_TRUE(refused("network.import_lines", act, words));
    }
    for (double const snap_m : {-1.0, no_z}) {
        auto const act = [&] { import_lines(one, {.snap_m = snap_m}); };
        EXPECT_TRUE(refused<BadParameter>("network.import_lines", act));
    }
}

TEST(Import, StopsWhenAsked) {
    EXPECT_THROW(import_lines(flats({{{0, 0}, {1, 0}}}), {}, test::stopped_run()), Cancelled);
}

TEST(Import, RepeatedVerticesAreDropped) {
    auto const imported = import_lines(flats({{{0, 0}, {0, 0}, {1, 0}, {1, 0}, {1, 0}, {2, 1}}}));
    EXPECT_EQ(imported.network.arcs()[0].line, (std::vector<Vec2>{{0, 0}, {1, 0}, {2, 1}}));
    ASSERT_EQ(imported.repairs.size(), 1U);
    EXPECT_EQ(imported.repairs[0].kind, "removed");
    EXPECT_EQ(imported.repairs[0].amount, 3.0);
}

TEST(Import, StepsBackAreRemoved) {
    // 3 cm backwards in a river of 20 km, as digitisers leave them.
    RiverLines const lines = with_heights({{{0, 0, 40}, {9000.03, 0, 30}, {9000, 0.001, 29}, {20000, 0, 20}}});
    ImportedNetwork const imported = import_lines(lines);
    ASSERT_EQ(imported.network.arc_count(), 1U);
    EXPECT_EQ(imported.network.arc(0).line, (std::vector<Vec2>{{0, 0}, {9000, 0.001}, {20000, 0}}));
    EXPECT_EQ(imported.arc_z, (std::vector<std::vector<double>>{{40, 29, 20}}));
    EXPECT_NEAR(first(imported, "cut").amount, 0.03, 1e-3);
    EXPECT_NEAR(imported.stretches[0][0].to_m, 20000.0, 1e-3);
    // The step is what is left out, whether the river goes back before it turns or after.
    ImportedNetwork const before_turn =
        import_lines(with_heights({{{0, 0, 9}, {9000, 0, 8}, {9000, -0.03, 7}, {9000.005, 11000, 6}}}));
    ASSERT_EQ(before_turn.network.arc_count(), 1U);
    EXPECT_EQ(before_turn.network.arc(0).line, (std::vector<Vec2>{{0, 0}, {9000, 0}, {9000.005, 11000}}));
    for (ImportedNetwork const* const one : {&imported, &before_turn}) {
        ASSERT_EQ(one->secondary.size(), 1U);
        EXPECT_EQ(one->secondary[0].cause, LeftOut::too_short);
        EXPECT_NEAR(length_in_plan(one->secondary[0].vertices), 0.03, 2e-3);
    }
    // A bend is not a step back, however sharp; the tip where another river joins stays.
    EXPECT_EQ(count(import_lines(with_heights({{{0, 0, 9}, {500, 0, 8}, {0, 20, 7}}})).repairs, "cut"), 0U);
    ImportedNetwork const confluence =
        import_lines(test::lines_of({{{0, 0, no_z}, {9000.03, 0, no_z}, {9000, 0.001, no_z}, {20000, 0, no_z}},
                                     {{9000, -5000, no_z}, {9000.03, 0, no_z}}}));
    EXPECT_EQ(count(confluence.repairs, "cut"), 1U);
    ASSERT_EQ(confluence.network.arc_count(), 3U);
    EXPECT_EQ(confluence.network.arc(1).line, (std::vector<Vec2>{{9000.03, 0}, {20000, 0}}));
    // What goes back for more than a slip of the hand stays, and the check says so.
    EXPECT_EQ(
        count(import_lines(with_heights({{{0, 0, 9}, {9000, 0, 8}, {8000, 0.001, 7}, {20000, 0, 6}}})).repairs, "cut"),
        0U);
}

TEST(AdoptSnaps, EndsThatAreApart) {
    auto const imported = import_lines(flats({{{0, 0}, {10, 0}}, {{10.25, 0}, {20, 0}}}), {.snap_m = 0.5});
    auto const arcs = imported.network.arcs();
    ASSERT_EQ(arcs.size(), 1U);
    EXPECT_EQ(arcs[0].line, (std::vector<Vec2>{{0, 0}, {10, 0}, {20, 0}}));
    EXPECT_EQ(arcs[0].feature, 1);
    EXPECT_EQ(first(imported, "snapped").feature, 2);
    EXPECT_EQ(first(imported, "snapped").amount, 0.25);
    EXPECT_EQ(first(imported, "joined").feature, 1);
    EXPECT_EQ(import_lines(flats({{{0, 0}, {10, 0}}, {{10.25, 0}, {20, 0}}}), {.snap_m = 0.24}).network.arc_count(),
              2U);
}

TEST(AdoptSnaps, EndsBesideALine) {
    std::vector<Vec2> const line{{0, 0}, {10, 0}};
    for (auto const& [what, lines, amount] : std::vector<std::tuple<std::string, RiverLines, double>>{
             {"short of it", flats({line, {{5, 9}, {5, 0.25}}}), 0.25},
             {"beyond it", flats({line, {{5, 9}, {5, -0.25}}}), 0.25},
             {"near its vertex", flats({{{0, 0}, {5, 0}, {10, 0}}, {{5, 9}, {5.2, 0.1}}}), std::sqrt(0.05)}}) {
        SCOPED_TRACE(what);
        auto const imported = import_lines(lines, {.snap_m = 0.5});
        EXPECT_EQ(imported.network.arc_count(), 3U);
        EXPECT_EQ(first(imported, "snapped").where, (Vec2{5, 0}));
        EXPECT_NEAR(first(imported, "snapped").amount, amount, 1e-12);
        EXPECT_EQ(first(imported, "split").feature, 1);
        expect_trees(imported.network);
    }
    EXPECT_EQ(import_lines(flats({line, {{5, 9}, {5, 0.25}}}), {.snap_m = 0.2}).network.outlets().size(), 2U);
}

TEST(AdoptSnaps, AnEndOnALineStaysWhereItIs) {
    // (1, 1/3) lies beside the line from (0, 0) to (3, 1) by less than a unit in the last place.
    auto const lines = flats({{{0, 0}, {3, 1}}, {{1, 5}, {1, 1.0 / 3.0}}});
    auto const imported = import_lines(lines);
    EXPECT_EQ(imported.network.arc_count(), 3U);
    EXPECT_EQ(count(imported.repairs, "snapped"), 0);
    expect_kept(imported.network, lines.lines);
}

TEST(AdoptSnaps, ALineShorterThanTheDistanceIsRemoved) {
    auto const imported =
        import_lines(flats({{{0, 0}, {10, 0}}, {{10, 0}, {10, 0.1}}, {{10, 0.1}, {20, 0}}}), {.snap_m = 0.5});
    EXPECT_EQ(imported.network.arc_count(), 1U);
    EXPECT_EQ(first(imported, "removed").feature, 2);
}

TEST(AdoptSplits, WhereLinesMeet) {
    struct Case {
        std::string what;
        std::vector<std::vector<Vec2>> lines;
        std::size_t arcs;
        Vec2 where;
    };
    for (auto const& [what, drawn, arcs, where] : std::vector<Case>{
             {"a crossing", {{{0, 1}, {3, 1}}, {{1, 0}, {2, 3}}}, 4, {4.0 / 3.0, 1}},
             {"a vertex that is touched", {{{0, 0}, {5, 0}, {10, 0}}, {{5, 7}, {5, 0}}}, 3, {5, 0}},
             {"three lines", {{{0, 0}, {1, 1}}, {{0, 1}, {0.5, 0}}, {{1, 0}, {0, 0.5}}}, 6, {1.0 / 3.0, 1.0 / 3.0}},
             {"three that form a triangle of 1e-9 m",
              {{{-10, 0}, {10, 0}}, {{0, -10}, {0, 10}}, {{-10, -10 + 1e-9}, {10, 10 + 1e-9}}},
              6,
              {0, 0}}}) {
        SCOPED_TRACE(what);
        RiverLines const lines = flats(drawn);
        auto const imported = import_lines(lines);
        EXPECT_EQ(imported.network.arc_count(), arcs);
        EXPECT_EQ(count(imported.repairs, "split"), static_cast<std::int64_t>(arcs / 2));
        EXPECT_LT(distance(first(imported, "split").where, where), 1e-6);
        expect_trees(imported.network);
        expect_kept(imported.network, lines.lines);
    }
}

TEST(AdoptDropsDuplicates, IdenticalReversedAndNear) {
    auto const imported =
        import_lines(flats({{{0, 0}, {5, 1}, {9, 0}}, {{0, 0}, {5, 1}, {9, 0}}, {{9, 0}, {5, 1}, {0, 0}}}));
    EXPECT_EQ(imported.network.arc_count(), 1U);
    EXPECT_EQ(count(imported.repairs, "duplicate"), 2);
    auto const near = import_lines(flats({{{0, 0}, {5, 1}, {9, 0}}, {{9, 0.1}, {5, 1.1}, {0, 0}}}), {.snap_m = 0.5});
    EXPECT_EQ(near.network.arc_count(), 1U);
    EXPECT_EQ(first(near, "duplicate").feature, 2);
    RiverLines const beside = flats({{{0, 0}, {5, 0}, {9, 0}}, {{0, 0.5}, {5, 0.5}, {9, 0.5}}});
    EXPECT_EQ(count(import_lines(beside, {.snap_m = 0.5}).repairs, "duplicate"), 1);
    EXPECT_EQ(count(import_lines(beside, {.snap_m = 0.49}).repairs, "duplicate"), 0);
}

TEST(AdoptDropsDuplicates, APartThatOverlaps) {
    auto const lines = flats({{{0, 0}, {4, 0}, {8, 0}}, {{2, 0}, {4, 0}, {6, 0}, {6, 5}}});
    auto const imported = import_lines(lines);
    EXPECT_EQ(first(imported, "duplicate").feature, 2);
    EXPECT_EQ(first(imported, "duplicate").amount, 4.0);
    EXPECT_EQ(imported.network.arc_count(), 3U);
    expect_trees(imported.network);
    expect_kept(imported.network, lines.lines);
}

TEST(AdoptCuts, EndsThatPassARiverByCentimetres) {
    // Over the last 5 cm of the third river the first one crosses it, and ends 3 cm beyond.
    auto const file = flats({{{0, 20000}, {100, 15000}, {0.05, 9999.97}},
                             {{0, 10000}, {-100, 5000}, {0, 0}},
                             {{10000, 18000}, {0, 10000}}});
    ImportedNetwork const imported = import_lines(file);
    EXPECT_EQ(imported.network.arc_count(), 3U);
    EXPECT_EQ(count(imported.repairs, "cut"), 1);
    EXPECT_NEAR(first(imported, "cut").amount, 0.07, 0.005);
    ASSERT_EQ(imported.secondary.size(), 1U);
    EXPECT_EQ(imported.secondary[0].cause, LeftOut::too_short);

    auto const longer = flats({{{0, 20000}, {100, 15000}, {5, 9995}}, // 6 m are no slip of the hand
                               {{0, 10000}, {-100, 5000}, {0, 0}},
                               {{10000, 18000}, {0, 10000}}});
    EXPECT_EQ(import_lines(longer).network.arc_count(), 4U);
}

TEST(AdoptOrients, ByRankWhateverWasDrawn) {
    auto lines = flats({{{0, 0}, {5, 0}}, {{9, 0}, {5, 0}}, {{5, 0}, {5, 9}}});
    lines.lines[0].rank = 10;
    lines.lines[1].rank = 30;
    lines.lines[2].rank = 20;
    auto const imported = import_lines(lines);
    EXPECT_EQ(imported.network.node(imported.network.outlets().at(0)).at, (Vec2{0, 0}));
    EXPECT_EQ(count(imported.repairs, "reversed"), 2);
}

TEST(AdoptOrients, TheOneReachDrawnTheWrongWay) {
    auto const lines = flats({{{0, 90}, {0, 60}}, {{0, 40}, {0, 60}}, {{0, 40}, {0, 0}}, {{50, 60}, {0, 40}}});
    auto const imported = import_lines(lines);
    EXPECT_EQ(imported.network.node(imported.network.outlets().at(0)).at, (Vec2{0, 0}));
    EXPECT_EQ(count(imported.repairs, "reversed"), 1);
    EXPECT_EQ(first(imported, "reversed").feature, 2);
    EXPECT_EQ(first(imported, "reversed").amount, 20.0);
}

TEST(AdoptOrients, ByTopologyToTheEndNearestTheBorder) {
    // A second basin sets the box; of the first one only (50, 1) is beside its border.
    auto const lines = flats(
        {{{50, 1}, {50, 30}}, {{50, 30}, {40, 50}}, {{50, 30}, {60, 50}}, {{0, 0}, {0, 100}}, {{100, 0}, {100, 100}}});
    auto const imported = import_lines(lines, {.orientation = Orientation::topology});
    ASSERT_EQ(imported.network.outlets().size(), 3U);
    EXPECT_TRUE(std::ranges::any_of(imported.network.outlets(), [&](NodeId n) {
        return imported.network.node(n).at == Vec2{50, 1};
    }));
    expect_trees(imported.network);
}

TEST(AdoptJoins, UnlessTheTypeChanges) {
    auto lines = flats({{{0, 0}, {10, 0}}, {{10, 0}, {30, 0}}, {{30, 0}, {40, 0}}});
    lines.lines[0].type = "A";
    lines.lines[1].type = "A";
    lines.lines[2].type = "C";
    auto const arcs = import_lines(lines).network.arcs();
    ASSERT_EQ(arcs.size(), 2U);
    EXPECT_EQ(arcs[0].type, "A");
    EXPECT_EQ(arcs[0].feature, 2);
    EXPECT_EQ(arcs[0].line.size(), 3U);
    EXPECT_EQ(arcs[1].type, "C");
}

TEST(AdoptHeights, CrossingTakesTheLowerInterpolation) {
    auto const lines = with_heights({{{0, 0, 8}, {10, 0, 4}}, {{5, 10, 9}, {5, 0, 5}}});
    auto const imported = import_lines(lines);
    auto const raised = network::take_file_heights(imported, lines);
    EXPECT_EQ(first(imported, "height").amount, 1.0);
    EXPECT_EQ(raised.arc_z, (std::vector<std::vector<double>>{{8, 5}, {5, 4}, {9, 5}}));
    for (std::size_t i = 0; i < raised.planform.arc_count(); ++i) {
        EXPECT_EQ(raised.arc_z[i].front(), raised.node_z[raised.planform.from(i)]);
        EXPECT_EQ(raised.arc_z[i].back(), raised.node_z[raised.planform.to(i)]);
    }
}

TEST(AdoptHeights, NodeIsNotBelowTheNextVertexDownstream) {
    auto const lines = with_heights({{{0, 0, 8}, {5, 0, 6}, {10, 0, 5}}, {{5, 10, 9}, {5, 0, 4.5}}});
    auto const raised = network::take_file_heights(import_lines(lines), lines);
    EXPECT_EQ(raised.arc_z, (std::vector<std::vector<double>>{{8, 5}, {5, 5}, {9, 5}}));
}

TEST(AdoptHeights, UphillNamesRiverAndVertices) {
    for (auto const& [words, lines] : std::vector<std::pair<std::string, RiverLines>>{
             {"no heights", flats({{{0, 0}, {1, 0}}})},
             {"river 3 in rivers.gpkg",
              with_heights({{{0, 0, 20}, {1, 0, 9}},
                            {{0, 5, 20}, {1, 5, 9}},
                            {{0, 9, 20}, {1, 9, 18}, {2, 9, 13}, {3, 9, 12.1}, {4, 9, 12.9}, {5, 9, 3}}})},
             {"river 1 in rivers.gpkg runs uphill between vertex 3",
              with_heights({{{5, 9, 3}, {4, 9, 12.9}, {3, 9, 12.1}, {2, 9, 13}}})},
             {"(9.000000001 m)", with_heights({{{0, 0, 20}, {1, 0, 9}, {2, 0, 9.000000001}, {3, 0, 1}}})}}) {
        auto const act = [&] { network::take_file_heights(import_lines(lines), lines); };
        EXPECT_TRUE(refused("network.take_file_heights", act, words));
    }
}

TEST(AdoptHeights, LevelIsNotUphill) {
    auto const level = with_heights({{{0, 0, 5}, {1, 0, 5}, {2, 0, 4}, {3, 0, 4}}});
    EXPECT_EQ(network::take_file_heights(import_lines(level), level).arc_z[0], (std::vector<double>{5, 5, 4, 4}));
}

namespace {

struct Tree : test::Lattice {
    std::vector<int> down; // vertex 0 is the outlet
    std::vector<double> z;
};

Tree random_tree(int size) {
    Tree tree{test::random_lattice(size, 0, test::First::head), {-1}, {0.0}};
    for (auto const& [from, to] : tree.edges) {
        tree.down.push_back(static_cast<int>(from));
        tree.z.push_back(tree.z[from] + 1.0);
    }
    return tree;
}

// Draws the tree as lines down from its heads, each until it meets one drawn before, cut in places.
RiverLines draw(Tree const& tree) {
    RiverLines file;
    file.name = "tree";
    file.has_z = true;
    std::vector<char> drawn(tree.at.size(), 0);
    std::vector<char> has_up(tree.at.size(), 0);
    for (int const d : tree.down) {
        if (d >= 0) {
            has_up[static_cast<std::size_t>(d)] = 1;
        }
    }
    auto const vertex = [&](std::size_t v) { return Vec3{tree.at[v].x, tree.at[v].y, tree.z[v]}; };
    for (std::size_t head = 0; head < tree.at.size(); ++head) {
        if (has_up[head] != 0 || tree.down[head] < 0) {
            continue;
        }
        RiverLine line;
        line.vertices = {vertex(head)};
        for (std::size_t v = head; tree.down[v] >= 0 && drawn[v] == 0; v = static_cast<std::size_t>(tree.down[v])) {
            drawn[v] = 1;
            auto const next = static_cast<std::size_t>(tree.down[v]);
            line.vertices.push_back(vertex(next));
            bool const ends = tree.down[next] < 0 || drawn[next] != 0;
            if (ends || *rc::gen::inRange(0, 4) == 0) {
                line.feature = static_cast<std::int64_t>(file.lines.size()) + 1;
                file.lines.push_back(line);
                line.vertices = {vertex(next)};
            }
        }
    }
    return file;
}

void spoil(RiverLines& file) {
    std::size_t const count = file.lines.size();
    for (std::size_t l = 0; l < count; ++l) {
        int const what = *rc::gen::inRange(0, 4);
        if (what == 1 || what == 3) {
            std::ranges::reverse(file.lines[l].vertices);
        }
        if (what >= 2) {
            file.lines.push_back(file.lines[l]);
            file.lines.back().feature = static_cast<std::int64_t>(file.lines.size());
            if (*rc::gen::inRange(0, 2) == 0) {
                std::ranges::reverse(file.lines.back().vertices);
            }
        }
    }
}

} // namespace

// Law: a tree of lines cut into pieces, turned round and repeated is found again, every vertex bit for bit.
TEST(AdoptLaws, TheTreeIsFound) {
    ASSERT_TRUE(rc::check([] {
        auto const tree = random_tree(*rc::gen::inRange(2, 60));
        auto file = draw(tree);
        auto const lines = file.lines;
        spoil(file);
        auto const imported = import_lines(file);
        RC_ASSERT(steps_of(imported.network) == steps_of(tree));
        RC_ASSERT(imported.network.node_count() == imported.network.arc_count() + 1);
        for (NodeId n = 0; n < imported.network.node_count(); ++n) {
            RC_ASSERT(kind_of(imported.network, n) != NodeKind::pseudo);
        }
        auto const raised = network::take_file_heights(imported, file);
        std::map<std::pair<double, double>, double> z;
        for (std::size_t v = 0; v < tree.at.size(); ++v) {
            z[{tree.at[v].x, tree.at[v].y}] = tree.z[v];
        }
        for (std::size_t i = 0; i < raised.planform.arc_count(); ++i) {
            auto const& line = raised.planform.arc(i).line;
            for (std::size_t v = 0; v < line.size(); ++v) {
                RC_ASSERT(raised.arc_z[i][v] == z.at({line[v].x, line[v].y}));
            }
        }
    }));
}

// Law: without heights or rank the drawn direction gives the same network.
TEST(AdoptLaws, AsDrawn) {
    ASSERT_TRUE(rc::check([] {
        auto const tree = random_tree(*rc::gen::inRange(2, 60));
        auto file = draw(tree);
        file.has_z = false;
        RC_ASSERT(steps_of(import_lines(file, {.orientation = Orientation::as_drawn}).network) == steps_of(tree));
        RC_ASSERT(steps_of(import_lines(file).network) == steps_of(tree));
    }));
}

TEST(Import, OfOpenEndsNothingThatMeetsIsMoved) {
    // A short sound reach between two confluences, and a river that misses another by 3 m.
    auto const lines = flats({{{0, 500}, {0, 215}},
                              {{-300, 500}, {0, 215}},
                              {{0, 215}, {0, 200}},
                              {{300, 500}, {0, 200}},
                              {{0, 200}, {0, 0}},
                              {{-300, 250}, {-3, 100}}});
    auto const imported = import_lines(lines, {.snap_m = 20.0, .join = false, .snapped = network::SnappedEnds::open});
    EXPECT_EQ(count(imported.repairs, "snapped"), 1);
    EXPECT_EQ(first(imported, "snapped").feature, 6);
    EXPECT_EQ(first(imported, "snapped").amount, 3.0);
    EXPECT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_EQ(imported.network.arc_count(), 7U); // the last river divides the one it meets
    EXPECT_TRUE(imported.secondary.empty());
    // A head that lies near the river which its own mouth meets stays.
    auto const brook = flats({{{0, 200}, {0, 100}}, {{0, 100}, {0, 0}}, {{14, 105}, {0, 100}}});
    auto const kept = import_lines(brook, {.snap_m = 20.0, .snapped = network::SnappedEnds::open});
    EXPECT_EQ(kept.network.arc_count(), 3U);
    EXPECT_EQ(count(kept.repairs, "snapped"), 0);
    EXPECT_EQ(import_lines(brook, {.snap_m = 20.0}).network.arc_count(), 1U); // all ends: it collapses
    // A line on its own comes to the river with one end only.
    auto const piece = flats({{{0, 200}, {0, 0}}, {{5, 110}, {5, 100}}});
    auto const joined = import_lines(piece, {.snap_m = 20.0, .snapped = network::SnappedEnds::open});
    EXPECT_EQ(count(joined.repairs, "snapped"), 1);
    EXPECT_TRUE(joined.secondary.empty());
    // Rivers side by side are no copies.
    auto const beside = flats({{{0, 200}, {0, 0}}, {{6, 200}, {6, 0}}});
    EXPECT_EQ(count(import_lines(beside, {.snap_m = 20.0, .snapped = network::SnappedEnds::open}).repairs, "duplicate"),
              0);
}

// Law: ends moved by less than half of snap_m are found together again; no vertex moves further than snap_m.
TEST(AdoptLaws, MovedEndsAreSnapped) {
    ASSERT_TRUE(rc::check([] {
        double const snap_m = 4.0;
        auto const tree = random_tree(*rc::gen::inRange(2, 60));
        auto file = draw(tree);
        spoil(file);
        for (auto& line : file.lines) {
            for (auto* const end : {&line.vertices.front(), &line.vertices.back()}) {
                end->x += *rc::gen::inRange(-1400, 1401) * 1e-3;
                end->y += *rc::gen::inRange(-1400, 1401) * 1e-3;
            }
        }
        auto const imported = import_lines(file, {.snap_m = snap_m});
        auto const cell = [](double x, double y) { // of the lattice: vertices are within 26 m of its points
            return std::pair{std::floor(x / 100.0 + 0.5), std::floor(y / 100.0 + 0.5)};
        };
        auto const coarse = [&](std::set<Step> const& fine) {
            std::set<Step> result;
            for (auto const& [a, b] : fine) {
                result.insert({cell(a.first, a.second), cell(b.first, b.second)});
            }
            return result;
        };
        RC_ASSERT(coarse(steps_of(imported.network)) == coarse(steps_of(tree)));
        RC_ASSERT(steps_of(imported.network).size() == steps_of(tree).size());
        for (auto const& repair : imported.repairs) {
            RC_ASSERT((repair.kind != "snapped" || repair.amount <= snap_m));
        }
    }));
}

// Law: rivers that cross once each keep all their vertices and gain exactly one each crossing.
TEST(AdoptLaws, CrossingsAreAllThatIsAdded) {
    ASSERT_TRUE(rc::check([] {
        int const rivers = *rc::gen::inRange(1, 12);
        auto const some = [](int low, int high) { return *rc::gen::inRange(low, high + 1) * 1e-6; };
        std::vector<std::vector<Vec2>> plans(1);
        for (int i = 0; i <= rivers; ++i) {
            double const x = 100.0 * i;
            plans[0].push_back({x, some(-8000000, 8000000)});
            if (i < rivers) {
                plans.push_back({{x + some(10000000, 90000000), 500}, {x + some(10000000, 90000000), -500}});
            }
        }
        auto const file = flats(plans);
        auto const imported = import_lines(file);
        expect_trees(imported.network);
        expect_kept(imported.network, file.lines);
        RC_ASSERT(!::testing::Test::HasFailure());
        RC_ASSERT(imported.network.arc_count() == static_cast<std::size_t>(3 * rivers + 1));
        RC_ASSERT(steps_of(imported.network).size() == static_cast<std::size_t>(rivers + 3 * rivers));
    }));
}

} // namespace import_test
