// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/file_values.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <network/networks.hpp>

#include <thalweg/network/order/order.hpp>

namespace user_data_test {

using namespace thalweg;
using pipeline::Made;

namespace {

/// The rivers 1 and 2 of a file, which go on as 3.
Made terrain() {
    Made t;
    t.terrain.rivers.network.plan =
        test::network_of({{0, 40}, {40, 40}, {0, 20}, {0, 0}},
                         {{.from = 0, .to = 2, .between = {}, .feature = 1}, {1, 2, {}, 2}, {2, 3, {}, 3}});
    t.terrain.rivers.network.node_z = {4.0, 4.0, 2.0, 0.0};
    t.terrain.rivers.network.arc_z = {{4.0, 2.0}, {4.0, 2.0}, {2.0, 0.0}};
    t.terrain.rivers.orders = network::order(t.terrain.rivers.network.plan);
    t.terrain.areas.us_area_m2 = t.terrain.areas.ds_area_m2 = {-1.0, -1.0, -1.0};
    t.terrain.areas.node_m2 = {-1.0, -1.0, -1.0, -1.0};
    t.planform.file.attributes.columns = {{"name", AttributeTable::Type::text},
                                          {"name_of_the_river", AttributeTable::Type::text}};
    for (std::string const name : {"one", "two", "three", "four", "five"}) {
        t.planform.file.attributes.rows.push_back({name, name});
    }
    t.planform.file.sources =
        pipeline::LineSources(t.terrain.rivers.network.plan, {{{1, 0.0, 20.0}}, {{2, 0.0, 44.72}}, {{3, 0.0, 20.0}}});
    return t;
}

} // namespace

TEST(UserData, GrownRiversHaveNone) {
    Made t = terrain();
    t.planform.file.sources = {};
    EXPECT_FALSE(pipeline::user_data(t, t.terrain.rivers.network.plan));
    EXPECT_TRUE(pipeline::shortened_names(t).empty());
}

TEST(UserData, ArcsHaveTheRecordOfTheirFeature) {
    Made const t = terrain();
    auto const user = pipeline::user_data(t, t.terrain.rivers.network.plan);
    ASSERT_TRUE(user);
    EXPECT_EQ(user->record, (std::vector<std::int64_t>{1, 2, 3}));
    EXPECT_EQ(user->attributes.rows.size(), 5U);
    ASSERT_EQ(user->sources.size(), 3U);
    EXPECT_EQ(user->sources[2].front().feature, 3);
    // A side valley of the terrain's own has none.
    StreamNetwork const more = test::network_of({{0, 20}, {0, 0}, {70, 0}}, {{0, 1, {}, 3}, {2, 1, {}, 0}});
    auto const beside = pipeline::user_data(t, more);
    ASSERT_TRUE(beside);
    EXPECT_EQ(beside->record, (std::vector<std::int64_t>{3, 0}));
    EXPECT_TRUE(beside->sources[1].empty());
}

TEST(UserData, ShortenedNamesAreThoseOfTheShapefile) {
    auto const names = pipeline::shortened_names(terrain());
    ASSERT_EQ(names.size(), 1U);
    EXPECT_EQ(names[0].name, "name_of_the_river");
    EXPECT_EQ(names[0].in_shapefile, "name_of_th");
}

} // namespace user_data_test
