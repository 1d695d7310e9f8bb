// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/import_lines.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <network/rivers.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/network/import/internal/import_reaches.hpp>

namespace import_directions_test {

using namespace thalweg;
using network::import_lines;
using network::ImportedNetwork;
using network::Orientation;
using test::First;
using test::flats;
using test::Lattice;
using test::random_lattice;
using test::steps_of;

namespace {

namespace steps = network::import_steps;

RiverLines drawn(Lattice const& lattice) {
    std::vector<std::vector<Vec2>> lines;
    for (auto const& [from, to] : lattice.edges) {
        lines.push_back({lattice.at[from], lattice.at[to]});
    }
    return flats(lines);
}

/// Turns lines and changes their order.
void disturb(RiverLines& file) {
    for (std::size_t l = file.lines.size(); l-- > 1;) {
        std::swap(file.lines[l], file.lines[static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(l) + 1))]);
    }
    for (RiverLine& line : file.lines) {
        if (*rc::gen::inRange(0, 2) == 1) {
            std::ranges::reverse(line.vertices);
        }
    }
}

struct Scored {
    double shape;
    double climb;
};

struct Graph {
    steps::Pieces pieces;
    steps::ReachGraph reaches;
    std::vector<std::vector<steps::Root>> roots; ///< by group
};

Graph graph_of(RiverLines const& file, Raster<float> const* dem) {
    std::vector<Finding> repairs;
    std::vector<SecondaryLine> secondary;
    steps::Left left{repairs, secondary};
    Graph graph;
    graph.pieces = steps::cut(file.lines, left);
    graph.reaches = steps::reaches_of(graph.pieces, file.lines, {}, dem);
    steps::RootScores scores(graph.pieces, file.lines, graph.reaches, {}, dem);
    for (steps::ReachGroup const& group : graph.reaches.groups) {
        graph.roots.push_back(scores.of(group));
    }
    return graph;
}

std::map<std::pair<double, double>, Scored> scores_of(Graph const& graph) {
    std::map<std::pair<double, double>, Scored> result;
    for (auto const& of_group : graph.roots) {
        for (steps::Root const& root : of_group) {
            Vec2 const at = graph.pieces.nodes[root.node];
            result[{at.x, at.y}] = {root.shape, root.climb};
        }
    }
    return result;
}

