// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/rivers/profiles.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/flow/extract_streams.hpp>

#include "../graded_land.hpp"

namespace profiles_test {

using namespace thalweg;
using measure::RiverProfiles;

namespace {

struct Scene {
    GradedLand land;
    RiverProfiles rivers;
};

/// Rivers by D8 that are straight in chi.
Scene graded(std::uint64_t seed, double theta, double k, std::int64_t support = 20) {
    GradedLand land = graded_land(test::frame(120, 120), seed, theta, k);
    auto const streams = flow::extract_streams(land.drainage, land.dem, {support});
    RiverProfiles rivers = measure::river_profiles(flow::reaches_of(streams.network.planform), land.dem, land.drainage);
    return {std::move(land), std::move(rivers)};
}

std::size_t index(std::int64_t place) {
    return static_cast<std::size_t>(place);
}

} // namespace

TEST(RiverProfiles, AreTheD8StreamsOfADem) {
    Scene const scene = graded(3, 0.45, 8.0);
    RiverProfiles const& rivers = scene.rivers;
    flow::FlowField const& drainage = scene.land.drainage;
    double const cell_m = drainage.grid().cell_m;
    ASSERT_GT(rivers.size(), 500U);
    for (std::size_t i = 0; i < rivers.size(); ++i) {
        std::int64_t const cell = rivers.cell[i];
        ASSERT_EQ(rivers.area_m2[i], static_cast<double>(drainage.area_cells[cell]) * cell_m * cell_m);
        if (rivers.receiver[i] < 0) {
            ASSERT_EQ(drainage.receiver(cell), -1);
            continue;
        }
        ASSERT_LT(rivers.receiver[i], static_cast<std::int64_t>(i));
        ASSERT_EQ(rivers.cell[index(rivers.receiver[i])], drainage.receiver(cell));
        ASSERT_NEAR(rivers.step_m[i], cell_m * (is_diagonal(drainage.direction[cell]) ? std::sqrt(2.0) : 1.0), 1e-9);
        ASSERT_GE(rivers.z_m[i], rivers.z_m[index(rivers.receiver[i])]);
    }
}

TEST(RiverProfiles, GradedRiversAreStraightInChi) {
    for (double const theta : {0.3, 0.45, 0.6}) {
        Scene const scene = graded(7, theta, 5.0);
        RiverProfiles const& rivers = scene.rivers;
        auto const chi = measure::chi_along(rivers, theta);
        for (std::size_t i = 0; i < rivers.size(); ++i) { // the slow way
            double sum = 0.0;
            for (std::size_t at = i; rivers.receiver[at] >= 0; at = index(rivers.receiver[at])) {
                sum += rivers.step_m[at] / std::pow(rivers.area_m2[at], theta);
            }
            ASSERT_NEAR(chi[i], sum, 1e-9 * (1.0 + sum));
        }
        auto const fitted = measure::fit_theta(rivers);
        ASSERT_TRUE(fitted.has_value());
        EXPECT_NEAR(fitted->theta, theta, 0.0051);
        EXPECT_GT(fitted->r2, 0.99999);
        auto const k_sn = measure::steepness_along(rivers, chi, {30.0 * scene.land.dem.grid().cell_m});
        for (double const k : k_sn) {
            ASSERT_TRUE(std::isnan(k) || std::fabs(k - 5.0) < 0.01) << k;
        }
        for (measure::ReachProfile const& reach : measure::reach_profiles(rivers, chi)) {
            ASSERT_TRUE(!reach.k_sn || std::fabs(reach.k_sn->slope - 5.0) < 0.01);
        }
        EXPECT_TRUE(measure::knickpoints(rivers, chi, {0.5}).empty());
    }
}

TEST(RiverProfiles, AKnickpointStandsWhereTheUpliftOnceWas) {
    Scene scene = graded(11, 0.45, 5.0);
    RiverProfiles& rivers = scene.rivers;
    auto const chi = measure::chi_along(rivers, 0.45);
    double const front = 0.4 * *std::ranges::max_element(chi); // a wave of erosion has come up to here
    for (std::size_t i = 0; i < rivers.size(); ++i) {
        rivers.z_m[i] = chi[i] < front ? 9.0 * chi[i] : 9.0 * front + 3.0 * (chi[i] - front);
    }
    double const drop = 2.0;
    auto const found = measure::knickpoints(rivers, chi, {drop});
    ASSERT_GT(found.size(), 3U);
    for (measure::Knickpoint const& k : found) {
        // One of both cells around the front, the only break.
        std::int64_t const below = rivers.receiver[k.place];
        std::int64_t const above = rivers.main_in[k.place];
        EXPECT_TRUE(chi[k.place] >= front ? chi[index(below)] < front : chi[index(above)] >= front);
        EXPECT_GE(k.drop_m, drop);
        EXPECT_NEAR(k.k_below, 9.0, 1.5);
        EXPECT_NEAR(k.k_above, 3.0, 1.5);
    }
    EXPECT_TRUE(measure::knickpoints(rivers, chi, {1e6}).empty());
}

TEST(RiverProfiles, DrawnRiversCarryWhatReachesThem) {
    // A plane that falls to the south; a river drawn along row 2 to the east border, and one that joins it.
    Grid const grid = test::frame(10, 6);
    Raster<float> dem(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        dem[i] = static_cast<float>(10 - grid.at(i).row);
    }
    flow::FlowField const drainage = flow::route(dem);
    auto const at = [&](std::int64_t col, std::int64_t row) { return grid.centre({col, row}); };
    flow::Reaches const reaches{
        {{{at(0, 2), at(4, 2)}}, 1, 7}, {{{at(4, 2), at(9, 2)}}, -1, 8}, {{{at(4, 0), at(4, 2)}}, 1, 9}};
    RiverProfiles const rivers = measure::river_profiles(reaches, dem, drainage);
    double const cell_m2 = grid.cell_m * grid.cell_m;
    std::map<std::int64_t, double> area;
    for (std::size_t i = 0; i < rivers.size(); ++i) {
        area[rivers.cell[i]] = rivers.area_m2[i] / cell_m2;
    }
    EXPECT_EQ(rivers.size(), 12U);
    EXPECT_EQ(area[grid.index({0, 2})], 3.0);
    EXPECT_EQ(area[grid.index({3, 2})], 12.0);
    EXPECT_EQ(area[grid.index({4, 1})], 2.0);
    EXPECT_EQ(area[grid.index({4, 2})], 15.0);
    EXPECT_EQ(area[grid.index({9, 2})], 30.0); // D8 would lead it to the south
    auto const reach = measure::reach_profiles(rivers, measure::chi_along(rivers, 0.45));
    EXPECT_EQ(reach[0].cells, 4);
    EXPECT_EQ(reach[1].cells, 6);
    EXPECT_EQ(reach[0].area_m2, 12.0 * cell_m2);
    EXPECT_EQ(reach[2].z_up_m, 10.0);
    EXPECT_EQ(reach[2].z_down_m, 8.0);
    EXPECT_TRUE(reach[2].is_cut); // it begins on the border
    // Level rivers rise nowhere, and nothing falls to fit a concavity index to.
    EXPECT_THROW(measure::chi_along(rivers, 3.0), BadParameter);
    EXPECT_THROW(measure::steepness_along(rivers, {}, {}), BadInput);
    EXPECT_THROW(measure::steepness_along(rivers, measure::chi_along(rivers, 0.4), {0.0}), BadParameter);
    EXPECT_THROW(measure::knickpoints(rivers, measure::chi_along(rivers, 0.4), {0.0}), BadParameter);
    EXPECT_THROW(measure::river_profiles(reaches, Raster<float>(test::frame(9, 6)), drainage), BadInput);
}

TEST(RiverProfiles, RiversThatShareAnOutletKeepTheirOwnAreas) {
    Grid const grid = test::frame(5, 4);
    Raster<float> dem(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) { // a valley to the middle of the south
        dem[i] = static_cast<float>(20 - 3 * grid.at(i).row + 4 * std::abs(grid.at(i).col - 2));
    }
    auto const drainage = flow::route(dem);
    Vec2 const outlet = grid.centre({2, 3});
    flow::Reaches const reaches{{{{grid.centre({0, 2}), grid.centre({1, 3}), outlet}}, -1, 1},
                                {{{grid.centre({2, 0}), outlet}}, -1, 2}};
    RiverProfiles const rivers = measure::river_profiles(reaches, dem, drainage);
    auto const chi = measure::chi_along(rivers, 0.45);
    auto const reach = measure::reach_profiles(rivers, chi);
    EXPECT_EQ(std::ranges::count(rivers.receiver, -1), 1); // one tree
    EXPECT_EQ(reach[0].area_m2 + reach[1].area_m2, rivers.area_m2[0]);
    EXPECT_GT(reach[0].area_m2, 0.0);
    EXPECT_GT(reach[1].area_m2, 0.0);
    EXPECT_EQ(reach[0].chi_down, 0.0);
    EXPECT_EQ(reach[1].chi_down, 0.0);
}

TEST(RiverProfiles, AReachWithinACellCarriesWhatFlowsIn) {
    Grid const grid = test::frame(6, 3);
    Raster<float> dem(grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        dem[i] = static_cast<float>(10 - grid.at(i).col + std::abs(grid.at(i).row - 1));
    }
    Vec2 const node = grid.centre({3, 1});
    Vec2 const below{node.x + 0.1 * grid.cell_m, node.y};
    flow::Reaches const reaches{
        {{{grid.centre({0, 1}), node}}, 1, 1}, {{{node, below}}, 2, 2}, {{{below, grid.centre({5, 1})}}, -1, 3}};
    RiverProfiles const rivers = measure::river_profiles(reaches, dem, flow::route(dem));
    auto const reach = measure::reach_profiles(rivers, measure::chi_along(rivers, 0.45));
    EXPECT_EQ(reach[1].cells, 0);
    EXPECT_EQ(reach[1].area_m2, reach[0].area_m2);
    EXPECT_EQ(reach[1].z_up_m, reach[0].z_down_m);
    EXPECT_EQ(reach[1].chi_up, reach[0].chi_down);
    EXPECT_EQ(reach[1].is_cut, reach[0].is_cut);
    EXPECT_GT(reach[2].area_m2, reach[1].area_m2);
}

TEST(RiverProfiles, WhatIsNoTreeIsRefused) {
    Scene const scene = graded(3, 0.45, 8.0);
    auto const chi = measure::chi_along(scene.rivers, 0.45);
    auto const refuses = [&](auto&& spoil) {
        RiverProfiles spoilt = scene.rivers;
        spoil(spoilt);
        EXPECT_THROW(measure::chi_along(spoilt, 0.45), BadInput);
        EXPECT_THROW(measure::fit_theta(spoilt), BadInput);
        EXPECT_THROW(measure::steepness_along(spoilt, chi), BadInput);
        EXPECT_THROW(measure::reach_profiles(spoilt, chi), BadInput);
        EXPECT_THROW(measure::knickpoints(spoilt, chi), BadInput);
    };
    refuses([](RiverProfiles& r) { r.area_m2.resize(3); });
    refuses([](RiverProfiles& r) { r.receiver[5] = 1000000000; });
    refuses([](RiverProfiles& r) { r.main_in[5] = 1000000000; });
    refuses([](RiverProfiles& r) { r.reach[5] = 1000000000; });
    refuses([](RiverProfiles& r) { r.ds[0] = 1000000000; });
    std::vector<double> unknown = chi;
    unknown[3] = std::nan("");
    EXPECT_THROW(measure::knickpoints(scene.rivers, unknown), BadInput);
}

TEST(RiverProfiles, AnyDrawnRiversFormATree) {
    ASSERT_TRUE(rc::check("receivers first, all water at the outlets, no rise", [] {
        Grid const grid = test::frame(12, 12);
        Raster<float> const dem = rough_dem(grid, *rc::gen::arbitrary<std::uint64_t>());
        flow::FlowField const drainage = flow::route(dem);
        auto const reaches_count = *rc::gen::inRange<std::int64_t>(1, 6);
        auto const any_place = [&] {
            return Vec2{grid.west + *rc::gen::inRange(0, 1201) * 0.01 * grid.cell_m,
                        grid.south() + *rc::gen::inRange(0, 1201) * 0.01 * grid.cell_m};
        };
        flow::Reaches reaches;
        for (std::int64_t r = 0; r < reaches_count; ++r) { // anyone's: they may cross, or end apart
            std::vector<Vec2> line;
            for (int v = *rc::gen::inRange(2, 5); v > 0; --v) {
                line.push_back(any_place());
            }
            reaches.push_back({{line}, *rc::gen::inRange<std::int64_t>(-1, r), r + 1});
        }
        RiverProfiles const rivers = measure::river_profiles(reaches, dem, drainage);
        double outlets_m2 = 0.0;
        for (std::size_t i = 0; i < rivers.size(); ++i) {
            if (rivers.receiver[i] < 0) {
                outlets_m2 += rivers.area_m2[i];
                continue;
            }
            std::size_t const below = index(rivers.receiver[i]);
            RC_ASSERT(below < i);
            RC_ASSERT(rivers.step_m[i] >= 0.0);
            RC_ASSERT(rivers.z_m[below] <= rivers.z_m[i]);
            RC_ASSERT(rivers.area_m2[below] > rivers.area_m2[i]);
        }
        flow::Catchments const catchments = flow::catchments(reaches, drainage);
        double cells = 0.0;
        for (std::int64_t const c : catchments.cells) {
            cells += static_cast<double>(c);
        }
        RC_ASSERT(outlets_m2 == cells * grid.cell_m * grid.cell_m);
    }));
}

} // namespace profiles_test
