// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/known_heights.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <measure/trees.hpp>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>

#include "measure/trees.hpp"

namespace known_heights_test {

using namespace thalweg;
using network::lower_rises;
using network::Lowered;

namespace {

using namespace thalweg;
using network::channels;
using network::elevate_from_dem;

/// A land that falls along every channel by a chance amount, or is level there with some chance; far above elsewhere.
Raster<float> land_around(Channels const& rivers, std::uint64_t seed, double share_level) {
    Raster<float> land(rivers.grid, 1e6F);
    for (std::size_t i = 0; i < rivers.cell.size(); ++i) {
        double const rise = unit(random_word(seed, 1, i)) < share_level ? 0.0 : 0.01 + unit(random_word(seed, 2, i));
        land[rivers.cell[i]] =
            rivers.receiver[i] < 0
                ? 0.0F
                : static_cast<float>(land[rivers.cell[static_cast<std::size_t>(rivers.receiver[i])]] + rise);
    }
    return land;
}

void require_consistent(ElevatedNetwork const& raised, StreamNetwork const& net) {
    for (std::size_t a = 0; a < net.arc_count(); ++a) {
        RC_ASSERT(raised.plan.arc(a).line == net.arc(a).line);
        RC_ASSERT(raised.arc_z[a].size() == net.arc(a).line.size());
        RC_ASSERT(raised.arc_z[a].front() == raised.node_z[net.from(a)]);
        RC_ASSERT(raised.arc_z[a].back() == raised.node_z[net.to(a)]);
        RC_ASSERT(std::is_sorted(raised.arc_z[a].rbegin(), raised.arc_z[a].rend()));
    }
}

Raster<float> land(std::uint64_t seed, std::int64_t cols, std::int64_t rows) {
    Raster<float> dem(Grid{cols, rows, 1.0, 0.0, static_cast<double>(rows), {}});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = static_cast<float>(random_word(seed, 77 + static_cast<std::uint64_t>(i)) % 1000) / 8.0F;
    }
    return dem;
}

StreamNetwork chain(std::vector<Vec2> const& places) {
    NetworkDraft net;
    NodeId above = net.add_node(places.front());
    for (std::size_t i = 1; i < places.size(); ++i) {
        NodeId const below = net.add_node(places[i]);
        Arc arc;
        arc.line = {places[i - 1], places[i]};
        net.add_arc(above, below, std::move(arc));
        above = below;
    }
    return net;
}

/// Two sources that meet, and an outlet.
StreamNetwork two_rivers() {
    NetworkDraft net;
    NodeId const a = net.add_node({0, 4});
    NodeId const b = net.add_node({4, 4});
    NodeId const c = net.add_node({2, 2});
    NodeId const d = net.add_node({2, 0});
    net.add_arc(a, c, {{{0, 4}, {1, 3}, {2, 2}}, 1, 0, ""});
    net.add_arc(b, c, {{{4, 4}, {2, 2}}, 1, 0, ""});
    net.add_arc(c, d, {{{2, 2}, {2, 0}}, 1, 0, ""});
    return net;
}

} // namespace

TEST(RaiseFromLand, NeedsLandUnderRivers) {
    StreamNetwork const net = test::network_of({{0.5, 0.5}, {2.5, 0.5}}, {{1, 0}});
    Channels const rivers = channels(net, test::frame(3, 1)).channels;
    EXPECT_THROW(elevate_from_dem(net, rivers, Raster<float>(test::frame(3, 2), 1.0F)), BadInput);
    EXPECT_THROW(
        elevate_from_dem(net, rivers, Raster<float>(test::frame(3, 1), std::numeric_limits<float>::infinity())),
        BadInput);
}