Raster<float> tilted(double west, double south, std::int64_t side) {
    Raster<float> dem(Grid{side, side, 10.0, west, south + 10.0 * static_cast<double>(side), ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        dem[i] = static_cast<float>((c.col * 7 + c.row * 3) % 90);
    }
    return dem;
}

/// The same, with every way and every sum computed for each root.
class Oracle {
public:
    Oracle(Graph const& graph, Raster<float> const& dem) : g_(graph), dem_(dem) {}

    Scored score(steps::ReachGroup const& group, std::size_t root) const {
        std::map<std::size_t, double> way{{root, 0.0}};
        std::map<std::size_t, std::size_t> down;
        for (std::size_t round = 0; round < group.nodes.size(); ++round) { // Bellman and Ford
            for (std::size_t const k : group.reaches) {
                steps::Reach const& r = g_.reaches.reaches[k];
                relax(way, down, r.from, r.to, k, r.length_m);
                relax(way, down, r.to, r.from, k, r.length_m);
            }
        }
        Scored scored{leaf_terms(group, root), 0.0};
        for (auto const& [n, k] : down) {
            scored.shape += angle(n, k);
        }
        for (std::size_t const k : group.reaches) {
            steps::Reach const& r = g_.reaches.reaches[k];
            bool const is_way = down.contains(r.from) && down.at(r.from) == k;
            bool const is_back = down.contains(r.to) && down.at(r.to) == k;
            bool const forth = is_way || (!is_back && way.at(r.from) > way.at(r.to));
            double const rise = low(forth ? r.to : r.from) - low(forth ? r.from : r.to);
            scored.climb -= std::clamp(rise, 0.0, 12.0) / 3.0;
        }
        return scored;
    }

private:
    static void relax(std::map<std::size_t, double>& way, std::map<std::size_t, std::size_t>& down, std::size_t below,
                      std::size_t n, std::size_t k, double length_m) {
        if (way.contains(below) && (!way.contains(n) || way.at(below) + length_m < way.at(n) - 1e-9)) {
            way[n] = way.at(below) + length_m;
            down[n] = k;
        }
    }
    Vec2 at(std::size_t n) const { return g_.pieces.nodes[n]; }
    double low(std::size_t n) const {
        Cell const c = dem_.grid().cell_of(at(n));
        double result = 1e9;
        for (int dr = -1; dr <= 1; ++dr) {
            for (int dc = -1; dc <= 1; ++dc) {
                result = std::min(result, static_cast<double>(dem_[Cell{c.col + dc, c.row + dr}]));
            }
        }
        return result;
    }
    Vec2 towards(std::size_t n, std::size_t k, double m) const {
        steps::Reach const& r = g_.reaches.reaches[k];
        std::vector<Vec2> line = r.line;
        if (r.from != n) {
            std::ranges::reverse(line);
        }
        Vec2 const u = steps::point_along(line, m) - line.front();
        return (1.0 / norm(u)) * u;
    }
    double angle(std::size_t n, std::size_t chosen) const {
        auto const& ways = g_.reaches.at[n];
        if (ways.size() < 3) {
            return 0.0;
        }
        double result = 0.0;
        for (auto const& [scale, weight] : {std::pair(0.1, 1.05), std::pair(1.0, 0.99)}) {
            double const m = std::max(scale * g_.reaches.median_m, 2.0 * g_.reaches.segment_m);
            double mean = 0.0;
            double own = 0.0;
            for (auto const& one : ways) {
                for (auto const& other : ways) {
                    if (one.reach != other.reach) {
                        double const against = -dot(towards(n, one.reach, m), towards(n, other.reach, m));
                        mean += against / static_cast<double>(ways.size());
                        own += one.reach == chosen ? against : 0.0;
                    }
                }
            }
            result += weight * (own - mean);
        }
        return result;
    }
    double to_box(std::vector<std::size_t> const& nodes, Vec2 p) const {
        double result = 1e9;
        for (int axis = 0; axis < 2; ++axis) {
            double low_side = 1e9;
            double high_side = -1e9;
            for (std::size_t const n : nodes) {
                low_side = std::min(low_side, axis == 0 ? at(n).x : at(n).y);
                high_side = std::max(high_side, axis == 0 ? at(n).x : at(n).y);
            }
            double const c = axis == 0 ? p.x : p.y;
            result = std::min({result, c - low_side, high_side - c});
        }
        return result;
    }
    double leaf_terms(steps::ReachGroup const& group, std::size_t n) const {
        std::vector<std::size_t> all(g_.pieces.nodes.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i] = i;
        }
        double const scale = g_.reaches.median_m;
        return 1.84 * std::exp(-to_box(all, at(n)) / scale) + 0.82 * std::exp(-to_box(group.nodes, at(n)) / scale);
    }

    Graph const& g_;
    Raster<float> const& dem_;
};

bool has_doubt(ImportedNetwork const& imported, char const* kind) {
    return test::count(imported.directions.doubts, kind) > 0;
}

/// A trunk from (0, 4000) to (0, 0) with tributaries at acute angles, drawn downstream.
std::vector<std::vector<Vec2>> comb() {
    return {{{0, 4000}, {0, 3000}},    {{0, 3000}, {0, 2000}},   {{0, 2000}, {0, 1000}},   {{0, 1000}, {0, 0}},
            {{-700, 3700}, {0, 3000}}, {{700, 2700}, {0, 2000}}, {{-700, 1700}, {0, 1000}}};
}

} // namespace

