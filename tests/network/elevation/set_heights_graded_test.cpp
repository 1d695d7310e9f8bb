// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace set_heights_graded_test {

namespace {

using namespace thalweg;
using network::GradedParams;
using network::set_heights_graded;
using test::has;
using test::message_of;

struct Areas {
    std::vector<double> us;
    std::vector<double> ds;
};

/// 10 m2 at every source, and per metre of river.
Areas areas_of(StreamNetwork const& net) {
    std::vector<double> node(net.node_count(), 10.0);
    Areas areas{std::vector<double>(net.arc_count()), std::vector<double>(net.arc_count())};
    for (auto n = net.upstream_order().rbegin(); n != net.upstream_order().rend(); ++n) {
        if (net.out(*n) != no_arc) {
            auto const a = net.out(*n);
            areas.us[a] = node[*n];
            areas.ds[a] = node[*n] + 10.0 * net.length_m(a);
            node[net.to(a)] += areas.ds[a];
        }
    }
    return areas;
}

/// A straight river of 1000 m in so many steps.
StreamNetwork straight(int steps) {
    test::Reach reach{1, 0};
    for (int i = 1; i < steps; ++i) {
        reach.between.push_back({1000.0 - 1000.0 * i / steps, 0.0});
    }
    return test::network_of({{0, 0}, {1000, 0}}, {reach});
}

/// Mean of A^-theta between two areas in closed form.
double closed_mean(double a, double b, double theta) {
    return theta == 1.0 ? std::log(b / a) / (b - a)
                        : (std::pow(b, 1.0 - theta) - std::pow(a, 1.0 - theta)) / ((1.0 - theta) * (b - a));
}

} // namespace

TEST(SetHeightsGraded, RefusesBadParametersNetworksAndAreas) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    double const inf = std::numeric_limits<double>::infinity();
    StreamNetwork const net = test::chain(2);
    std::vector<double> const good{1.0, 2.0};
    for (GradedParams const& wrong :
         {GradedParams{.slope = 0.0, .least_area_m2 = 1.0}, GradedParams{.slope = nan, .least_area_m2 = 1.0},
          GradedParams{.slope = inf, .least_area_m2 = 1.0}, GradedParams{.theta = -0.1, .least_area_m2 = 1.0},
          GradedParams{.theta = 1.1, .least_area_m2 = 1.0}, GradedParams{.theta = nan, .least_area_m2 = 1.0},
          GradedParams{.least_area_m2 = 0.0}, GradedParams{.least_area_m2 = inf}, GradedParams{.least_area_m2 = nan}}) {
        EXPECT_THROW(set_heights_graded(net, good, good, wrong), BadParameter);
    }
    for (std::vector<double> const& wrong : {std::vector<double>{1.0}, {1.0, -1.0}, {1.0, nan}, {inf, 1.0}}) {
        EXPECT_THROW(set_heights_graded(net, wrong, good, {.least_area_m2 = 1.0}), BadInput);
        EXPECT_THROW(set_heights_graded(net, good, wrong, {.least_area_m2 = 1.0}), BadInput);
    }
    EXPECT_THROW(
        set_heights_graded(test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}), good, good, {.least_area_m2 = 1.0}),
        BadInput);
    EXPECT_THROW(set_heights_graded(test::network_of({{0, 0}, {0, 0}}, {{1, 0}}), {1.0}, {1.0}, {.least_area_m2 = 1.0}),
                 BadInput);
    auto const none = set_heights_graded({}, {}, {}, {.least_area_m2 = 1.0});
    EXPECT_TRUE(none.network.node_z.empty());
    EXPECT_EQ(none.steepness, 0.0);
    // No area at all counts as the least one.
    EXPECT_NEAR(set_heights_graded(test::chain(1), {0.0}, {0.0}, {.least_area_m2 = 1.0}).network.node_z[1], 0.087,
                1e-15);
}