TEST(RaiseFromLand, VerticesTakeTheirCellsHeightsAndShareADrop) {
    // three vertices in the middle cell: the first has its height, the others lie between it and the next cell
    StreamNetwork const net =
        test::network_of({{0.5, 0.5}, {1.5, 0.5}, {2.5, 0.5}}, {{1, 0, {{1.25, 0.5}}}, {2, 1, {{1.75, 0.5}}}});
    Grid const grid = test::frame(3, 1);
    Raster<float> land(grid);
    land[0] = 1.0F;
    land[1] = 2.25F;
    land[2] = 5.0F;
    ElevatedNetwork const raised = elevate_from_dem(net, channels(net, grid).channels, land);
    EXPECT_EQ(raised.arc_z, (std::vector<std::vector<double>>{{2.0, 1.75, 1.0}, {5.0, 2.25, 2.0}}));
    EXPECT_EQ(raised.node_z, (std::vector<double>{1.0, 2.0, 5.0}));
}

TEST(RaiseFromLand, CellsOfOneHeightMakeNoLevelArcOffALake) {
    // two confluences stand equally high where the water passes beside one of them
    StreamNetwork const net =
        test::network_of({{0.5, 0.5}, {1.5, 0.5}, {2.5, 0.5}, {3.5, 0.5}}, {{1, 0}, {2, 1}, {3, 2}});
    Grid const grid = test::frame(4, 1);
    Raster<float> land(grid);
    land[0] = 1.0F;
    land[1] = 2.0F;
    land[2] = 2.0F;
    land[3] = 5.0F;
    Channels rivers = channels(net, grid).channels;
    EXPECT_EQ(elevate_from_dem(net, rivers, land).node_z, (std::vector<double>{1.0, 1.5, 2.0, 5.0}));
    rivers.level.assign(rivers.cell.size(), 0);
    auto const at = std::find(rivers.cell.begin(), rivers.cell.end(), grid.index({2, 0}));
    rivers.level[static_cast<std::size_t>(at - rivers.cell.begin())] = 1;
    EXPECT_EQ(elevate_from_dem(net, rivers, land).node_z, (std::vector<double>{1.0, 2.0, 2.0, 5.0}));
}

TEST(RaiseFromLand, ArcsFallWhereTheLandDoes) {
    ASSERT_TRUE(rc::check("on a lattice", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork const net = test::random_skeleton(seed, 40);
        Grid const grid = test::frame(40, 40);
        auto const drawn = channels(net, grid);
        ElevatedNetwork const raised = elevate_from_dem(net, drawn.channels, land_around(drawn.channels, seed, 0.0));
        require_consistent(raised, net);
        for (auto const& z : raised.arc_z) {
            RC_ASSERT(z.front() > z.back());
        }
    }));
    ASSERT_TRUE(rc::check("never rise and stay between the land's heights, whatever is drawn", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork const net = test::random_forest(seed, *rc::gen::inRange<std::size_t>(0, 30), 2);
        Grid grid = test::frame(50, 50);
        grid.cell_m = 20.0;
        grid.north = 1000.0;
        auto const drawn = channels(net, grid);
        Raster<float> land = land_around(drawn.channels, seed, 0.2);
        require_consistent(elevate_from_dem(net, drawn.channels, land), net);
    }));
}

TEST(RaiseFromLand, LevelChannelsMakeLevelRivers) {
    StreamNetwork const net = test::random_skeleton(5, 40);
    auto const drawn = channels(net, test::frame(40, 40));
    Raster<float> const land(test::frame(40, 40), 7.0F);
    ElevatedNetwork const raised = elevate_from_dem(net, drawn.channels, land);
    EXPECT_EQ(std::count(raised.node_z.begin(), raised.node_z.end(), 7.0),
              static_cast<std::ptrdiff_t>(raised.node_z.size()));
}