// The score of a root by re-rooting is that of its own ways and sums, of trees and with loops.
TEST(ImportDirections, RerootingScoresAsTheOracle) {
    ASSERT_TRUE(rc::check([] {
        Lattice const lattice = random_lattice(*rc::gen::inRange(2, 30), *rc::gen::inRange(0, 4));
        RC_PRE(!lattice.edges.empty());
        Raster<float> const dem = tilted(-3500.0, -3500.0, 700);
        Graph const graph = graph_of(drawn(lattice), &dem);
        Oracle const oracle(graph, dem);
        for (std::size_t g = 0; g < graph.roots.size(); ++g) {
            steps::ReachGroup const& group = graph.reaches.groups[g];
            for (steps::Root const& root : graph.roots[g]) {
                Scored const plain = oracle.score(group, root.node);
                double const free = root.shape - plain.shape; // open land ahead: there or not
                RC_ASSERT((std::fabs(free) < 1e-6 || std::fabs(free - 1.02) < 1e-6));
                RC_ASSERT(std::fabs(root.climb - plain.climb) < 1e-6);
            }
        }
    }));
}

// Law: what geometry and DEM say does not depend on how lines are drawn, nor on their order.
TEST(ImportDirections, ScoresDoNotDependOnTheDrawing) {
    ASSERT_TRUE(rc::check([] {
        Lattice const lattice = random_lattice(*rc::gen::inRange(2, 40), *rc::gen::inRange(0, 4));
        RC_PRE(!lattice.edges.empty());
        Raster<float> const dem = tilted(-4500.0, -4500.0, 900);
        RiverLines file = drawn(lattice);
        auto const one = scores_of(graph_of(file, &dem));
        disturb(file);
        auto const other = scores_of(graph_of(file, &dem));
        RC_ASSERT(one.size() == other.size());
        for (auto const& [at, scored] : one) {
            RC_ASSERT(std::fabs(other.at(at).shape - scored.shape) < 1e-6);
            RC_ASSERT(other.at(at).climb == scored.climb);
        }
    }));
}

// Law: a tree of lines that all lead away from one end, and fork, is drawn upstream.
TEST(ImportDirections, OneSourceAndNoConfluenceIsDrawnUpstream) {
    ASSERT_TRUE(rc::check([] {
        Lattice const lattice = random_lattice(*rc::gen::inRange(30, 50), 0, First::head);
        std::vector<int> degree(lattice.at.size(), 0);
        for (auto const& [from, to] : lattice.edges) {
            ++degree[from];
            ++degree[to];
        }
        RC_ASSERT(degree[0] == 1);
        if (*std::ranges::max_element(degree) < 3) {
            return; // one line
        }
        ImportedNetwork const imported = import_lines(drawn(lattice));
        RC_ASSERT(steps_of(imported.network) == steps_of(lattice));
        auto const forks = std::ranges::count_if(degree, [](int lines) { return lines > 2; });
        RC_ASSERT(imported.directions.doubts.size() == (forks <= 8 ? std::size_t{1} : std::size_t{0})); // a delta?
        RC_ASSERT(imported.directions.turned.size() == std::size_t{1});
        RC_ASSERT(imported.directions.turned.front().by.find("upstream") != std::string::npos);
    }));
}

TEST(ImportDirections, AnglesTellWhereTheDrawingContradictsItself) {
    auto lines = comb();
    auto const truth = steps_of(import_lines(flats(lines), {.orientation = Orientation::as_drawn}).network);
    for (std::size_t const l : {1U, 3U, 4U}) {
        std::ranges::reverse(lines[l]);
    }
    auto const imported = import_lines(flats(lines));
    EXPECT_EQ(steps_of(imported.network), truth);
    ASSERT_EQ(imported.directions.turned.size(), 1U);
    EXPECT_EQ(imported.directions.turned[0].by, "angles at confluences");
    EXPECT_NEAR(imported.directions.turned[0].length_m, 2000.0 + 700.0 * std::sqrt(2.0), 1e-6);
}

