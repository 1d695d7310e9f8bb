// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/channels/side_valleys.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/network/channels/channels.hpp>
#include <thalweg/network/elevation/known_heights.hpp>
#include <thalweg/network/planform/carry_outlets.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

namespace side_valleys_test {

using namespace thalweg;
using namespace thalweg::network;

namespace {

/// Rivers, and the terrain in equilibrium with them.
struct Scene {
    ElevatedNetwork rivers;
    Channels channels;
    Raster<float> dem;
    flow::FlowField drainage;
};

Scene scene_of(StreamNetwork const& plan, Grid const& grid, std::uint64_t seed) {
    StreamNetwork const carried = carry_outlets(plan, grid).network;
    ChannelsOfArcs const drawn = channels(carried, grid);
    surface::EquilibriumParams params;
    params.seed = seed;
    surface::EquilibriumTerrain land = surface::equilibrium(drawn.channels, {}, params);
    ShortenedChannels const kept = shorten(carried, drawn, land.shortened);
    Scene scene{elevate_from_dem(kept.network, kept.drawn.channels, land.dem), kept.drawn.channels, land.dem, {}};
    scene.drainage = flow::route(scene.dem);
    return scene;
}

/// A river from the north to the south border, bent, with one tributary.
Scene plain_scene() {
    Grid const grid = test::frame(90, 90);
    return scene_of(test::network_of({{45.5, 80.5}, {50.5, 40.5}, {45.5, 0.5}, {80.5, 60.5}},
                                     {{0, 1, {{40.2, 60.7}}}, {1, 2, {{44.1, 20.3}}}, {3, 1, {{66.6, 44.4}}}}),
                    grid, 5);
}

/// The vertices of given arcs, each once, by place.
std::set<std::pair<double, double>> vertices_of(StreamNetwork const& plan) {
    std::set<std::pair<double, double>> found;
    for (Arc const& arc : plan.arcs()) {
        for (Vec2 const p : arc.is_input ? arc.line : std::vector<Vec2>{}) {
            found.emplace(p.x, p.y);
        }
    }
    return found;
}

void expect_lawful(Scene const& scene, SideValleys const& made, std::int64_t support) {
    StreamNetwork const& plan = made.network.planform;
    test::require_heights(made.network);
    std::int64_t grown = 0;
    double given_m = 0.0;
    std::set<std::int64_t> covered;
    Grid const& grid = scene.dem.grid();
    for (std::size_t a = 0; a < plan.arc_count(); ++a) {
        Arc const& arc = plan.arc(a);
        RC_ASSERT(arc.is_input == (a < plan.arc_count() - static_cast<std::size_t>(made.grown))); // given arcs first
        grown += arc.is_input ? 0 : 1;
        given_m += arc.is_input ? plan.length_m(a) : 0.0;
        std::vector<double> const& z = made.network.arc_z[a];
        RC_ASSERT((arc.is_input || std::ranges::adjacent_find(z, std::ranges::less_equal()) == z.end()));
        for (Vec2 const p : arc.is_input ? std::vector<Vec2>{} : arc.line) {
            covered.insert(grid.index(grid.cell_of(p)));
        }
    }
    RC_ASSERT(grown == made.grown);
    RC_ASSERT(test::meetings_of(plan).empty());
    for (NodeId n = 0; n < plan.node_count(); ++n) {
        RC_ASSERT((plan.out(n) != no_arc || !plan.in(n).empty()));
        RC_ASSERT(plan.basin(n) > 0);
    }

    // Input rivers stay as they were, vertex for vertex.
    auto const before = vertices_of(scene.rivers.planform);
    auto const after = vertices_of(plan);
    RC_ASSERT(std::includes(after.begin(), after.end(), before.begin(), before.end()));
    double length_m = 0.0;
    for (double const one : scene.rivers.planform.length_m()) {
        length_m += one;
    }
    RC_ASSERT(std::fabs(length_m - given_m) <= 1e-6 * length_m);

    // Away from input rivers an arc runs where enough cells drain through, and only there.
    std::set<std::int64_t> near;
    for (Arc const& arc : plan.arcs()) {
        for (Cell const c : arc.is_input ? cells_along(arc.line, grid) : std::vector<Cell>{}) {
            cells_around(grid, c, 3, [&](Cell n) { near.insert(grid.index(n)); });
        }
    }
    for (std::int64_t i = 0; made.left_out == 0 && i < grid.cells(); ++i) {
        bool const away = near.count(i) == 0 && !grid.on_border(grid.at(i));
        if (away && scene.drainage.area_cells[i] >= support) {
            RC_ASSERT(covered.count(i) == 1U);
        }
        if (away && covered.count(i) == 1U) {
            RC_ASSERT(scene.drainage.area_cells[i] >= support);
        }
    }
}

} // namespace

TEST(SideValleys, WithoutEnoughWaterNothingIsAdded) {
    Scene const scene = plain_scene();
    SideValleys const made = side_valleys(scene.rivers, scene.channels, scene.dem, scene.drainage, {1'000'000});
    EXPECT_EQ(made.grown, 0);
    ASSERT_EQ(made.network.planform.arc_count(), scene.rivers.planform.arc_count());
    EXPECT_EQ(made.network.arc_z, scene.rivers.arc_z);
    EXPECT_EQ(made.network.node_z, scene.rivers.node_z);
}

TEST(SideValleys, WhatMakesNoSenseIsRefused) {
    Scene const scene = plain_scene();
    EXPECT_THROW(side_valleys(scene.rivers, scene.channels, scene.dem, scene.drainage, {0}), BadParameter);
    flow::FlowField other = scene.drainage;
    other.area_cells = Raster<flow::CellCount>(test::frame(91, 91));
    EXPECT_THROW(side_valleys(scene.rivers, scene.channels, scene.dem, other), BadInput);
}

TEST(SideValleys, TheyReachTheGivenRivers) {
    Scene const scene = plain_scene();
    SideValleys const made = side_valleys(scene.rivers, scene.channels, scene.dem, scene.drainage, {40});
    EXPECT_GT(made.grown, 20);
    expect_lawful(scene, made, 40);
    // Most of the terrain drains to the outlet of the input rivers, and so do most valleys.
    StreamNetwork const& plan = made.network.planform;
    std::int64_t joined = 0;
    for (std::size_t a = 0; a < plan.arc_count(); ++a) { // the first arc is an input
        joined += !plan.arc(a).is_input && plan.basin(plan.to(a)) == plan.basin(plan.to(0)) ? 1 : 0;
    }
    EXPECT_GT(joined, 10);
}

TEST(SideValleys, LawsOfRandomNetworks) {
    ASSERT_TRUE(rc::check("given rivers stay, grown ones join them, nothing meets but in nodes", [] {
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1'000'000);
        auto const side = *rc::gen::inRange<std::int64_t>(24, 70);
        auto const support = *rc::gen::inRange<std::int64_t>(1, 120);
        StreamNetwork const plan = test::random_skeleton(seed, side);
        RC_PRE(plan.arc_count() > 0);
        Scene const scene = scene_of(plan, test::frame(side, side), seed);
        expect_lawful(scene, side_valleys(scene.rivers, scene.channels, scene.dem, scene.drainage, {support}), support);
    }));
}

} // namespace side_valleys_test
