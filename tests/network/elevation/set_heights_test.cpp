// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace set_heights_test {

namespace {

using namespace thalweg;
using network::HeightMode;
using network::set_heights;

/// A hook: the source lies beside its outlet, the river goes far round (node 2 is farther out than node 3 above it).
StreamNetwork hook() {
    return test::network_of({{0, 0}, {10, 0}, {10, 10}, {0, 2}, {12, 10}}, {{1, 0}, {2, 1}, {3, 2}, {4, 2}});
}

} // namespace

TEST(SetHeights, RefusesBadParametersAndNetworks) {
    StreamNetwork const net = test::chain(2);
    for (double const slope :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(set_heights(net, {HeightMode::straight, slope}), BadParameter);
    }
    EXPECT_THROW(set_heights(test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}})), BadInput);
    EXPECT_THROW(set_heights(test::network_of({{0, 0}, {0, 0}}, {{1, 0}})), BadInput); // an arc of no length
    EXPECT_THROW(set_heights(test::network_of({{0, 0}, {NAN, 0}}, {{1, 0}})), BadInput);
    EXPECT_TRUE(set_heights(StreamNetwork()).network.node_z.empty());
}

TEST(SetHeights, ThreeModesOfOneHook) {
    double const s = 0.1;
    auto const straight = set_heights(hook(), {HeightMode::straight, s});
    EXPECT_NEAR(straight.network.node_z[2], 1.41421356, 1e-8);
    EXPECT_DOUBLE_EQ(straight.network.node_z[3], 0.2);
    EXPECT_EQ(straight.report.uphill_arcs, 1);
    EXPECT_DOUBLE_EQ(straight.report.uphill_length_m, std::sqrt(164.0));
    EXPECT_NEAR(straight.report.max_rise_m, 1.41421356 - 0.2, 1e-8);
    EXPECT_EQ(straight.report.lifted, 0);

    auto const repaired = set_heights(hook(), {HeightMode::straight_repaired, s});
    double const lifted = 1.41421356237 + 0.01 * s * std::sqrt(164.0);
    EXPECT_NEAR(repaired.network.node_z[3], lifted, 1e-9);
    EXPECT_EQ(repaired.network.node_z[2], straight.network.node_z[2]);
    EXPECT_EQ(repaired.report.uphill_arcs, 1);
    EXPECT_EQ(repaired.report.lifted, 1);
    EXPECT_NEAR(repaired.report.max_lift_m, lifted - 0.2, 1e-9);
    EXPECT_NEAR(repaired.report.rms_lift_m, lifted - 0.2, 1e-9);

    auto const stream = set_heights(hook(), {HeightMode::along_stream, s});
    EXPECT_NEAR(stream.network.node_z[3], s * (20.0 + std::sqrt(164.0)), 1e-12);
    EXPECT_EQ(stream.report.uphill_arcs, 1);
}

TEST(SetHeights, VerticesAreLinearByLengthUphillToo) {
    StreamNetwork const net = test::network_of({{0, 0}, {3, 0}}, {{1, 0, {{3, 3}, {0, 3}, {0, 1}}}});
    auto const raised = set_heights(net, {HeightMode::straight, 1.0}).network;
    std::vector<double> const expected{3.0, 2.0, 1.0, 1.0 / 3.0, 0.0};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(raised.arc_z[0][i], expected[i], 1e-15);
    }
    auto const up = set_heights(test::network_of({{0, 0}, {8, 0}, {4, 0}}, {{2, 1, {{5, 0}}}, {1, 0, {{4, 9}}}}),
                                {HeightMode::straight, 1.0})
                        .network;
    EXPECT_EQ(up.arc_z[0], (std::vector<double>{4.0, 5.0, 8.0}));
}

TEST(SetHeights, TheDefaultIsFiveDegreesRepaired) {
    auto const raised = set_heights(test::chain(100)).network;
    EXPECT_DOUBLE_EQ(raised.node_z[100], 8.7);
}