TEST(ImportDirections, ASingleLineAmongContradictionsIsUncertain) {
    auto lines = comb();
    std::ranges::reverse(lines[1]);
    std::ranges::reverse(lines[4]);
    std::ranges::reverse(lines[5]);
    lines.push_back({{2000, 2000}, {2000, 2600}});
    auto const imported = import_lines(flats(lines));
    ASSERT_TRUE(has_doubt(imported, "uncertain_direction"));
    EXPECT_NEAR(imported.directions.uncertain_m, 600.0, 1e-6);
    EXPECT_GT(imported.directions.expected_wrong_m, 100.0);
}

TEST(ImportDirections, ADemDecides) {
    Raster<float> dem(Grid{300, 300, 20.0, -3000.0, 5000.0, ""});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Vec2 const at = dem.grid().centre(dem.grid().at(i));
        dem[i] = static_cast<float>(200.0 - 0.02 * at.x);
    }
    auto lines = comb();
    lines.push_back({{2000, 2000}, {1000, 2000}}); // alone, drawn uphill
    auto const imported = import_lines(flats(lines), {.dem = &dem});
    ASSERT_EQ(imported.directions.turned.size(), 1U);
    EXPECT_EQ(imported.directions.turned[0].by, "the DEM");
    EXPECT_EQ(imported.directions.turned[0].length_m, 1000.0);
}

TEST(ImportDirections, ADirectionColumnTells) {
    ASSERT_TRUE(rc::check([] {
        Lattice const lattice = random_lattice(*rc::gen::inRange(2, 50), 0);
        RC_PRE(!lattice.edges.empty());
        RiverLines file = drawn(lattice);
        for (RiverLine& line : file.lines) {
            line.runs = -1; // towards the first vertex
            if (*rc::gen::inRange(0, 2) == 1) {
                std::ranges::reverse(line.vertices);
                line.runs = 1;
            }
        }
        ImportedNetwork const imported = import_lines(file);
        RC_ASSERT(steps_of(imported.network) == steps_of(lattice));
        RC_ASSERT(!has_doubt(imported, "contradicted_direction"));
    }));
}

// Law: nodes from which and to which water runs tell the direction of every line that has a neighbour.
TEST(ImportDirections, NodesTell) {
    ASSERT_TRUE(rc::check([] {
        Lattice const lattice = random_lattice(*rc::gen::inRange(4, 50), 0);
        if (lattice.edges.size() < 2) {
            return;
        }
        RiverLines file = drawn(lattice);
        for (std::size_t l = 0; l < file.lines.size(); ++l) {
            file.lines[l].from_node = static_cast<std::int64_t>(lattice.edges[l].second) + 1;
            file.lines[l].to_node = static_cast<std::int64_t>(lattice.edges[l].first) + 1;
        }
        disturb(file);
        ImportedNetwork const imported = import_lines(file);
        RC_ASSERT(steps_of(imported.network) == steps_of(lattice));
    }));
}

namespace {

/// A trunk of five lines and four tributaries, all drawn downstream, with ranks that rise.
RiverLines with_rising_ranks() {
    std::vector<std::vector<Vec2>> lines;
    for (int i = 5; i > 0; --i) {
        double const y = 1000.0 * i;
        lines.push_back({{0, y}, {0, y - 1000.0}});
        if (i > 1) {
            lines.push_back({{700, y - 300.0}, {0, y - 1000.0}});
        }
    }
    RiverLines file = flats(lines);
    for (std::size_t l = 0; l < file.lines.size(); ++l) {
        file.lines[l].feature = static_cast<std::int64_t>(l) + 1;
        file.lines[l].rank = file.lines[l].feature;
    }
    return file;
}

double end_of(ImportedNetwork const& imported) {
    return imported.network.node(imported.network.outlets()[0]).at.y;
}

std::size_t turned_ranks(ImportedNetwork const& imported) {
    return static_cast<std::size_t>(std::ranges::count(imported.repairs, FindingKind("turned_rank"), &Finding::kind));
}

void reverse_all(RiverLines& file) {
    for (RiverLine& line : file.lines) {
        std::ranges::reverse(line.vertices);
    }
}

} // namespace