TEST(SetHeightsGraded, OneRiverIsTheIntegralOfItsLaw) {
    StreamNetwork const net = straight(50);
    for (double const theta : {0.0, 0.3, 0.45, 0.999999, 1.0}) {
        for (double const ds : {100.0, 100.0001, 149.0, 1e4, 1e10}) {
            auto const graded =
                set_heights_graded(net, {100.0}, {ds}, {.slope = 0.02, .theta = theta, .least_area_m2 = 1.0});
            auto const& z = graded.network.arc_z[0];
            EXPECT_DOUBLE_EQ(z.front(), 20.0);
            EXPECT_EQ(z.back(), 0.0);
            if (ds < 101.0 || theta == 0.999999) { // where the closed form loses its digits
                continue;
            }
            for (std::size_t i = 1; i < z.size() - 1; ++i) {
                double const share = static_cast<double>(i) / 50.0;
                double const here = 100.0 + (ds - 100.0) * share;
                double const wanted =
                    20.0 * (1.0 - share) * closed_mean(here, ds, theta) / closed_mean(100.0, ds, theta);
                EXPECT_NEAR(z[i], wanted, 1e-11 * 20.0) << theta << " " << ds << " " << i;
            }
        }
    }
    // Nearly level areas: slopes nearly level.
    auto const z = set_heights_graded(net, {100.0}, {100.0001}, {.slope = 0.02, .theta = 1.0, .least_area_m2 = 1.0})
                       .network.arc_z[0];
    for (std::size_t i = 1; i < z.size(); ++i) {
        EXPECT_NEAR(z[i - 1] - z[i], 0.4, 0.4 * 1e-6);
    }
}

TEST(SetHeightsGraded, WithinAnArcTheProfileIsConcave) {
    auto const z = set_heights_graded(straight(40), {1.0}, {1e5}, {.least_area_m2 = 1.0}).network.arc_z[0];
    for (std::size_t i = 2; i < z.size(); ++i) {
        EXPECT_LT(z[i - 1] - z[i], z[i - 2] - z[i - 1]);
        EXPECT_LT(z[i], z[i - 1]);
    }
}

TEST(SetHeightsGraded, WithoutConcavityItIsTheSlopeAlongTheStream) {
    ASSERT_TRUE(rc::check("theta 0 = along_stream", [] {
        StreamNetwork const net = test::any_network();
        Areas const areas = areas_of(net);
        auto const graded =
            set_heights_graded(net, areas.us, areas.ds, {.slope = 0.05, .theta = 0.0, .least_area_m2 = 1.0});
        auto const stream = network::set_heights(net, {network::HeightMode::along_stream, 0.05}).network;
        RC_ASSERT(std::fabs(graded.steepness - 0.05) <= 1e-12);
        for (std::size_t n = 0; n < stream.node_z.size(); ++n) {
            RC_ASSERT(std::fabs(graded.network.node_z[n] - stream.node_z[n]) <= 1e-10 * (1.0 + stream.node_z[n]));
        }
        for (std::size_t a = 0; a < stream.arc_z.size(); ++a) {
            for (std::size_t i = 0; i < stream.arc_z[a].size(); ++i) {
                RC_ASSERT(std::fabs(graded.network.arc_z[a][i] - stream.arc_z[a][i]) <=
                          1e-10 * (1.0 + stream.arc_z[a][i]));
            }
        }
    }));
}

