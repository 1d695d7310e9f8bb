// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/import/from_file.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <measure/trees.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/network/order/order.hpp>

namespace from_file_test {

using namespace thalweg;
using network::from_file;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Two rivers that meet, ids with gaps and out of order.
NetworkFile y_shape() {
    NetworkFile file;
    file.nodes = {{40, {0, 0, 0}}, {7, {0, 10, 1}}, {8, {-5, 20, 2}}, {9, {5, 20, 3}}};
    file.arcs = {{30, 7, 40, 0, 2, 2, 1, {{0, 10, 1}, {0, 0, 0}}},
                 {20, 9, 7, 30, 1, 1, 1, {{5, 20, 3}, {4, 15, 2.5}, {0, 10, 1}}},
                 {10, 8, 7, 30, 1, 1, 1, {{-5, 20, 2}, {0, 10, 1}}}};
    file.arcs[0].us_area_m2 = 17.5;
    file.arcs[0].braided = true;
    file.arcs[1].type = "C4";
    file.arcs[1].feature = 123;
    file.arcs[1].persistence = 4.5;
    return file;
}

} // namespace

TEST(FromFile, FirstFaultIsNamed) {
    auto const broken = [](auto breaks, std::string const& words) {
        NetworkFile file = y_shape();
        breaks(file);
        EXPECT_TRUE(test::refused(
            "network.from_file", [&] { from_file(file); }, words));
    };
    broken([](NetworkFile& f) { f = {}; }, "no arcs");
    broken([](NetworkFile& f) { f.arcs[1].id = 30; }, "several arcs have the id 30");
    broken([](NetworkFile& f) { f.nodes[1].id = 8; }, "several nodes have the id 8");
    broken([](NetworkFile& f) { f.arcs[1].from_node = 99; }, "arc 20 names node 99");
    broken([](NetworkFile& f) { f.nodes.push_back({50, {9, 9, 9}}); }, "node 50 at (9, 9)");
    broken([](NetworkFile& f) { f.arcs[2].line.front().z = 2.5; }, "arc 10 ends at (-5, 20, 2.5) but its node 8");
    broken([](NetworkFile& f) { f.arcs[2].line = {}; }, "arc 10 has no length");
    broken([](NetworkFile& f) { f.arcs[1].line[1].x = not_a_number; }, "vertex 2 of arc 20");
    broken([](NetworkFile& f) { f.arcs[1].line[1].z = not_a_number; }, "vertex 2 of arc 20");
    broken([](NetworkFile& f) { f.arcs[2].ds_arc = 20; }, "arc 10 says that 20");
    broken(
        [](NetworkFile& f) {
            std::swap(f.arcs[2].from_node, f.arcs[2].to_node);
            std::ranges::reverse(f.arcs[2].line);
        },
        "2 arcs leave the node at (0.000, 10.000)");
    broken(
        [](NetworkFile& f) {
            f.arcs[0].to_node = 8;
            f.arcs[0].line.back() = {-5, 20, 2};
            f.nodes.erase(f.nodes.begin());
        },
        "circle");
    NetworkFile file = y_shape(); // one that says nothing of arcs downstream
    file.says.downstream = false;
    file.arcs[0].ds_arc = 77;
    EXPECT_NO_THROW(from_file(file));
}

TEST(FromFile, WhatTheFileSaysIsKeptInTheOrderOfIds) {
    network::FileNetwork const made = from_file(y_shape());
    EXPECT_EQ(made.arc_ids, (std::vector<std::int64_t>{10, 20, 30}));
    EXPECT_EQ(made.network.planform.outlets(), (std::vector<NodeId>{3}));
    EXPECT_EQ(made.network.arc_z[1], (std::vector<double>{3, 2.5, 1}));
    Arc const& arc = made.network.planform.arc(1);
    EXPECT_EQ(arc.type, "C4");
    EXPECT_EQ(arc.feature, 123);
    EXPECT_EQ(arc.persistence, 4.5);
    EXPECT_EQ(made.us_area_m2[2], 17.5);
    EXPECT_TRUE(std::isnan(made.ds_area_m2[2]));
    EXPECT_EQ(made.braided, (std::vector<std::uint8_t>{0, 0, 1}));
}