TEST(ImportDirections, ARankThatRisesDownstreamIsTurned) {
    RiverLines const drawn_down = with_rising_ranks();
    EXPECT_EQ(end_of(import_lines(drawn_down)), 0.0);
    EXPECT_EQ(turned_ranks(import_lines(drawn_down)), 1U);
    ImportedNetwork const asked = import_lines(drawn_down, {.orientation = Orientation::rank});
    EXPECT_EQ(turned_ranks(asked), 0U);
    EXPECT_NE(end_of(asked), 0.0);
    // Drawn upstream, links or areas say it.
    RiverLines linked = drawn_down;
    RiverLines sized = drawn_down;
    for (std::size_t l = 0; l < linked.lines.size(); ++l) {
        bool const is_tributary = l % 2 == 1;
        linked.lines[l].down = l + 1 < linked.lines.size() ? static_cast<std::int64_t>(l) + (is_tributary ? 2 : 3) : 0;
        sized.lines[l].area_m2 = is_tributary ? 1.0 : 10.0 * static_cast<double>(l + 1);
    }
    for (RiverLines* const file : {&linked, &sized}) {
        reverse_all(*file);
        EXPECT_EQ(end_of(import_lines(*file)), 0.0);
        EXPECT_EQ(turned_ranks(import_lines(*file)), 1U);
    }
    // A rank that falls stays, however lines are drawn.
    RiverLines falling = drawn_down;
    for (RiverLine& line : falling.lines) {
        line.rank = 10 - line.rank;
    }
    EXPECT_EQ(turned_ranks(import_lines(falling)), 0U);
    reverse_all(falling);
    EXPECT_EQ(turned_ranks(import_lines(falling)), 0U);
    EXPECT_EQ(end_of(import_lines(falling)), 0.0);
}

TEST(ImportDirections, AColumnWithAThirdOfItsValuesWrongIsDoubted) {
    auto file = flats(comb());
    for (std::size_t l = 0; l < file.lines.size(); ++l) {
        file.lines[l].runs = l % 3 == 1 ? -1 : 1;
    }
    auto const imported = import_lines(file);
    EXPECT_TRUE(imported.secondary.empty());
    EXPECT_EQ(imported.network.outlets().size(), 1U);
    ASSERT_TRUE(has_doubt(imported, "contradicted_direction"));
    EXPECT_GT(imported.directions.doubts.back().amount, 0.1);
}

TEST(ImportDirections, AColumnAgainstAllAnglesIsDoubted) {
    std::vector<std::vector<Vec2>> lines;
    for (int i = 0; i < 12; ++i) {
        double const y = 1000.0 * i;
        lines.push_back({{0, y + 1000.0}, {0, y}});
        lines.push_back({{i % 2 == 0 ? -700.0 : 700.0, y + 1700.0}, {0, y + 1000.0}});
    }
    auto file = flats(lines);
    for (RiverLine& line : file.lines) {
        line.runs = line.vertices.front().x == 0.0 ? -1 : 1; // up the trunk
    }
    auto const imported = import_lines(file);
    ASSERT_EQ(imported.network.outlets().size(), 1U);
    EXPECT_GT(imported.network.node(imported.network.outlets()[0]).at.y, 11000.0);
    EXPECT_TRUE(has_doubt(imported, "conflicting_direction"));
}

TEST(ImportDirections, TwoRiversJoinedHeadToHeadMayHaveTwoOutlets) {
    std::vector<std::vector<Vec2>> lines;
    for (int i = 0; i < 8; ++i) {
        double const y = 1000.0 * i;
        for (double const side : {-1.0, 1.0}) { // from (0, 0) north and south
            lines.push_back({{0, side * y}, {0, side * (y + 1000.0)}});
            lines.push_back({{i % 2 == 0 ? -700.0 : 700.0, side * (y + 300.0)}, {0, side * (y + 1000.0)}});
        }
    }
    auto file = flats(lines);
    for (std::size_t l = 0; l < file.lines.size(); l += 3) {
        std::ranges::reverse(file.lines[l].vertices);
    }
    EXPECT_TRUE(has_doubt(import_lines(file), "second_outlet"));
}

} // namespace import_directions_test
