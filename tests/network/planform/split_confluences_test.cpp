// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/planform/split_confluences.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <measure/trees.hpp>
#include <network/networks.hpp>
#include <network/rivers.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/network/order/order.hpp>
#include <thalweg/network/vectorise/prune.hpp>

namespace split_confluences_test {

using namespace thalweg;
using network::split_confluences;
using test::star;

namespace {

/// A tree on a lattice, in which up to four arcs meet.
ElevatedNetwork lattice_rivers(double spacing_m) {
    test::Lattice const lattice = test::random_lattice(*rc::gen::inRange(20, 100), 0);
    std::vector<Vec2> nodes;
    for (Vec2 const p : lattice.at) {
        nodes.push_back((0.01 * spacing_m) * p);
    }
    std::vector<test::Reach> reaches;
    for (auto const& [from, to] : lattice.edges) {
        reaches.push_back({to, from, {}, static_cast<std::int64_t>(to)});
    }
    StreamNetwork const merged = network::prune(test::network_of(nodes, reaches), {0.3 * spacing_m, spacing_m}).network;
    return test::elevated(merged, network::order(merged).node_dist_out_m);
}

std::size_t most_upstream(StreamNetwork const& network) {
    std::size_t most = 0;
    for (NodeId n = 0; n < network.node_count(); ++n) {
        most = std::max(most, network.in(n).size());
    }
    return most;
}

/// The first fault that the check finds, or "".
std::string fault(ElevatedNetwork const& network) {
    auto const report = measure::check_topology(measure::as_file(network, network::order(network.planform)));
    return report.findings.empty() ? "" : report.findings.front().text;
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
    for (network::SplitParams const& wrong :
         {network::SplitParams{.max_upstream = 1}, {.distance_m = -1.0}, {.distance_m = INFINITY}}) {
        EXPECT_THROW(split_confluences(network, wrong), BadParameter);
    }
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
    EXPECT_EQ(most_upstream(split_confluences(star(3, false), {.max_upstream = 3}).network.planform), 3U);
}

TEST(SplitConfluences, ThirdRiverJoinsOneDistanceDownstream) {
    ElevatedNetwork const network = star(3, false);
    network::Split const split = split_confluences(network, {.distance_m = 5.0});
    ASSERT_EQ(split.pieces.size(), 1U);
    EXPECT_EQ(split.pieces[0].of, 3U);
    EXPECT_FALSE(split.pieces[0].upstream);
    EXPECT_EQ(most_upstream(split.network.planform), 2U);
    EXPECT_EQ(fault(split.network), "");
    Vec2 const centre = split.network.planform.node(0).at;
    Vec2 const joined = split.network.planform.node(5).at;
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
                    EXPECT_LE(most_upstream(split.network.planform), static_cast<std::size_t>(most));
                    EXPECT_EQ(split.pieces.size(), static_cast<std::size_t>(rivers - most));
                    EXPECT_EQ(fault(split.network), "") << rivers << outlet << leaving_m << most;
                    EXPECT_EQ(split.network.planform.outlets().size(), 1U);
                }
            }
        }
    }
}

TEST(SplitConfluences, OutletIsSplitUpstream) {
    network::Split const split = split_confluences(star(3, true), {.distance_m = 5.0});
    ASSERT_EQ(split.pieces.size(), 1U);
    EXPECT_TRUE(split.pieces[0].upstream);
    EXPECT_EQ(split.network.planform.outlets(), (std::vector<NodeId>{0}));
    EXPECT_EQ(split.network.planform.in(0).size(), 2U);
    EXPECT_NEAR(distance(split.network.planform.node(0).at, split.network.planform.node(4).at), 5.0, 1e-9);
}

TEST(SplitConfluences, RiversOnOneSideAreLedAroundTheOthers) {
    // All come from the east within a fan; the river leaves to the west: straight lines would cross the fan.
    std::vector<Vec2> nodes{{0.0, 0.0}, {-100.0, 0.0}};
    std::vector<test::Reach> reaches{{0, 1}};
    for (double const y : {-0.2, -0.1, 0.0, 0.1, 0.2}) {
        nodes.push_back({100.0, y});
        reaches.push_back({nodes.size() - 1, 0});
    }
    ElevatedNetwork const network =
        test::elevated(test::network_of(nodes, reaches), {1.0, 0.0, 5.0, 5.0, 5.0, 5.0, 5.0});
    network::Split const split = split_confluences(network, {.distance_m = 2.0});
    EXPECT_EQ(most_upstream(split.network.planform), 2U);
    EXPECT_EQ(fault(split.network), "");
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

// Law: at most max_upstream arcs end in a node; every law of the schema holds after as before; each source keeps its
// outlet; arcs keep numbers and what they carry.
TEST(SplitConfluences, LawsHoldOnRandomRivers) {
    ASSERT_TRUE(rc::check([] {
        int const most = *rc::gen::element(2, 2, 3);
        double const spacing_m = *rc::gen::element(1.0, 0.1, 33.3, 1234.5);
        double const distance_m = spacing_m * *rc::gen::element(0.0, 0.001, 0.3, 1.0, 7.0);
        ElevatedNetwork const network = lattice_rivers(spacing_m);
        RC_PRE(fault(network).empty());
        network::Split const split = split_confluences(network, {most, distance_m});
        RC_CLASSIFY(!split.pieces.empty(), "split");
        RC_ASSERT(most_upstream(split.network.planform) <= static_cast<std::size_t>(most));
        RC_ASSERT(fault(split.network) == "");
        RC_ASSERT(sources_by_outlet(split.network.planform) == sources_by_outlet(network.planform));
        RC_ASSERT(split.network.planform.arc_count() == network.planform.arc_count() + split.pieces.size());
        RC_ASSERT(split.network.planform.node_count() == network.planform.node_count() + split.pieces.size());
        for (std::size_t a = 0; a < network.planform.arc_count(); ++a) {
            RC_ASSERT(split.network.planform.arc(a).feature == network.planform.arc(a).feature);
        }
        for (std::size_t i = 0; i < split.pieces.size(); ++i) {
            std::size_t const arc = network.planform.arc_count() + i;
            RC_ASSERT(split.network.planform.arc(arc).feature ==
                      split.network.planform.arc(split.pieces[i].of).feature);
            RC_ASSERT(split.network.planform.to(split.pieces[i].moved) == network.planform.node_count() + i);
        }
    }));
}

} // namespace split_confluences_test