TEST(FromFile, RecordsAndSourcesGoWithTheArcs) {
    NetworkFile file = y_shape();
    file.arcs[1].record = 2;
    file.arcs[1].feature = 5;
    network::FileNetwork const made = from_file(file);
    EXPECT_EQ(made.network.planform.arc(1).feature, 5);
    EXPECT_EQ(made.records[1], 2);
    ASSERT_EQ(made.stretches[1].size(), 1U);
    EXPECT_EQ(made.stretches[1][0].feature, 5);
    EXPECT_EQ(made.stretches[1][0].to_m, made.network.planform.length_m(1));
    file.arcs[1].sources = {{5, 0.0, 1.0}, {6, 1.0, 2.0}};
    EXPECT_EQ(from_file(file).stretches[1].size(), 2U);
}

TEST(FromFile, WithoutHeightsAllAreNaN) {
    NetworkFile file = y_shape();
    file.says.heights = false;
    for (auto& arc : file.arcs) {
        for (Vec3& p : arc.line) {
            p.z = not_a_number;
        }
    }
    network::FileNetwork const made = from_file(file);
    EXPECT_TRUE(std::ranges::all_of(made.network.node_z, [](double z) { return std::isnan(z); }));
    EXPECT_TRUE(std::isnan(made.network.arc_z[1][1]));
}

TEST(FromFile, EndsTakeTheHeightsOfNodesThatWereMade) {
    NetworkFile file = y_shape();
    file.says.nodes = false;
    file.arcs[2].line.back().z = 1.25;
    EXPECT_EQ(from_file(file).network.arc_z[0].back(), 1.0);
}

TEST(FromFile, NodesWithoutNumbersAreNumberedAlongTheArcs) {
    NetworkFile file = y_shape();
    file.says.nodes = file.says.ends = false;
    NetworkFile shuffled = file; // as another format might order its features
    std::ranges::reverse(shuffled.arcs);
    std::ranges::reverse(shuffled.nodes);
    for (auto& arc : shuffled.arcs) {
        arc.from_node = 100 - arc.from_node;
        arc.to_node = 100 - arc.to_node;
    }
    for (auto& node : shuffled.nodes) {
        node.id = 100 - node.id;
    }
    EXPECT_EQ(from_file(file).network.planform.from(), (std::vector<NodeId>{0, 2, 1}));
    EXPECT_EQ(from_file(file).network.planform.to(), (std::vector<NodeId>{1, 1, 3}));
    EXPECT_EQ(from_file(shuffled).network.planform.from(), from_file(file).network.planform.from());
    EXPECT_EQ(from_file(shuffled).network.planform.to(), from_file(file).network.planform.to());
}

// Law: what as_file makes of a network is that network again, bit for bit.
TEST(FromFile, UndoesAsFile) {
    ASSERT_TRUE(rc::check([] {
        ElevatedNetwork const rivers =
            random_rivers(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::int64_t>(2, 30),
                          *rc::gen::inRange<std::int64_t>(2, 30), 1.0 / 3.0);
        NetworkFile const file = measure::as_file(rivers, network::order(rivers.planform));
        network::FileNetwork const made = from_file(file);
        RC_ASSERT(made.network.node_z == rivers.node_z);
        RC_ASSERT(made.network.arc_z == rivers.arc_z);
        RC_ASSERT(made.network.planform.from() == rivers.planform.from());
        RC_ASSERT(made.network.planform.to() == rivers.planform.to());
        for (std::size_t a = 0; a < rivers.planform.arc_count(); ++a) {
            RC_ASSERT(made.network.planform.arc(a).line == rivers.planform.arc(a).line);
        }
    }));
}

} // namespace from_file_test