TEST(SetHeights, Laws) {
    ASSERT_TRUE(
        rc::check("every arc falls strictly, no node below straight, ends bit for bit, vertices never rise", [] {
            StreamNetwork const net = test::any_network();
            double const slope = *rc::gen::element(1e-6, 0.087, 3.0);
            auto const straight = set_heights(net, {HeightMode::straight, slope});
            for (HeightMode const mode :
                 {HeightMode::straight, HeightMode::straight_repaired, HeightMode::along_stream}) {
                auto const raised = set_heights(net, {mode, slope});
                auto const& z = raised.network.node_z;
                RC_ASSERT(raised.report.uphill_arcs == straight.report.uphill_arcs);
                for (NodeId const outlet : net.outlets()) {
                    RC_ASSERT(z[outlet] == 0.0);
                }
                for (NodeId n = 0; n < z.size(); ++n) {
                    RC_ASSERT(z[n] >= straight.network.node_z[n]);
                }
                std::int64_t uphill = 0;
                for (std::size_t a = 0; a < net.arc_count(); ++a) {
                    auto const& arc_z = raised.network.arc_z[a];
                    bool const falls = z[net.from(a)] > z[net.to(a)];
                    uphill += falls ? 0 : 1;
                    RC_ASSERT(arc_z.size() == net.arc(a).line.size());
                    RC_ASSERT(arc_z.front() == z[net.from(a)]);
                    RC_ASSERT(arc_z.back() == z[net.to(a)]);
                    double so_far = 0.0;
                    for (std::size_t i = 1; i < arc_z.size(); ++i) {
                        so_far += distance(net.arc(a).line[i - 1], net.arc(a).line[i]);
                        double const linear = arc_z.front() + (arc_z.back() - arc_z.front()) * so_far / net.length_m(a);
                        RC_ASSERT(std::fabs(arc_z[i] - linear) <= 1e-9);
                        if (falls) {
                            RC_ASSERT(arc_z[i] <= arc_z[i - 1]);
                            RC_ASSERT(static_cast<float>(arc_z[i]) <= static_cast<float>(arc_z[i - 1]));
                        }
                    }
                }
                RC_ASSERT(uphill == (mode == HeightMode::straight ? straight.report.uphill_arcs : 0));
            }
        }));
}

TEST(SetHeights, TheRepairIsTheLeastMajorant) {
    ASSERT_TRUE(rc::check("z(u) = max over v downstream of s|v| + 0.01 s length(u, v); along_stream = s length", [] {
        StreamNetwork const net = test::any_network();
        double const slope = 0.087;
        auto const straight = set_heights(net, {HeightMode::straight, slope}).network.node_z;
        auto const repaired = set_heights(net, {HeightMode::straight_repaired, slope});
        auto const stream = set_heights(net, {HeightMode::along_stream, slope}).network.node_z;
        std::int64_t lifted = 0;
        for (NodeId n = 0; n < straight.size(); ++n) {
            double best = straight[n];
            double way = 0.0;
            NodeId at = n;
            while (net.out(at) != no_arc) {
                way += net.length_m(net.out(at));
                at = net.to(net.out(at));
                best = std::max(best, straight[at] + 0.01 * slope * way);
            }
            RC_ASSERT(std::fabs(straight[n] - slope * distance(net.node(n).at, net.node(at).at)) <= 1e-12);
            RC_ASSERT(std::fabs(repaired.network.node_z[n] - best) <= 1e-9);
            RC_ASSERT(std::fabs(stream[n] - slope * way) <= 1e-9 * (1.0 + way));
            lifted += repaired.network.node_z[n] > straight[n] ? 1 : 0;
        }
        RC_ASSERT(repaired.report.lifted == lifted);
    }));
}

TEST(SetHeights, ALongChain) {
    auto const raised = set_heights(test::chain(200000), {HeightMode::along_stream, 1.0}).network;
    EXPECT_EQ(raised.node_z.back(), 2e5);
}

} // namespace set_heights_test
