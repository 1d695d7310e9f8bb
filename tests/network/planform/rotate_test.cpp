// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/rotate.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>

namespace rotate_test {

namespace {

using namespace thalweg;
using network::rotate;
using network::RotatedNetwork;

TEST(Rotate, RefusesWhatItCannotTurn) {
    StreamNetwork const net = test::network_of({{0.0, 0.0}, {0.0, 9.0}}, {{1, 0}});
    EXPECT_THROW(rotate({}, test::frame(9, 9)), BadInput);
    EXPECT_THROW(rotate(net, test::frame(9, 9), {181.0}), BadParameter);
    EXPECT_THROW(rotate(net, test::frame(9, 5), {0.0}), BadInput);
    StreamNetwork const nowhere =
        test::network_of({{0.0, 0.0}, {0.0, std::numeric_limits<double>::quiet_NaN()}}, {{1, 0}});
    EXPECT_THROW(rotate(nowhere, test::frame(9, 9)), BadInput);
}

TEST(Rotate, AQuarterTurnIsCounterClockwise) {
    StreamNetwork const net = test::network_of({{0.0, 0.0}, {0.0, 8.0}}, {{1, 0}});
    RotatedNetwork const out = rotate(net, test::frame(10, 10), {90.0});
    EXPECT_EQ(out.network.node(0).at, (Vec2{9.0, 5.0}));
    EXPECT_EQ(out.network.node(1).at, (Vec2{1.0, 5.0}));
}

TEST(Rotate, TheSameRiversInTheMiddleOfTheirGrid) {
    ASSERT_TRUE(rc::check("distances are kept, a grid without a size is made to fit", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        double const turn = network::random_turn(seed);
        RC_ASSERT(std::fabs(turn) >= 12.0);
        RC_ASSERT(std::fabs(turn) <= 33.0);
        StreamNetwork const net = test::random_skeleton(seed, 40);
        Grid frame = test::frame(0, 0);
        frame.west = 500000.0;
        frame.north = 5000000.0;
        RotatedNetwork const out = rotate(net, frame, {turn});
        RC_ASSERT(out.network.from() == net.from());
        for (std::size_t a = 0; a < net.arc_count(); ++a) {
            auto const& line = out.network.arc(a).line;
            RC_ASSERT(std::fabs(out.network.length_m(a) - net.length_m(a)) < 1e-5 * static_cast<double>(line.size()));
            RC_ASSERT(line.front() == out.network.node(out.network.from(a)).at);
            for (Cell const c : cells_of_vertices(line, out.grid)) {
                RC_ASSERT(!out.grid.on_border(c));
            }
        }
        RC_ASSERT(out.grid.west == frame.west);
        RC_ASSERT(out.grid.north == frame.north);
    }));
}

TEST(Rotate, ABranchCutToTheTurnedBoxFits) {
    growth::Cluster const cluster = growth::grow_dla({.particles = 3000});
    for (double const turn : {-33.0, -12.0, 20.0}) {
        auto const branch = growth::pick_branch(cluster, {growth::BranchChoice::all, 60, 40, turn});
        EXPECT_TRUE(branch.cut);
        NetworkDraft net;
        for (Cell const c : branch.cells) {
            net.add_node({static_cast<double>(c.col), -static_cast<double>(c.row)});
        }
        net.add_arc(0, 1);
        EXPECT_NO_THROW(rotate(net, test::frame(60, 40), {turn}));
        EXPECT_THROW(rotate(net, test::frame(60, 30), {turn}), BadInput);
    }
}

} // namespace

} // namespace rotate_test
