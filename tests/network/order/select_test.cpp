// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/select.hpp>

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

namespace select_test {

using namespace thalweg;

TEST(Select, UpstreamIsWhatFlowsThrough) {
    ASSERT_TRUE(rc::check("an arc is upstream of those downstream of it", [] {
        StreamNetwork const net = test::random_forest(*rc::gen::arbitrary<std::uint64_t>(), 12, 2);
        RC_PRE(net.arc_count() > 0);
        for (ArcId a = 0; a < net.arc_count(); ++a) {
            auto const upstream = network::upstream_of(net, a);
            RC_ASSERT(std::ranges::is_sorted(upstream));
            for (ArcId b = 0; b < net.arc_count(); ++b) {
                auto const down = network::downstream_of(net, b);
                bool const is_below = std::ranges::find(down, a) != down.end();
                RC_ASSERT(down.front() == b);
                RC_ASSERT(net.out(net.to(down.back())) == no_arc);
                RC_ASSERT(std::ranges::binary_search(upstream, b) == is_below);
            }
        }
    }));
}

TEST(Select, APartHasTheArcsAsTheyAre) {
    ASSERT_TRUE(rc::check("selected arcs keep lines, attributes and heights", [] {
        StreamNetwork const net = test::random_forest(*rc::gen::arbitrary<std::uint64_t>(), 12, 2);
        ElevatedNetwork whole{net, {}, {}};
        for (NodeId n = 0; n < net.node_count(); ++n) {
            whole.node_z.push_back(static_cast<double>(n));
        }
        std::vector<ArcId> arcs;
        for (ArcId a = 0; a < net.arc_count(); ++a) {
            whole.arc_z.emplace_back(net.arc(a).line.size(), static_cast<double>(a));
            whole.arc_z.back().front() = whole.node_z[net.from(a)];
            whole.arc_z.back().back() = whole.node_z[net.to(a)];
            if (*rc::gen::arbitrary<bool>()) {
                arcs.insert(arcs.begin(), 2, a); // twice, from behind
            }
        }
        ElevatedNetwork const part = network::select(whole, arcs);
        RC_ASSERT(part.planform.arc_count() == arcs.size() / 2);
        for (ArcId a = 0; a < part.planform.arc_count(); ++a) {
            ArcId const was = arcs[arcs.size() - 1 - 2 * a];
            RC_ASSERT(part.planform.arc(a).line == net.arc(was).line);
            RC_ASSERT(part.planform.arc(a).feature == net.arc(was).feature);
            RC_ASSERT(part.arc_z[a] == whole.arc_z[was]);
            RC_ASSERT(part.node_z[part.planform.from(a)] == whole.node_z[net.from(was)]);
            RC_ASSERT(part.node_z[part.planform.to(a)] == whole.node_z[net.to(was)]);
        }
        for (NodeId n = 0; n < part.planform.node_count(); ++n) {
            bool const is_used = !part.planform.in(n).empty() || !part.planform.out_arcs(n).empty();
            RC_ASSERT(is_used);
        }
    }));
}

TEST(Select, TheNearestArcAndWhatIsRefused) {
    StreamNetwork const net = test::network_of({{0.0, 0.0}, {10.0, 0.0}, {0.0, 8.0}}, {{0, 1}, {2, 1}});
    EXPECT_EQ(network::nearest_arc(net, {2.0, 1.0}), 0U);
    EXPECT_EQ(network::nearest_arc(net, {0.0, 9.0}), 1U);
    EXPECT_EQ(network::nearest_arc(net, {12.0, 0.0}), 0U); // both end there
    EXPECT_THROW(network::nearest_arc(net, nowhere), BadInput);
    EXPECT_THROW(network::nearest_arc({}, {0.0, 0.0}), BadInput);
    EXPECT_THROW(network::upstream_of(net, 2), BadParameter);
    EXPECT_THROW(network::downstream_of(net, no_arc), BadParameter);
    EXPECT_THROW(network::select(net, {0, 7}), BadParameter);
    EXPECT_EQ(network::select(net, {}).node_count(), 0U);
    StreamNetwork const circle = test::network_of({{0.0, 0.0}, {10.0, 0.0}}, {{0, 1}, {1, 0}});
    EXPECT_THROW(network::downstream_of(circle, 0), BadInput);
    EXPECT_EQ(network::upstream_of(circle, 0), (std::vector<ArcId>{0, 1}));
}

} // namespace select_test
