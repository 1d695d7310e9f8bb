// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/split_confluences.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <measure/trees.hpp>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/network/order/order.hpp>

namespace split_confluences_test {

using namespace thalweg;
using network::split_confluences;

namespace {

/// Rivers that meet in one point, evenly around it, and leave it to the south; or none leaves.
ElevatedNetwork star(int rivers, bool outlet_in_the_middle, double reach_m = 100.0, double leaving_m = 100.0) {
    ElevatedNetwork made;
    NetworkDraft plan;
    auto const node = [&](Vec2 at, double z) {
        made.node_z.push_back(z);
        return plan.add_node(at);
    };
    auto const arc = [&](NodeId from, NodeId to) {
        made.arc_z.push_back({made.node_z[from], made.node_z[to]});
        plan.add_arc(from, to);
    };
    Vec2 const middle{4000000.1, 500000.7};
    NodeId const centre = node(middle, 10.0);
    for (int i = 1; i <= rivers; ++i) {
        double const angle = 2.0 * std::numbers::pi * i / (rivers + 1) - std::numbers::pi / 2.0;
        arc(node({middle.x + reach_m * std::cos(angle), middle.y + reach_m * std::sin(angle)}, 10.0 + i), centre);
    }
    if (!outlet_in_the_middle) {
        arc(centre, node({middle.x, middle.y - leaving_m}, 0.0));
    }
    made.plan = std::move(plan);
    return made;
}

/// Random rivers in which nodes were merged, so that more than two arcs meet: short arcs are contracted to their lower
/// end wherever nothing crosses, that is where the arc is one segment and its upper node has arcs upstream.
ElevatedNetwork merged_rivers(std::uint64_t seed, std::int64_t cols, std::int64_t rows, double share,
                              double spacing_m) {
    ElevatedNetwork const rivers = random_rivers(seed, cols, rows, spacing_m);
    std::vector<NodeId> goes_to(rivers.plan.node_count());
    for (NodeId n = 0; n < goes_to.size(); ++n) {
        goes_to[n] = n;
    }
    std::vector<std::uint8_t> gone(rivers.plan.arc_count(), 0);
    std::vector<std::uint8_t> touched(rivers.plan.node_count(), 0);
    for (std::size_t a = 0; a < rivers.plan.arc_count(); ++a) {
        NodeId const from = rivers.plan.from(a);
        NodeId const to = rivers.plan.to(a);
        bool const wanted = static_cast<double>(random_word(seed, 1000 + a) % 1000) < 1000.0 * share;
        if (wanted && rivers.arc_z[a].size() == 2 && !rivers.plan.in(from).empty() && touched[from] == 0 &&
            touched[to] == 0) {
            gone[a] = 1;
            goes_to[from] = to;
            touched[from] = touched[to] = 1;
        }
    }
    ElevatedNetwork made;
    NetworkDraft plan;
    std::vector<NodeId> number(goes_to.size());
    for (NodeId n = 0; n < goes_to.size(); ++n) {
        if (goes_to[n] == n) {
            number[n] = plan.add_node(rivers.plan.node(n).at);
            made.node_z.push_back(rivers.node_z[n]);
        }
    }
    for (std::size_t a = 0; a < rivers.plan.arc_count(); ++a) {
        if (gone[a] == 0) {
            NodeId const from = goes_to[rivers.plan.from(a)];
            NodeId const to = goes_to[rivers.plan.to(a)];
            Arc arc = rivers.plan.arc(a);
            arc.feature = static_cast<std::int64_t>(a) + 1;
            std::vector<double> z = rivers.arc_z[a];
            z.back() = rivers.node_z[to];
            plan.add_arc(number[from], number[to], std::move(arc));
            made.arc_z.push_back(std::move(z));
        }
    }
    made.plan = std::move(plan);
    return made;
}

std::size_t most_upstream(StreamNetwork const& network) {
    std::size_t most = 0;
    for (NodeId n = 0; n < network.node_count(); ++n) {
        most = std::max(most, network.in(n).size());
    }
    return most;
}

std::vector<Finding> faults(ElevatedNetwork const& network) {
    return measure::check_topology(measure::as_file(network, network::order(network.plan))).findings;
}

std::string words(std::vector<Finding> const& findings) {
    return findings.empty() ? "" : findings.front().text;
}

/// The sources upstream of each outlet, outlets in their order: what no splitting may change.
std::vector<std::int64_t> sources_by_outlet(StreamNetwork const& network) {
    std::vector<std::int64_t> sources(network.outlets().size() + 1, 0);
    for (NodeId n = 0; n < network.node_count(); ++n) {
        sources[static_cast<std::size_t>(network.basin(n))] += network.in(n).empty() ? 1 : 0;
    }
    return sources;
}

} // namespace

TEST(SplitConfluences, RefusesWhatCannotBe) {
    ElevatedNetwork const network = star(3, false);
    EXPECT_THROW(split_confluences(network, {.max_upstream = 1}), BadParameter);
    EXPECT_THROW(split_confluences(network, {.distance_m = -1.0}), BadParameter);
    EXPECT_THROW(split_confluences(network, {.distance_m = std::numeric_limits<double>::infinity()}), BadParameter);
    ElevatedNetwork without = network;
    without.arc_z.pop_back();
    EXPECT_THROW(split_confluences(without), BadInput);
}

TEST(SplitConfluences, BinaryNetworkStaysAsItIs) {
    ElevatedNetwork const network = star(2, false);
    network::Split const split = split_confluences(network);
    EXPECT_TRUE(split.pieces.empty());
    EXPECT_EQ(split.network.node_z, network.node_z);
    EXPECT_EQ(split.network.arc_z, network.arc_z);
    EXPECT_EQ(most_upstream(split_confluences(star(3, false), {.max_upstream = 3}).network.plan), 3U);
}

TEST(SplitConfluences, ThirdRiverJoinsOneDistanceDownstream) {
    ElevatedNetwork const network = star(3, false);
    network::Split const split = split_confluences(network, {.distance_m = 5.0});
    ASSERT_EQ(split.pieces.size(), 1U);
    EXPECT_EQ(split.pieces[0].of, 3U);
    EXPECT_FALSE(split.pieces[0].upstream);
    EXPECT_EQ(most_upstream(split.network.plan), 2U);
    EXPECT_EQ(words(faults(split.network)), "");
    Vec2 const centre = split.network.plan.node(0).at;
    Vec2 const joined = split.network.plan.node(5).at;
    EXPECT_EQ(joined.x, centre.x);
    EXPECT_NEAR(joined.y, centre.y - 5.0, 1e-9);
    EXPECT_NEAR(split.network.node_z[5], 10.0 - 10.0 * 5.0 / 100.0, 1e-9);
}

TEST(SplitConfluences, ManyRiversAroundAPointAreSplitWhereverTheyLeave) {
    for (int rivers = 3; rivers <= 12; ++rivers) {
        for (bool const outlet : {false, true}) {
            for (double const leaving_m : {100.0, 0.5, 1e-6}) {
                for (int most = 2; most < rivers; most += 3) {
                    ElevatedNetwork const network = star(rivers, outlet, 100.0, leaving_m);
                    network::Split const split = split_confluences(network, {.max_upstream = most, .distance_m = 3.0});
                    EXPECT_LE(most_upstream(split.network.plan), static_cast<std::size_t>(most));
                    EXPECT_EQ(split.pieces.size(), static_cast<std::size_t>(rivers - most));
                    EXPECT_EQ(words(faults(split.network)), "") << rivers << outlet << leaving_m << most;
                    EXPECT_EQ(split.network.plan.outlets().size(), 1U);
                }
            }
        }
    }
}

TEST(SplitConfluences, OutletIsSplitUpstream) {
    network::Split const split = split_confluences(star(3, true), {.distance_m = 5.0});
    ASSERT_EQ(split.pieces.size(), 1U);
    EXPECT_TRUE(split.pieces[0].upstream);
    EXPECT_EQ(split.network.plan.outlets(), (std::vector<NodeId>{0}));
    EXPECT_EQ(split.network.plan.in(0).size(), 2U);
    EXPECT_NEAR(distance(split.network.plan.node(0).at, split.network.plan.node(4).at), 5.0, 1e-9);
}

TEST(SplitConfluences, RiversOnOneSideAreLedAroundTheOthers) {
    // All come from the east within a fan; the river leaves to the west: straight ways would cut across the fan.
    ElevatedNetwork network;
    NetworkDraft plan;
    auto const node = [&](Vec2 at, double z) {
        network.node_z.push_back(z);
        return plan.add_node(at);
    };
    NodeId const centre = node({0.0, 0.0}, 1.0);
    for (double const y : {-0.2, -0.1, 0.0, 0.1, 0.2}) {
        NodeId const source = node({100.0, y}, 5.0);
        network.arc_z.push_back({5.0, 1.0});
        plan.add_arc(source, centre);
    }
    NodeId const outlet = node({-100.0, 0.0}, 0.0);
    network.arc_z.push_back({1.0, 0.0});
    plan.add_arc(centre, outlet);
    network.plan = std::move(plan);
    network::Split const split = split_confluences(network, {.distance_m = 2.0});
    EXPECT_EQ(most_upstream(split.network.plan), 2U);
    EXPECT_EQ(words(faults(split.network)), "");
}

TEST(SplitConfluences, ALevelRiverStaysLevel) {
    ElevatedNetwork network = star(5, true);
    for (auto& z : network.arc_z) {
        z.assign(z.size(), 10.0);
    }
    network.node_z.assign(network.node_z.size(), 10.0);
    for (auto const& z : split_confluences(network, {.distance_m = 5.0}).network.arc_z) {
        EXPECT_TRUE(std::ranges::all_of(z, [](double h) { return h == 10.0; }));
    }
}

// Law: at most so many arcs end in a node; every law of the schema holds after as before; each source keeps its outlet;
// arcs keep numbers and what they carry.
TEST(SplitConfluences, LawsHoldOnRandomRivers) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const cols = *rc::gen::inRange<std::int64_t>(2, 24);
        auto const rows = *rc::gen::inRange<std::int64_t>(2, 24);
        int const most = *rc::gen::inRange(2, 4);
        double const spacing_m = *rc::gen::element(1.0, 0.1, 33.3, 1234.5);
        double const distance_m = spacing_m * *rc::gen::element(0.0, 0.001, 0.3, 1.0, 7.0);
        ElevatedNetwork const network = merged_rivers(seed, cols, rows, 0.7, spacing_m);
        RC_PRE(faults(network).empty());
        network::Split const split = split_confluences(network, {most, distance_m});
        RC_CLASSIFY(!split.pieces.empty(), "split");
        RC_ASSERT(most_upstream(split.network.plan) <= static_cast<std::size_t>(most));
        RC_ASSERT(words(faults(split.network)) == "");
        RC_ASSERT(sources_by_outlet(split.network.plan) == sources_by_outlet(network.plan));
        RC_ASSERT(split.network.plan.arc_count() == network.plan.arc_count() + split.pieces.size());
        RC_ASSERT(split.network.plan.node_count() == network.plan.node_count() + split.pieces.size());
        for (std::size_t a = 0; a < network.plan.arc_count(); ++a) {
            RC_ASSERT(split.network.plan.arc(a).feature == network.plan.arc(a).feature);
        }
        for (std::size_t i = 0; i < split.pieces.size(); ++i) {
            std::size_t const arc = network.plan.arc_count() + i;
            RC_ASSERT(split.network.plan.arc(arc).feature == split.network.plan.arc(split.pieces[i].of).feature);
            RC_ASSERT(split.network.plan.to(split.pieces[i].moved) == network.plan.node_count() + i);
        }
    }));
}

} // namespace split_confluences_test
