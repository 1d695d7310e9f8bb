// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/river_types.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/order.hpp>

namespace river_types_test {

using namespace thalweg::network;

namespace {

using namespace thalweg;
using network::assign_types;
using network::AssignTypesParams;
using network::TypeChoice;

/// Two sources, a confluence, the outlet at node 0; arcs of 100 m.
StreamNetwork y_river(std::string const& left = "", std::string const& trunk = "") {
    return test::network_of({{0, 0}, {0, 100}, {-60, 180}, {60, 180}},
                            {{2, 1, {}, 7, left}, {3, 1}, {1, 0, {}, 9, trunk}});
}

/// Perfect binary tree of an order.
StreamNetwork binary(int order) {
    std::vector<Vec2> at{{0, 0}, {0, 1}};
    std::vector<test::Reach> reaches{{1, 0}};
    for (std::size_t n = 1; at.size() < std::size_t{1} << static_cast<unsigned>(order); ++n) {
        for (double const side : {-1.0, 1.0}) {
            reaches.push_back({at.size(), n});
            at.push_back({at[n].x + side, at[n].y + 1.0});
        }
    }
    return test::network_of(at, reaches);
}

} // namespace

TEST(AssignTypes, EmptyAndBadInput) {
    EXPECT_TRUE(assign_types({}, {}).type.empty());
    StreamNetwork const net = y_river();
    auto const orders = network::order(net);
    for (AssignTypesParams const& wrong :
         std::vector<AssignTypesParams>{{.by_order = {}}, {.coast_m = -1.0}, {.coast_m = NAN}}) {
        EXPECT_THROW(assign_types(net, orders, wrong), BadParameter);
    }
    EXPECT_THROW(assign_types(net, {}), BadInput);
    EXPECT_THROW(assign_types(net, network::order(test::chain(2))), BadInput);
    EXPECT_THROW(assign_types(test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}), {}), BadInput);
}

TEST(AssignTypes, AnUnknownTypeIsNamedWithItsPlace) {
    for (auto const& [net, words] : std::vector<std::pair<StreamNetwork, std::string>>{
             {y_river("", "da"), "'da', the type of arc 3 (feature 9) at (0.000, 100.000)"},
             {y_river("", "da"), "Did you mean 'DA'?"},
             {y_river("stream"), "'stream', the type of arc 1"}}) {
        EXPECT_TRUE(test::refused(
            "network.assign_types", [&] { assign_types(net, network::order(net)); }, words));
    }
}

TEST(AssignTypes, OwnTypesComeFirst) {
    StreamNetwork const net = y_river("A+", "none");
    auto const types = assign_types(net, network::order(net), {.choice = TypeChoice::one, .one = Rosgen::d});
    EXPECT_EQ(types.type, (std::vector{Rosgen::aa_plus, Rosgen::d, Rosgen::d}));
    EXPECT_EQ(types.braided, (std::vector<std::uint8_t>{0, 1, 1}));
}

TEST(AssignTypes, NearTheCoastIsBraidedAndKeepsItsType) {
    StreamNetwork const net = y_river();
    auto const orders = network::order(net);
    auto const flags = [&](double coast_m) { return assign_types(net, orders, {.coast_m = coast_m}).braided; };
    EXPECT_EQ(flags(0.0), (std::vector<std::uint8_t>{0, 0, 0}));
    EXPECT_EQ(flags(50.0), (std::vector<std::uint8_t>{0, 0, 0}));
    EXPECT_EQ(flags(50.001), (std::vector<std::uint8_t>{0, 0, 1}));
    EXPECT_EQ(flags(150.001), (std::vector<std::uint8_t>{1, 1, 1}));
    EXPECT_EQ(flags(INFINITY), (std::vector<std::uint8_t>{1, 1, 1}));
    EXPECT_EQ(assign_types(net, orders, {.coast_m = 1e9}).type, assign_types(net, orders).type);
}