TEST(SetHeightsGraded, Laws) {
    ASSERT_TRUE(rc::check("outlets at 0, arcs fall strictly, the main stem's mean slope, flatter with more area", [] {
        StreamNetwork const net = test::any_network();
        Areas const areas = areas_of(net);
        GradedParams const params{.slope = *rc::gen::element(1e-6, 0.087, 3.0),
                                  .theta = *rc::gen::element(0.0, 0.2, 0.45, 1.0),
                                  .least_area_m2 = *rc::gen::element(1e-3, 100.0, 1e9)};
        auto const graded = set_heights_graded(net, areas.us, areas.ds, params);
        auto const& z = graded.network.node_z;
        for (NodeId const outlet : net.outlets()) {
            RC_ASSERT(z[outlet] == 0.0);
        }
        std::vector<double> way(z.size(), 0.0);
        for (NodeId const n : net.upstream_order()) {
            if (net.out(n) != no_arc) {
                auto const a = net.out(n);
                way[n] = way[net.to(a)] + net.length_m(a);
            }
        }
        auto const source = static_cast<std::size_t>(std::ranges::max_element(way) - way.begin());
        RC_ASSERT(std::fabs(z[source] / way[source] / params.slope - 1.0) <= 1e-12);
        for (std::size_t a = 0; a < net.arc_count(); ++a) {
            auto const& arc_z = graded.network.arc_z[a];
            auto const& line = net.arc(a).line;
            RC_ASSERT(z[net.from(a)] > z[net.to(a)]);
            RC_ASSERT(arc_z.size() == line.size());
            RC_ASSERT(arc_z.front() == z[net.from(a)]);
            RC_ASSERT(arc_z.back() == z[net.to(a)]);
            double const greatest = std::pow(std::max(areas.us[a], double{params.least_area_m2}), -params.theta);
            double const least = std::pow(std::max(areas.ds[a], double{params.least_area_m2}), -params.theta);
            for (std::size_t i = 1; i < arc_z.size(); ++i) {
                double const length = distance(line[i - 1], line[i]);
                double const slope = (arc_z[i - 1] - arc_z[i]) / length / graded.steepness;
                RC_ASSERT(arc_z[i] < arc_z[i - 1]);
                double const rounding = 1e-12 * (1.0 + z[source]) / length / graded.steepness;
                RC_ASSERT((slope <= greatest * (1.0 + 1e-9) + rounding) && (slope >= least * (1.0 - 1e-9) - rounding));
            }
        }
    }));
}

// Of arcs whose area does not change, log slope against log area is a line of slope -theta through log k_s.
TEST(SetHeightsGraded, SlopeAndAreaGiveThetaBack) {
    for (double const theta : {0.1, 0.45, 0.9}) {
        StreamNetwork const net = test::random_forest(3, 60, 2);
        Areas const areas = areas_of(net);
        auto const graded = set_heights_graded(net, areas.us, areas.us, {.theta = theta, .least_area_m2 = 1.0});
        double sum_x = 0.0;
        double sum_y = 0.0;
        double sum_xx = 0.0;
        double sum_xy = 0.0;
        auto const count = static_cast<double>(net.arc_count());
        for (std::size_t a = 0; a < net.arc_count(); ++a) {
            double const fall = graded.network.node_z[net.from(a)] - graded.network.node_z[net.to(a)];
            double const x = std::log(areas.us[a]);
            double const y = std::log(fall / net.length_m(a));
            sum_x += x;
            sum_y += y;
            sum_xx += x * x;
            sum_xy += x * y;
        }
        double const fitted = -(count * sum_xy - sum_x * sum_y) / (count * sum_xx - sum_x * sum_x);
        EXPECT_NEAR(fitted, theta, 1e-9);
        EXPECT_NEAR((sum_y + fitted * sum_x) / count, std::log(graded.steepness), 1e-8);
    }
}

TEST(SetHeightsGraded, ALongChain) {
    std::vector<double> areas(200000, 4.0);
    auto const graded =
        set_heights_graded(test::chain(200000), areas, areas, {.slope = 0.5, .theta = 0.5, .least_area_m2 = 1.0});
    EXPECT_NEAR(graded.network.node_z.back(), 1e5, 1e-6);
    EXPECT_NEAR(graded.steepness, 1.0, 1e-12);
}

TEST(SetHeightsGraded, HeightsBeyondDoublesAreRefusedWithTheirPlace) {
    StreamNetwork const net = test::network_of({{0, 0}, {1e154, 0}}, {{1, 0}});
    EXPECT_TRUE(has(
        message_of<BadInput>([&] { set_heights_graded(net, {1.0}, {1.0}, {.slope = 1e200, .least_area_m2 = 1.0}); }),
        "the node at (1e+154, 0)"));
}

} // namespace set_heights_graded_test
