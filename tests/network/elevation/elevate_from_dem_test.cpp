// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/known_heights.hpp>

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>

namespace elevate_from_dem_test {

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

} // namespace

} // namespace elevate_from_dem_test
