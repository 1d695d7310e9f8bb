// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/file_values.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck/gtest.h>

#include <thalweg/core/stream_network.hpp>
#include <thalweg/network/order/order.hpp>

namespace file_values_test {

using namespace thalweg;
using make::MakeResult;

namespace {

/// The rivers 1 and 2 of a file, which go on as 3.
MakeResult terrain() {
    MakeResult t;
    t.terrain.rivers.network.planform =
        test::network_of({{0, 40}, {40, 40}, {0, 20}, {0, 0}},
                         {{.from = 0, .to = 2, .between = {}, .feature = 1}, {1, 2, {}, 2}, {2, 3, {}, 3}});
    t.terrain.rivers.network.node_z = {4.0, 4.0, 2.0, 0.0};
    t.terrain.rivers.network.arc_z = {{4.0, 2.0}, {4.0, 2.0}, {2.0, 0.0}};
    t.terrain.rivers.orders = network::order(t.terrain.rivers.network.planform);
    t.terrain.water.areas.us_area_m2 = t.terrain.water.areas.ds_area_m2 = {-1.0, -1.0, -1.0};
    t.terrain.water.areas.node_m2 = {-1.0, -1.0, -1.0, -1.0};
    t.planform.file.attributes.columns = {{"name", AttributeTable::Type::text},
                                          {"name_of_the_river", AttributeTable::Type::text}};
    for (std::string const name : {"one", "two", "three", "four", "five"}) {
        t.planform.file.attributes.rows.push_back({name, name});
    }
    t.planform.file.sources =
        make::LineSources(t.terrain.rivers.network.planform, {{{1, 0.0, 20.0}}, {{2, 0.0, 44.72}}, {{3, 0.0, 20.0}}});
    return t;
}

Raster<float> row_of(std::vector<float> const& heights) {
    Raster<float> dem(Grid{static_cast<std::int64_t>(heights.size()), 1, 1.0, 0.0, 1.0, ""});
    for (std::size_t i = 0; i < heights.size(); ++i) {
        dem[static_cast<std::int64_t>(i)] = heights[i];
    }
    return dem;
}

} // namespace

// Law: what arrives at a node that was made leaves it, and the node that was split keeps its own cell.
TEST(SplitAreas, WhatArrivesLeaves) {
    for (bool const outlet : {false, true}) {
        for (int rivers = 3; rivers <= 7; ++rivers) {
            std::vector<double> us; // rivers of 10, 20, 30, ... m2 that meet in a cell of 1 m2
            std::vector<double> ds;
            for (int i = 1; i <= rivers; ++i) {
                us.push_back(5.0 * i);
                ds.push_back(10.0 * i);
            }
            double const sum = 5.0 * rivers * (rivers + 1);
            if (!outlet) {
                us.push_back(sum + 1.0);
                ds.push_back(sum + 8.0);
            }
            network::Split const split = network::split_confluences(test::star(rivers, outlet), {.distance_m = 2.0});
            StreamNetwork const& plan = split.network.planform;
            make::add_pieces(split.pieces, us, ds);
            ASSERT_EQ(us.size(), plan.arc_count());
            for (NodeId n = 0; n < plan.node_count(); ++n) {
                double arriving = n == 0 ? 1.0 : 0.0;
                for (ArcId const a : plan.in(n)) {
                    arriving += ds[a];
                }
                if (!plan.in(n).empty() && plan.out(n) != no_arc) {
                    EXPECT_DOUBLE_EQ(us[plan.out(n)], arriving) << n;
                }
                EXPECT_TRUE(n != 0 || !outlet || arriving == sum + 1.0) << arriving;
            }
        }
    }
}

TEST(SplitAreas, UnknownStaysUnknown) {
    std::vector<double> us{-1.0, -1.0};
    std::vector<double> ds{-1.0, -1.0};
    make::add_pieces({{0, 1, false}, {0, 1, true}}, us, ds);
    EXPECT_EQ(us, (std::vector<double>{-1.0, -1.0, -1.0, -1.0}));
    EXPECT_EQ(ds, us);
}

TEST(UserData, ArcsHaveTheRecordOfTheirFeature) {
    MakeResult t = terrain();
    auto const user = make::user_data(t, t.terrain.rivers.network.planform);
    ASSERT_TRUE(user);
    EXPECT_EQ(user->record, (std::vector<std::int64_t>{1, 2, 3}));
    EXPECT_EQ(user->attributes.rows.size(), 5U);
    ASSERT_EQ(user->sources.size(), 3U);
    EXPECT_EQ(user->sources[2].front().feature, 3);
    // A side valley of the terrain's own has none.
    StreamNetwork const more = test::network_of({{0, 20}, {0, 0}, {70, 0}}, {{0, 1, {}, 3}, {2, 1, {}, 0}});
    auto const beside = make::user_data(t, more);
    ASSERT_TRUE(beside);
    EXPECT_EQ(beside->record, (std::vector<std::int64_t>{3, 0}));
    EXPECT_TRUE(beside->sources[1].empty());
    auto const names = make::shortened_names(t);
    ASSERT_EQ(names.size(), 1U);
    EXPECT_EQ(names[0].name, "name_of_the_river");
    EXPECT_EQ(names[0].in_shapefile, "name_of_th");
    t.planform.file.sources = {}; // as of grown rivers
    EXPECT_FALSE(make::user_data(t, t.terrain.rivers.network.planform));
    EXPECT_TRUE(make::shortened_names(t).empty());
}

TEST(InUnit, ExactFeet) {
    EXPECT_EQ(make::in_unit(row_of({1.5F, -2.0F}), HeightUnit::metre)[1], -2.0F);
    Raster<float> const feet =
        make::in_unit(row_of({0.3048F, 304.8F, -0.3048F, 0.0F, std::nanf("")}), HeightUnit::foot);
    EXPECT_FLOAT_EQ(feet[0], 1.0F);
    EXPECT_FLOAT_EQ(feet[1], 1000.0F); // 304.8 is not a float
    EXPECT_FLOAT_EQ(feet[2], -1.0F);
    EXPECT_EQ(feet[3], 0.0F);
    EXPECT_TRUE(std::isnan(feet[4]));
}

TEST(InUnit, NeighboursOneUlpApartStayApart) {
    std::vector<float> chain{1.99F}; // floats lie closer together here than at 6.53
    for (int i = 0; i < 1000; ++i) {
        chain.push_back(std::nextafterf(chain.back(), 10.0F));
    }
    Raster<float> const feet = make::in_unit(row_of(chain), HeightUnit::foot);
    for (std::int64_t i = 1; i < feet.cells(); ++i) {
        EXPECT_LT(feet[i - 1], feet[i]);
    }
}

RC_GTEST_PROP(InUnit, TheOrderStays, (std::vector<int> numbers)) {
    std::vector<float> heights{0.0F};
    for (int const n : numbers) {
        heights.push_back(static_cast<float>(n % 100000) * 0.37F);
    }
    Raster<float> const dem = row_of(heights);
    Raster<float> const feet = make::in_unit(dem, HeightUnit::foot);
    for (std::int64_t i = 1; i < dem.cells(); ++i) {
        RC_ASSERT((dem[i - 1] < dem[i]) == (feet[i - 1] < feet[i]));
        RC_ASSERT((dem[i - 1] == dem[i]) == (feet[i - 1] == feet[i]));
        RC_ASSERT(std::fabs(static_cast<double>(feet[i]) * 0.3048 - static_cast<double>(dem[i])) < 0.01);
    }
}

} // namespace file_values_test
