// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/known_heights.hpp>

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

#include "measure/trees.hpp"

namespace lower_rises_test {

using namespace thalweg;
using network::lower_rises;
using network::Lowered;

namespace {

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

} // namespace

TEST(LowerRises, RefusesOtherHeights) {
    EXPECT_THROW(lower_rises(chain({{0, 0}, {1, 0}}), {}), BadInput);
    EXPECT_THROW(lower_rises(chain({{0, 0}, {1, 0}}), {{1}}), BadInput);
}

TEST(LowerRises, WhatFallsStays) {
    Lowered const lowered = lower_rises(chain({{0, 0}, {1, 0}, {2, 0}}), {{3, 2}, {2, 2}});
    EXPECT_EQ(lowered.network.arc_z, (std::vector<std::vector<double>>{{3, 2}, {2, 2}}));
    EXPECT_EQ(lowered.network.node_z, (std::vector<double>{3, 2, 2}));
    EXPECT_EQ(lowered.by_m, (std::vector<double>{0, 0}));
}

TEST(LowerRises, WhatLiesDownstreamComesDown) {
    Lowered const lowered = lower_rises(chain({{0, 0}, {1, 0}, {2, 0}}), {{3, 1}, {2, 5}});
    EXPECT_EQ(lowered.network.arc_z, (std::vector<std::vector<double>>{{3, 1}, {1, 1}}));
    EXPECT_EQ(lowered.network.node_z, (std::vector<double>{3, 1, 1}));
    EXPECT_EQ(lowered.by_m, (std::vector<double>{0, 4}));
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

} // namespace lower_rises_test
