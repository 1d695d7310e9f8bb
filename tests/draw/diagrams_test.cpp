// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/draw/diagrams.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>

#include "pictures.hpp"
#include "small_land.hpp"

namespace diagrams_test {

using namespace thalweg;
using draw::CurveParams;
using draw::Format;
using draw::ProfileParams;

TEST(Profile, OfNothing) {
    EXPECT_TRUE(test::is_xml(draw::profile({}, {}).bytes));
}

TEST(Profile, RefusesWhatDoesNotFit) {
    test::SmallLand land = test::small_land();
    EXPECT_THROW(draw::profile(land.network, {}), BadInput);
    land.network.arc_z[1][0] = NAN;
    EXPECT_THROW(draw::profile(land.network, land.orders), BadInput);
    land.network.arc_z.pop_back();
    EXPECT_THROW(draw::profile(land.network, land.orders), BadInput);
    ProfileParams params;
    params.height_px = 10;
    EXPECT_THROW(draw::profile({}, {}, params), BadParameter);
}

TEST(Profile, ShowsTheMainStemInEveryFormat) {
    test::SmallLand const land = test::small_land();
    std::string const svg = draw::profile(land.network, land.orders).bytes;
    EXPECT_TRUE(test::is_xml(svg));
    ProfileParams params;
    params.format = Format::png;
    test::Pixels const pixels = test::decode(draw::profile(land.network, land.orders, params).bytes);
    EXPECT_EQ(pixels.width, 1000U);
    EXPECT_EQ(pixels.height, 560U);
    EXPECT_GT(test::river_pixels(pixels), 500U);
    params.format = Format::pdf;
    EXPECT_EQ(draw::profile(land.network, land.orders, params).bytes.substr(0, 5), "%PDF-");
    EXPECT_TRUE(draw::profile(land.network, land.orders).bytes == svg);
}

TEST(Profile, OtherBasinsLeaveNoTrace) {
    test::SmallLand land = test::small_land();
    std::string const alone = draw::profile(land.network, land.orders).bytes;
    StreamNetwork const& plan = land.network.planform;
    NetworkDraft more;
    more.nodes.assign(plan.nodes().begin(), plan.nodes().end());
    for (ArcId arc = 0; arc < plan.arc_count(); ++arc) {
        more.add_arc(plan.from(arc), plan.to(arc));
    }
    more.add_arc(more.add_node({500435, 4499725}), more.add_node({500435, 4499525}));
    land.network.planform = std::move(more);
    land.network.node_z.insert(land.network.node_z.end(), {900, 0});
    land.network.arc_z.push_back({900, 0});
    land.orders = network::order(land.network.planform);
    EXPECT_TRUE(draw::profile(land.network, land.orders).bytes == alone);
}

TEST(Profile, AMainStemOfAnotherNetworkIsRefused) {
    test::SmallLand land = test::small_land();
    land.orders.main_stem.push_back(7);
    EXPECT_THROW(draw::profile(land.network, land.orders), BadInput);
    land.orders.main_stem.clear();
    EXPECT_TRUE(test::is_xml(draw::profile(land.network, land.orders).bytes));
}

TEST(Curve, OfNothingOfOneAndOfNoRise) {
    EXPECT_TRUE(test::is_xml(draw::curve({}).bytes));
    EXPECT_TRUE(test::is_xml(draw::curve({0.1}).bytes));
    EXPECT_TRUE(test::is_xml(draw::curve({0.0, 0.0, 0.0}).bytes));
    EXPECT_TRUE(test::is_xml(draw::curve({1.0, -2.0, 3.0}).bytes));
}

TEST(Curve, RefusesWhatIsNoNumber) {
    EXPECT_THROW(draw::curve({1.0, NAN}), BadInput);
    CurveParams params;
    params.width_px = 9000;
    EXPECT_THROW(draw::curve({1.0}, params), BadParameter);
}

TEST(Curve, TitleIsEscapedAndSizeIsAsAsked) {
    CurveParams params;
    params.increment = "x<3 ? 1 : 2 & \"three\"";
    EXPECT_TRUE(test::is_xml(draw::curve({1.0, 2.0}, params).bytes));
    params.format = Format::png;
    params.width_px = 300;
    params.height_px = 200;
    test::Pixels const pixels = test::decode(draw::curve({1.0, 2.0}, params).bytes);
    EXPECT_EQ(pixels.width, 300U);
    EXPECT_EQ(pixels.height, 200U);
}

} // namespace diagrams_test
