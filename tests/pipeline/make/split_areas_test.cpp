// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/file_values.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <thalweg/core/stream_network.hpp>

namespace split_areas_test {

using namespace thalweg;

namespace {

/// Rivers of 10, 20, 30, ... m2 that meet; the river that leaves has their sum and a cell of 1 m2; or none leaves.
struct Star {
    ElevatedNetwork network;
    std::vector<double> us_area_m2;
    std::vector<double> ds_area_m2;
};

Star star(int rivers, bool outlet) {
    Star made;
    NetworkDraft plan;
    auto const node = [&](Vec2 at, double z) {
        made.network.node_z.push_back(z);
        return plan.add_node(at);
    };
    auto const arc = [&](NodeId from, NodeId to, double us, double ds) {
        made.network.arc_z.push_back({made.network.node_z[from], made.network.node_z[to]});
        plan.add_arc(from, to);
        made.us_area_m2.push_back(us);
        made.ds_area_m2.push_back(ds);
    };
    NodeId const centre = node({0.0, 0.0}, 1.0);
    double sum = 1.0;
    for (int i = 1; i <= rivers; ++i) {
        double const x = -50.0 + 100.0 * i / (rivers + 1);
        arc(node({x, 80.0}, 2.0), centre, 5.0 * i, 10.0 * i);
        sum += 10.0 * i;
    }
    if (!outlet) {
        arc(centre, node({0.0, -100.0}, 0.0), sum, sum + 7.0);
    }
    made.network.plan = std::move(plan);
    return made;
}

} // namespace

// Law: what arrives at a node that was made leaves it, and the node that was split keeps its own cell.
TEST(SplitAreas, WhatArrivesLeaves) {
    for (bool const outlet : {false, true}) {
        for (int rivers = 3; rivers <= 7; ++rivers) {
            Star made = star(rivers, outlet);
            network::Split const split = network::split_confluences(made.network, {.distance_m = 2.0});
            pipeline::add_pieces(split.pieces, made.us_area_m2, made.ds_area_m2);
            ASSERT_EQ(made.us_area_m2.size(), split.network.plan.arc_count());
            for (NodeId n = 0; n < split.network.plan.node_count(); ++n) {
                if (split.network.plan.in(n).empty() || split.network.plan.out(n) == no_arc) {
                    continue;
                }
                double arriving = 0.0;
                for (ArcId const a : split.network.plan.in(n)) {
                    arriving += made.ds_area_m2[a];
                }
                double const own = n == 0 ? 1.0 : 0.0;
                EXPECT_DOUBLE_EQ(made.us_area_m2[split.network.plan.out(n)], arriving + own) << n;
            }
            if (outlet) {
                double arriving = 0.0;
                for (ArcId const a : split.network.plan.in(0)) {
                    arriving += made.ds_area_m2[a];
                }
                EXPECT_DOUBLE_EQ(arriving, 5.0 * rivers * (rivers + 1));
            }
        }
    }
}

TEST(SplitAreas, UnknownStaysUnknown) {
    std::vector<double> us{-1.0, -1.0};
    std::vector<double> ds{-1.0, -1.0};
    pipeline::add_pieces({{0, 1, false}, {0, 1, true}}, us, ds);
    EXPECT_EQ(us, (std::vector<double>{-1.0, -1.0, -1.0, -1.0}));
    EXPECT_EQ(ds, us);
}

} // namespace split_areas_test
