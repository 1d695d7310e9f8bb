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

namespace known_heights_test {

using namespace thalweg;
using network::lower_rises;

namespace {

using namespace thalweg;
using network::channels;
using network::elevate_from_dem;

/// A DEM that falls along every channel by random amounts, or is level there with some probability; far above
/// elsewhere.
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
    RC_ASSERT(test::same_network(raised.planform, net));
    test::require_heights(raised);
}

Raster<float> land(std::uint64_t seed, std::int64_t cols, std::int64_t rows) {
    Raster<float> dem(Grid{cols, rows, 1.0, 0.0, static_cast<double>(rows), {}});
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = static_cast<float>(random_word(seed, 77 + static_cast<std::uint64_t>(i)) % 1000) / 8.0F;
    }
    return dem;
}

/// Two sources that meet, and an outlet.
StreamNetwork two_rivers() {
    return test::network_of({{0, 4}, {4, 4}, {2, 2}, {2, 0}}, {{0, 2, {{1, 3}}}, {1, 2}, {2, 3}});
}

ElevatedNetwork known_rivers() {
    return {two_rivers(), {9, 8, 5, 1}, {{9, 7, 5}, {8, 5}, {5, 1}}};
}

/// Law: each vertex has the least of the heights at it and upstream of it.
void require_least(ElevatedNetwork const& lowered, std::vector<std::vector<double>> const& before) {
    StreamNetwork const& net = lowered.planform;
    std::function<double(std::size_t, std::size_t)> const least = [&](std::size_t a, std::size_t vertices) {
        double low = *std::min_element(before[a].begin(), before[a].begin() + static_cast<std::ptrdiff_t>(vertices));
        for (ArcId const up : net.in(net.from(a))) {
            low = std::min(low, least(up, before[up].size()));
        }
        return low;
    };
    for (std::size_t a = 0; a < net.arc_count(); ++a) {
        auto const& z = lowered.arc_z[a];
        RC_ASSERT(z.size() == before[a].size());
        for (std::size_t v = 0; v + 1 < z.size(); ++v) {
            RC_ASSERT(z[v] == least(a, v + 1));
        }
        RC_ASSERT(z.front() == lowered.node_z[net.from(a)]);
        RC_ASSERT(z.back() == lowered.node_z[net.to(a)]);
    }
    for (NodeId n = 0; n < net.node_count(); ++n) {
        double low = std::numeric_limits<double>::infinity();
        for (ArcId const a : net.in(n)) {
            low = std::min(low, least(a, before[a].size()));
        }
        RC_ASSERT((net.in(n).empty() || net.out(n) != no_arc || lowered.node_z[n] == low));
    }
}

} // namespace

TEST(RaiseFromLand, NeedsHeightsUnderRivers) {
    StreamNetwork const net = test::network_of({{0.5, 0.5}, {2.5, 0.5}}, {{1, 0}});
    Channels const rivers = channels(net, test::frame(3, 1)).channels;
    Raster<float> const other(test::frame(3, 2), 1.0F);
    Raster<float> const infinite(test::frame(3, 1), std::numeric_limits<float>::infinity());
    for (Raster<float> const& wrong : {other, infinite}) {
        EXPECT_TRUE(test::refused("network.elevate_from_dem", [&] { elevate_from_dem(net, rivers, wrong); }));
    }
}