TEST(ChannelHeights, NeverRiseDownstream) {
    ASSERT_TRUE(rc::check("also where rivers share cells", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        StreamNetwork const net = test::random_forest(seed, *rc::gen::inRange<std::size_t>(0, 30), 2);
        Grid grid = test::frame(50, 50);
        grid.cell_m = 20.0;
        grid.north = 1000.0;
        Channels const rivers = channels(net, grid).channels;
        ElevatedNetwork const raised = elevate_from_dem(net, rivers, land_around(rivers, seed, 0.1));
        std::vector<float> const z = network::channel_heights(raised, rivers);
        RC_ASSERT(z.size() == rivers.cell.size());
        for (std::size_t i = 0; i < z.size(); ++i) {
            RC_ASSERT(z[i] >= 0.0F);
            if (rivers.receiver[i] >= 0) {
                RC_ASSERT(z[i] >= z[static_cast<std::size_t>(rivers.receiver[i])]);
            }
        }
    }));
}

TEST(Drape, RefusesWhereTheDemHasNoHeight) {
    ElevatedNetwork const rivers = random_rivers(1, 5, 5);
    Raster<float> dem = land(1, 5, 5);
    EXPECT_NO_THROW(network::drape(rivers.plan, dem));
    dem[Cell{0, 0}] = std::numeric_limits<float>::quiet_NaN(); // sources lie in the northernmost row
    EXPECT_THROW(network::drape(rivers.plan, dem), BadInput);
    EXPECT_THROW(network::drape(rivers.plan, land(1, 5, 3)), BadInput);
}

// Law: each vertex has the least height of the cells at it and upstream of it; so heights never rise downstream.
TEST(Drape, LeastHeightOfAllUpstream) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const cols = *rc::gen::inRange<std::int64_t>(2, 20);
        auto const rows = *rc::gen::inRange<std::int64_t>(2, 20);
        ElevatedNetwork const rivers = random_rivers(seed, cols, rows);
        Raster<float> const dem = land(seed, cols, rows);
        ElevatedNetwork const raised = network::drape(rivers.plan, dem);
        auto const at = [&](Vec2 p) { return static_cast<double>(dem[dem.grid().cell_of(p)]); };
        std::function<double(NodeId)> const least = [&](NodeId n) {
            double z = at(rivers.plan.node(n).at);
            for (ArcId const in : rivers.plan.in(n)) {
                auto const a = in;
                for (Vec2 const p : rivers.plan.arc(a).line) {
                    z = std::min(z, at(p));
                }
                z = std::min(z, least(rivers.plan.from(a)));
            }
            return z;
        };
        for (NodeId n = 0; n < rivers.plan.node_count(); ++n) {
            RC_ASSERT(raised.node_z[n] == least(n));
        }
        for (std::size_t a = 0; a < rivers.plan.arc_count(); ++a) {
            double z = raised.node_z[rivers.plan.from(a)];
            auto const& line = rivers.plan.arc(a).line;
            RC_ASSERT(raised.arc_z[a].size() == line.size());
            for (std::size_t i = 0; i + 1 < line.size(); ++i) {
                z = std::min(z, at(line[i]));
                RC_ASSERT(raised.arc_z[a][i] == z);
            }
            RC_ASSERT(raised.arc_z[a].back() == raised.node_z[rivers.plan.to(a)]);
        }
    }));
}

TEST(LowerRises, RefusesOtherHeights) {
    EXPECT_THROW(lower_rises(chain({{0, 0}, {1, 0}}), {}), BadInput);
    EXPECT_THROW(lower_rises(chain({{0, 0}, {1, 0}}), {{1}}), BadInput);
}

