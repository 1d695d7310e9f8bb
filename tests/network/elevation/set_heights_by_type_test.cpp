// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/order.hpp>

namespace set_heights_by_type_test {

namespace {

using namespace thalweg;
using network::RiverTypes;
using network::Rosgen;
using network::set_heights_by_type;
using network::SlopeDraw;

RiverTypes all_of(StreamNetwork const& net, Rosgen type) {
    std::size_t const arcs = net.arc_count();
    return {std::vector<Rosgen>(arcs, type), std::vector<std::uint8_t>(arcs, 0)};
}

RiverTypes mixed(StreamNetwork const& net) {
    RiverTypes types = all_of(net, Rosgen::c);
    for (std::size_t a = 0; a < types.type.size(); ++a) {
        types.type[a] = network::rosgen_types[a % network::rosgen_types.size()];
    }
    return types;
}

} // namespace

TEST(SetHeightsByType, RefusesBadNetworksAndTypes) {
    EXPECT_TRUE(set_heights_by_type({}, {}).node_z.empty());
    StreamNetwork const circle = test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}});
    EXPECT_THROW(set_heights_by_type(circle, all_of(circle, Rosgen::a)), BadInput);
    StreamNetwork const nothing = test::network_of({{0, 0}, {0, 0}}, {{1, 0}}); // an arc of no length
    EXPECT_THROW(set_heights_by_type(nothing, all_of(nothing, Rosgen::a)), BadInput);
    EXPECT_THROW(set_heights_by_type(test::chain(3), all_of(test::chain(2), Rosgen::a)), BadInput);
    StreamNetwork const far = test::network_of({{0, 0}, {0, 1e153}}, {{1, 0}});
    EXPECT_EQ(set_heights_by_type(far, all_of(far, Rosgen::a)).node_z[1], 0.07 * 1e153);
}

TEST(SetHeightsByType, OneArcOfEachType) {
    StreamNetwork const net = test::network_of({{0, 0}, {3, 0}}, {{1, 0, {{3, 3}, {0, 3}}}});
    for (Rosgen const type : network::rosgen_types) {
        double const s = network::slope_range(type).usual;
        auto const raised = set_heights_by_type(net, all_of(net, type));
        EXPECT_EQ(raised.node_z, (std::vector<double>{0.0, 9.0 * s})) << name_of(type);
        EXPECT_EQ(raised.arc_z[0].front(), 9.0 * s);
        EXPECT_NEAR(raised.arc_z[0][1], 6.0 * s, 1e-15);
        EXPECT_NEAR(raised.arc_z[0][2], 3.0 * s, 1e-15);
        EXPECT_EQ(raised.arc_z[0].back(), 0.0);
    }
}

TEST(SetHeightsByType, Laws) {
    ASSERT_TRUE(rc::check("outlets at 0, slopes within the class, arcs fall strictly, ends bit for bit", [] {
        StreamNetwork const net =
            test::random_forest(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::size_t>(0, 30),
                                *rc::gen::inRange<std::size_t>(1, 4));
        RiverTypes const types = mixed(net);
        for (SlopeDraw const draw : {SlopeDraw::middle, SlopeDraw::uniform}) {
            auto const raised =
                set_heights_by_type(net, types, {.draw = draw, .seed = *rc::gen::arbitrary<std::uint64_t>()});
            for (NodeId const outlet : net.outlets()) {
                RC_ASSERT(raised.node_z[outlet] == 0.0);
            }
            for (std::size_t a = 0; a < net.arc_count(); ++a) {
                double const fall = raised.node_z[net.from(a)] - raised.node_z[net.to(a)];
                double const slope = fall / net.length_m(a);
                auto const range = network::slope_range(types.type[a]);
                RC_ASSERT(fall > 0.0);
                RC_ASSERT((slope >= range.low - 1e-12) && (slope <= range.high + 1e-12));
                RC_ASSERT((draw == SlopeDraw::uniform) || (std::fabs(slope - range.usual) < 1e-12));
                auto const& z = raised.arc_z[a];
                auto const& line = net.arc(a).line;
                RC_ASSERT(z.size() == line.size());
                RC_ASSERT(z.front() == raised.node_z[net.from(a)]);
                RC_ASSERT(z.back() == raised.node_z[net.to(a)]);
                for (std::size_t i = 1; i < z.size(); ++i) {
                    RC_ASSERT(z[i] <= z[i - 1]);
                    RC_ASSERT(std::fabs(z[i - 1] - z[i] - slope * distance(line[i - 1], line[i])) < 1e-9);
                }
            }
        }
    }));
}

// Of 10 000 arcs the slopes fill the range evenly: chi-squared over 10 classes, its 99.99 % quantile 33.7.
TEST(SetHeightsByType, UniformSlopesFillTheRange) {
    StreamNetwork const net = test::chain(10000);
    auto const range = network::slope_range(Rosgen::a);
    auto const z = set_heights_by_type(net, all_of(net, Rosgen::a), {.draw = SlopeDraw::uniform, .seed = 5}).node_z;
    std::vector<double> count(10, 0.0);
    for (std::size_t n = 1; n < z.size(); ++n) {
        double const share = (z[n] - z[n - 1] - range.low) / (range.high - range.low);
        count[static_cast<std::size_t>(std::clamp(10.0 * share, 0.0, 9.0))] += 1.0;
    }
    double chi_squared = 0.0;
    for (double const c : count) {
        chi_squared += (c - 1000.0) * (c - 1000.0) / 1000.0;
    }
    EXPECT_LT(chi_squared, 33.7);
}

TEST(SetHeightsByType, ChanceBelongsToSeedAndPlace) {
    auto const raise = [](StreamNetwork const& net, std::uint64_t seed) {
        return set_heights_by_type(net, all_of(net, Rosgen::b), {.draw = SlopeDraw::uniform, .seed = seed}).node_z;
    };
    std::vector<Vec2> const at{{0, 0}, {0, 100}, {-60, 180}, {60, 180}};
    auto const z = raise(test::network_of(at, {{2, 1}, {3, 1}, {1, 0}}), 7);
    EXPECT_EQ(raise(test::network_of(at, {{1, 0}, {3, 1}, {2, 1}}), 7), z); // arcs in another order
    auto const pruned = raise(test::network_of({at[0], at[1], at[3]}, {{2, 1}, {1, 0}}), 7);
    EXPECT_EQ(pruned, (std::vector<double>{z[0], z[1], z[3]}));
    EXPECT_NE(raise(test::network_of(at, {{2, 1}, {3, 1}, {1, 0}}), 8), z);
    EXPECT_NE(z[2], z[3]);
    auto const minus = raise(test::network_of({{0, 0}, {-0.0, 9.0}}, {{1, 0}}), 7);
    EXPECT_EQ(raise(test::network_of({{0, 0}, {0.0, 9.0}}, {{1, 0}}), 7), minus);
}

} // namespace set_heights_by_type_test