TEST(AssignTypes, ByOrderFromSteepToFlat) {
    auto const by_order = [](int highest) {
        StreamNetwork const net = binary(highest);
        auto const orders = network::order(net);
        auto const types = assign_types(net, orders);
        std::string names;
        for (int w = 1; w <= highest; ++w) {
            auto const at = std::ranges::find(orders.strahler, w) - orders.strahler.begin();
            names += std::string(name_of(types.type[static_cast<std::size_t>(at)])) + " ";
        }
        return names;
    };
    EXPECT_EQ(by_order(1), "C ");
    EXPECT_EQ(by_order(2), "Aa+ C ");
    EXPECT_EQ(by_order(3), "Aa+ B C ");
    EXPECT_EQ(by_order(4), "Aa+ A B C ");
    EXPECT_EQ(by_order(5), "Aa+ A B B C ");
    EXPECT_EQ(by_order(7), "Aa+ A A B B C C ");
}

TEST(AssignTypes, Laws) {
    ASSERT_TRUE(rc::check("one type an arc; one order, one type; higher orders come later in the table", [] {
        NetworkDraft untyped =
            test::random_forest(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::size_t>(0, 40), 2).draft();
        for (DraftArc& drawn : untyped.arcs) {
            drawn.arc.type.clear();
        }
        StreamNetwork const net(std::move(untyped));
        auto const orders = network::order(net);
        AssignTypesParams params;
        params.by_order = {Rosgen::aa_plus, Rosgen::a, Rosgen::b, Rosgen::c, Rosgen::d, Rosgen::da, Rosgen::e};
        params.by_order.resize(*rc::gen::inRange<std::size_t>(1, 8));
        params.coast_m = *rc::gen::element(0.0, 500.0, 2000.0);
        auto const types = assign_types(net, orders, params);
        RC_ASSERT(types.type.size() == net.arc_count());
        RC_ASSERT(types.braided.size() == net.arc_count());
        int const highest = *std::ranges::max_element(orders.strahler);
        for (std::size_t a = 0; a < net.arc_count(); ++a) {
            for (std::size_t b = 0; b < net.arc_count(); ++b) {
                RC_ASSERT((orders.strahler[a] > orders.strahler[b]) || (types.type[a] <= types.type[b]));
            }
            RC_ASSERT((orders.strahler[a] < highest) || (types.type[a] == params.by_order.back()));
            double const middle = 0.5 * (orders.node_dist_out_m[net.from(a)] + orders.node_dist_out_m[net.to(a)]);
            if (std::fabs(middle - params.coast_m) > 1e-6) {
                bool const braided = middle < params.coast_m || is_braided(types.type[a]);
                RC_ASSERT(types.braided[a] == (braided ? 1 : 0));
            }
        }
    }));
}

TEST(Rosgen, TwoTypesAreBraided) {
    std::string braided;
    for (Rosgen const type : rosgen_types) {
        braided += is_braided(type) ? std::string(name_of(type)) + " " : "";
    }
    EXPECT_EQ(braided, "D DA ");
}

TEST(Rosgen, SlopesAreTheTables) {
    SlopeRange const table[] = {{0.10, 0.20, 0.12},  {0.04, 0.10, 0.07},  {0.02, 0.04, 0.03},
                                {0.001, 0.02, 0.01}, {0.001, 0.04, 0.02}, {0.001, 0.005, 0.003},
                                {0.001, 0.02, 0.01}, {0.001, 0.02, 0.01}, {0.02, 0.04, 0.03}};
    for (std::size_t i = 0; Rosgen const type : rosgen_types) {
        SlopeRange const range = slope_range(type);
        EXPECT_EQ(range.low, table[i].low) << name_of(type);
        EXPECT_EQ(range.high, table[i].high) << name_of(type);
        EXPECT_EQ(range.usual, table[i++].usual) << name_of(type);
    }
}

} // namespace river_types_test