TEST(LowerRises, IsTheHighestThatFalls) {
    ASSERT_TRUE(rc::check("as the least of all heights upstream", [] {
        ElevatedNetwork rivers = random_rivers(*rc::gen::arbitrary<std::uint64_t>(), 8, 8);
        for (auto& z : rivers.arc_z) {
            for (double& height : z) {
                height = static_cast<double>(*rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 20)));
            }
        }
        Lowered const lowered = lower_rises(rivers.plan, rivers.arc_z);
        // Slow: the least of an arc up to a vertex, and of all arcs from which its water comes.
        auto const least = [&](auto const& self, std::size_t a, std::size_t vertices) -> double {
            auto const& z = rivers.arc_z[a];
            double low = *std::min_element(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(vertices));
            for (auto const up : rivers.plan.in(rivers.plan.from(a))) {
                auto const b = static_cast<std::size_t>(up);
                low = std::min(low, self(self, b, rivers.arc_z[b].size()));
            }
            return low;
        };
        for (std::size_t a = 0; a < rivers.plan.arc_count(); ++a) {
            auto const& z = lowered.network.arc_z[a];
            for (std::size_t v = 0; v + 1 < z.size(); ++v) {
                RC_ASSERT(z[v] == least(least, a, v + 1));
            }
            RC_ASSERT(z.front() == lowered.network.node_z[rivers.plan.from(a)]);
            RC_ASSERT(z.back() == lowered.network.node_z[rivers.plan.to(a)]);
            RC_ASSERT(z.back() <= z[z.size() - 2]);
        }
    }));
}

TEST(KeepHeights, EmptyNetwork) {
    EXPECT_TRUE(network::keep_heights({}, {}).arc_z.empty());
}

TEST(KeepHeights, NoHeightsAtAll) {
    EXPECT_THROW(network::keep_heights(two_rivers(), {}), BadInput);
}

TEST(KeepHeights, SameNetworkKeepsItsHeights) {
    ElevatedNetwork const known{two_rivers(), {9, 8, 5, 1}, {{9, 7, 5}, {8, 5}, {5, 1}}};
    ElevatedNetwork const out = network::keep_heights(known.plan, known);
    EXPECT_EQ(out.node_z, known.node_z);
    EXPECT_EQ(out.arc_z, known.arc_z);
}

TEST(KeepHeights, AnOutletCarriedOnFallsAsItsRiverDoes) {
    ElevatedNetwork const known{two_rivers(), {9, 8, 5, 1}, {{9, 7, 5}, {8, 5}, {5, 1}}};
    NetworkDraft longer = known.plan.draft();
    ArcId const last = 2;
    longer.nodes[longer.arcs[last].to].at = {2, -10};
    longer.arcs[last].arc.line = {{2, 2}, {2, 0}, {2, -10}};
    ElevatedNetwork const out = network::keep_heights(longer, known);
    EXPECT_EQ(out.arc_z[2], (std::vector<double>{5, 1, -19})); // 2 m a metre
    EXPECT_EQ(out.node_z[3], -19);
}

TEST(KeepHeights, TheSlopeIsThatOfTheLastKilometre) {
    NetworkDraft net;
    NodeId const a = net.add_node({0, 5000});
    NodeId const b = net.add_node({0, 0});
    net.add_arc(a, b, {{{0, 5000}, {0, 1000}, {0, 500}, {0, 0}}, 1, 0, ""});
    ElevatedNetwork const known{StreamNetwork(net), {400, 0}, {{400, 2, 1.5, 0}}};
    net.nodes[b].at = {0, -500};
    net.arcs[0].arc.line.push_back({0, -500});
    ElevatedNetwork const out = network::keep_heights(StreamNetwork(net), known);
    EXPECT_EQ(out.arc_z[0], (std::vector<double>{400, 2, 1.5, 0, -1}));
}

TEST(KeepHeights, ANewArcGoesOnAsTheLowestThatComesToIt) {
    ElevatedNetwork const known{two_rivers(), {9, 8, 5, 1}, {{9, 7, 5}, {8, 5}, {5, 1}}};
    NetworkDraft longer = known.plan.draft();
    NodeId const end = longer.add_node({2, -10});
    longer.add_arc(longer.arcs[2].to, end, {{{2, 0}, {2, -10}}, 1, 0, ""});
    ElevatedNetwork const out = network::keep_heights(StreamNetwork(longer), known);
    EXPECT_EQ(out.arc_z[3], (std::vector<double>{1, -19}));
}

} // namespace known_heights_test