TEST(RaiseFromLand, VerticesTakeTheirCellsHeightsAndShareADrop) {
    // Three vertices in the middle cell: the first has its height, the others lie between it and the next cell
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
    // Two confluences stand equally high where the water passes beside one of them
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
    ASSERT_TRUE(rc::check("never rise, whatever is drawn", [] {
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
    EXPECT_NO_THROW(network::drape(rivers.planform, dem));
    dem[Cell{0, 0}] = std::numeric_limits<float>::quiet_NaN(); // sources lie in the northernmost row
    EXPECT_THROW(network::drape(rivers.planform, dem), BadInput);
    EXPECT_THROW(network::drape(rivers.planform, land(1, 5, 3)), BadInput);
}

TEST(Drape, LeastHeightOfAllUpstream) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const cols = *rc::gen::inRange<std::int64_t>(2, 20);
        auto const rows = *rc::gen::inRange<std::int64_t>(2, 20);
        ElevatedNetwork rivers = random_rivers(seed, cols, rows);
        Raster<float> const dem = land(seed, cols, rows);
        for (std::size_t a = 0; a < rivers.planform.arc_count(); ++a) {
            auto const& line = rivers.planform.arc(a).line;
            std::ranges::transform(line, rivers.arc_z[a].begin(),
                                   [&](Vec2 p) { return static_cast<double>(dem[dem.grid().cell_of(p)]); });
        }
        require_least(network::drape(rivers.planform, dem), rivers.arc_z);
    }));
}

TEST(LowerRises, IsTheHighestThatFalls) {
    EXPECT_THROW(lower_rises(test::chain(1), {}), BadInput);
    EXPECT_THROW(lower_rises(test::chain(1), {{1}}), BadInput);
    ASSERT_TRUE(rc::check("as the least of all heights upstream", [] {
        ElevatedNetwork rivers = random_rivers(*rc::gen::arbitrary<std::uint64_t>(), 8, 8);
        for (auto& z : rivers.arc_z) {
            for (double& height : z) {
                height = static_cast<double>(*rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 20)));
            }
        }
        require_least(lower_rises(rivers.planform, rivers.arc_z).network, rivers.arc_z);
    }));
}

TEST(KeepHeights, SameNetworkKeepsItsHeights) {
    EXPECT_TRUE(network::keep_heights({}, {}).arc_z.empty());
    EXPECT_THROW(network::keep_heights(two_rivers(), {}), BadInput);
    ElevatedNetwork const out = network::keep_heights(two_rivers(), known_rivers());
    EXPECT_EQ(out.node_z, known_rivers().node_z);
    EXPECT_EQ(out.arc_z, known_rivers().arc_z);
}

TEST(KeepHeights, AnOutletCarriedOnFallsAsItsRiverDoes) {
    NetworkDraft longer = two_rivers().draft();
    ArcId const last = 2;
    longer.nodes[longer.arcs[last].to].at = {2, -10};
    longer.arcs[last].arc.line = {{2, 2}, {2, 0}, {2, -10}};
    ElevatedNetwork const out = network::keep_heights(longer, known_rivers());
    EXPECT_EQ(out.arc_z[2], (std::vector<double>{5, 1, -19})); // 2 m a metre
    EXPECT_EQ(out.node_z[3], -19);
}

TEST(KeepHeights, TheSlopeIsThatOfTheLastKilometre) {
    Vec2 const source{0, 5000};
    ElevatedNetwork const known{
        test::network_of({source, {0, 0}}, {{0, 1, {{0, 1000}, {0, 500}}}}), {400, 0}, {{400, 2, 1.5, 0}}};
    StreamNetwork const longer = test::network_of({source, {0, -500}}, {{0, 1, {{0, 1000}, {0, 500}, {0, 0}}}});
    ElevatedNetwork const out = network::keep_heights(longer, known);
    EXPECT_EQ(out.arc_z[0], (std::vector<double>{400, 2, 1.5, 0, -1}));
}

TEST(KeepHeights, ANewArcGoesOnAsTheLowestThatComesToIt) {
    NetworkDraft longer = two_rivers().draft();
    NodeId const end = longer.add_node({2, -10});
    longer.add_arc(longer.arcs[2].to, end, {{{2, 0}, {2, -10}}, 1, 0, ""});
    ElevatedNetwork const out = network::keep_heights(StreamNetwork(longer), known_rivers());
    EXPECT_EQ(out.arc_z[3], (std::vector<double>{1, -19}));
}

} // namespace known_heights_test
