// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/set_heights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/order.hpp>

namespace set_heights_test {

namespace {

using namespace thalweg;
using network::GradedParams;
using network::HeightMode;
using network::RiverTypes;
using network::set_heights;
using network::set_heights_by_type;
using network::set_heights_graded;
using network::SlopeDraw;
using test::refused;

/// A hook: the source lies beside its outlet, and the river makes a detour (node 2 is farther out than node 3 above
/// it).
StreamNetwork hook() {
    return test::network_of({{0, 0}, {10, 0}, {10, 10}, {0, 2}, {12, 10}}, {{1, 0}, {2, 1}, {3, 2}, {4, 2}});
}

RiverTypes all_of(StreamNetwork const& net, Rosgen type) {
    std::size_t const arcs = net.arc_count();
    return {std::vector<Rosgen>(arcs, type), std::vector<std::uint8_t>(arcs, 0)};
}

RiverTypes mixed(StreamNetwork const& net) {
    RiverTypes types = all_of(net, Rosgen::c);
    for (std::size_t a = 0; a < types.type.size(); ++a) {
        types.type[a] = rosgen_types[a % rosgen_types.size()];
    }
    return types;
}

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

/// A straight river of 1000 m in this many steps.
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

double const nan_value = std::numeric_limits<double>::quiet_NaN();
double const infinite = std::numeric_limits<double>::infinity();

/// A circle, an arc of no length, and a node that is nowhere.
std::vector<StreamNetwork> const no_forests{test::network_of({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}),
                                            test::network_of({{0, 0}, {0, 0}}, {{1, 0}}),
                                            test::network_of({{0, 0}, {NAN, 0}}, {{1, 0}})};

} // namespace

TEST(SetHeights, RefusesBadParametersAndNetworks) {
    StreamNetwork const net = test::chain(2);
    for (double const slope : {0.0, nan_value, infinite}) {
        EXPECT_THROW(set_heights(net, {HeightMode::straight, slope}), BadParameter);
    }
    for (StreamNetwork const& wrong : no_forests) {
        EXPECT_THROW(set_heights(wrong), BadInput);
        EXPECT_THROW(set_heights_by_type(wrong, all_of(wrong, Rosgen::a)), BadInput);
        std::vector<double> const areas(wrong.arc_count(), 1.0);
        EXPECT_THROW(set_heights_graded(wrong, areas, areas, {.least_area_m2 = 1.0}), BadInput);
    }
    EXPECT_TRUE(set_heights(StreamNetwork()).network.node_z.empty());
}

TEST(SetHeights, ThreeModesOfOneHook) {
    double const s = 0.1;
    auto const straight = set_heights(hook(), {HeightMode::straight, s});
    EXPECT_NEAR(straight.network.node_z[2], 1.41421356, 1e-8);
    EXPECT_DOUBLE_EQ(straight.network.node_z[3], 0.2);
    EXPECT_EQ(straight.report.uphill_arcs, 1);
    EXPECT_DOUBLE_EQ(straight.report.uphill_length_m, std::sqrt(164.0));
    EXPECT_NEAR(straight.report.max_rise_m, 1.41421356 - 0.2, 1e-8);
    EXPECT_EQ(straight.report.lifted, 0);

    auto const repaired = set_heights(hook(), {HeightMode::straight_repaired, s});
    double const lifted = 1.41421356237 + 0.01 * s * std::sqrt(164.0);
    EXPECT_NEAR(repaired.network.node_z[3], lifted, 1e-9);
    EXPECT_EQ(repaired.network.node_z[2], straight.network.node_z[2]);
    EXPECT_EQ(repaired.report.uphill_arcs, 1);
    EXPECT_EQ(repaired.report.lifted, 1);
    EXPECT_NEAR(repaired.report.max_lift_m, lifted - 0.2, 1e-9);
    EXPECT_NEAR(repaired.report.rms_lift_m, lifted - 0.2, 1e-9);

    auto const stream = set_heights(hook(), {HeightMode::along_stream, s});
    EXPECT_NEAR(stream.network.node_z[3], s * (20.0 + std::sqrt(164.0)), 1e-12);
    EXPECT_EQ(stream.report.uphill_arcs, 1);
}

TEST(SetHeights, Laws) {
    ASSERT_TRUE(
        rc::check("every arc falls strictly, no node below straight, ends bit for bit, vertices never rise", [] {
            StreamNetwork const net = test::any_network();
            double const slope = *rc::gen::element(1e-6, 0.087, 3.0);
            auto const straight = set_heights(net, {HeightMode::straight, slope});
            for (HeightMode const mode :
                 {HeightMode::straight, HeightMode::straight_repaired, HeightMode::along_stream}) {
                auto const raised = set_heights(net, {mode, slope});
                auto const& z = raised.network.node_z;
                RC_ASSERT(raised.report.uphill_arcs == straight.report.uphill_arcs);
                for (NodeId const outlet : net.outlets()) {
                    RC_ASSERT(z[outlet] == 0.0);
                }
                for (NodeId n = 0; n < z.size(); ++n) {
                    RC_ASSERT(z[n] >= straight.network.node_z[n]);
                }
                std::int64_t uphill = 0;
                for (std::size_t a = 0; a < net.arc_count(); ++a) {
                    auto const& arc_z = raised.network.arc_z[a];
                    bool const falls = z[net.from(a)] > z[net.to(a)];
                    uphill += falls ? 0 : 1;
                    RC_ASSERT(arc_z.size() == net.arc(a).line.size());
                    RC_ASSERT(arc_z.front() == z[net.from(a)]);
                    RC_ASSERT(arc_z.back() == z[net.to(a)]);
                    double so_far = 0.0;
                    for (std::size_t i = 1; i < arc_z.size(); ++i) {
                        so_far += distance(net.arc(a).line[i - 1], net.arc(a).line[i]);
                        double const linear = arc_z.front() + (arc_z.back() - arc_z.front()) * so_far / net.length_m(a);
                        RC_ASSERT(std::fabs(arc_z[i] - linear) <= 1e-9);
                        if (falls) {
                            RC_ASSERT(arc_z[i] <= arc_z[i - 1]);
                            RC_ASSERT(static_cast<float>(arc_z[i]) <= static_cast<float>(arc_z[i - 1]));
                        }
                    }
                }
                RC_ASSERT(uphill == (mode == HeightMode::straight ? straight.report.uphill_arcs : 0));
            }
        }));
}

TEST(SetHeights, TheRepairIsTheLeastMajorant) {
    ASSERT_TRUE(rc::check("z(u) = max over v downstream of s|v| + 0.01 s length(u, v); along_stream = s length", [] {
        StreamNetwork const net = test::any_network();
        double const slope = 0.087;
        auto const straight = set_heights(net, {HeightMode::straight, slope}).network.node_z;
        auto const repaired = set_heights(net, {HeightMode::straight_repaired, slope});
        auto const stream = set_heights(net, {HeightMode::along_stream, slope}).network.node_z;
        std::int64_t lifted = 0;
        for (NodeId n = 0; n < straight.size(); ++n) {
            double best = straight[n];
            double way = 0.0;
            NodeId at = n;
            while (net.out(at) != no_arc) {
                way += net.length_m(net.out(at));
                at = net.to(net.out(at));
                best = std::max(best, straight[at] + 0.01 * slope * way);
            }
            RC_ASSERT(std::fabs(straight[n] - slope * distance(net.node(n).at, net.node(at).at)) <= 1e-12);
            RC_ASSERT(std::fabs(repaired.network.node_z[n] - best) <= 1e-9);
            RC_ASSERT(std::fabs(stream[n] - slope * way) <= 1e-9 * (1.0 + way));
            lifted += repaired.network.node_z[n] > straight[n] ? 1 : 0;
        }
        RC_ASSERT(repaired.report.lifted == lifted);
    }));
}

TEST(SetHeightsByType, RefusesTypesOfAnotherNetwork) {
    EXPECT_TRUE(set_heights_by_type({}, {}).node_z.empty());
    EXPECT_THROW(set_heights_by_type(test::chain(3), all_of(test::chain(2), Rosgen::a)), BadInput);
    StreamNetwork const far = test::network_of({{0, 0}, {0, 1e153}}, {{1, 0}});
    EXPECT_EQ(set_heights_by_type(far, all_of(far, Rosgen::a)).node_z[1], 0.07 * 1e153);
}

TEST(SetHeightsByType, Laws) {
    ASSERT_TRUE(rc::check("outlets at 0, slopes within the class, arcs fall strictly, ends bit for bit", [] {
        StreamNetwork const net =
            test::random_forest(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange<std::size_t>(0, 30),
                                *rc::gen::inRange<std::size_t>(1, 4));
        RiverTypes const types = mixed(net);
        for (SlopeDraw const draw : {SlopeDraw::middle, SlopeDraw::uniform}) {
            auto const raised =
                set_heights_by_type(net, types, {.draw = draw, .seed = *rc::gen::arbitrary<std::uint64_t>()});
            test::require_heights(raised);
            for (NodeId const outlet : net.outlets()) {
                RC_ASSERT(raised.node_z[outlet] == 0.0);
            }
            for (std::size_t a = 0; a < net.arc_count(); ++a) {
                double const fall = raised.node_z[net.from(a)] - raised.node_z[net.to(a)];
                double const slope = fall / net.length_m(a);
                auto const range = network::slope_range(types.type[a]);
                RC_ASSERT(fall > 0.0);
                RC_ASSERT((slope >= range.low - 1e-12) && (slope <= range.high + 1e-12));
                RC_ASSERT((draw == SlopeDraw::uniform) || (std::fabs(slope - range.usual) < 1e-12));
                auto const& z = raised.arc_z[a];
                auto const& line = net.arc(a).line;
                for (std::size_t i = 1; i < z.size(); ++i) {
                    RC_ASSERT(std::fabs(z[i - 1] - z[i] - slope * distance(line[i - 1], line[i])) < 1e-9);
                }
            }
        }
    }));
}

// Of 10 000 arcs the slopes fill the range evenly: chi-squared over 10 classes, its 99.99 % quantile 33.7.
TEST(SetHeightsByType, UniformSlopesFillTheRange) {
    StreamNetwork const net = test::chain(10000);
    auto const range = network::slope_range(Rosgen::a);
    auto const z = set_heights_by_type(net, all_of(net, Rosgen::a), {.draw = SlopeDraw::uniform, .seed = 5}).node_z;
    std::vector<double> count(10, 0.0);
    for (std::size_t n = 1; n < z.size(); ++n) {
        double const share = (z[n] - z[n - 1] - range.low) / (range.high - range.low);
        count[static_cast<std::size_t>(std::clamp(10.0 * share, 0.0, 9.0))] += 1.0;
    }
    double chi_squared = 0.0;
    for (double const c : count) {
        chi_squared += (c - 1000.0) * (c - 1000.0) / 1000.0;
    }
    EXPECT_LT(chi_squared, 33.7);
}

TEST(SetHeightsByType, RandomSlopesFollowSeedAndPlace) {
    auto const raise = [](StreamNetwork const& net, std::uint64_t seed) {
        return set_heights_by_type(net, all_of(net, Rosgen::b), {.draw = SlopeDraw::uniform, .seed = seed}).node_z;
    };
    std::vector<Vec2> const at{{0, 0}, {0, 100}, {-60, 180}, {60, 180}};
    auto const z = raise(test::network_of(at, {{2, 1}, {3, 1}, {1, 0}}), 7);
    EXPECT_EQ(raise(test::network_of(at, {{1, 0}, {3, 1}, {2, 1}}), 7), z); // arcs in another order
    auto const pruned = raise(test::network_of({at[0], at[1], at[3]}, {{2, 1}, {1, 0}}), 7);
    EXPECT_EQ(pruned, (std::vector<double>{z[0], z[1], z[3]}));
    EXPECT_NE(raise(test::network_of(at, {{2, 1}, {3, 1}, {1, 0}}), 8), z);
    EXPECT_NE(z[2], z[3]);
    auto const minus = raise(test::network_of({{0, 0}, {-0.0, 9.0}}, {{1, 0}}), 7);
    EXPECT_EQ(raise(test::network_of({{0, 0}, {0.0, 9.0}}, {{1, 0}}), 7), minus);
}

TEST(SetHeightsGraded, RefusesBadParametersAndAreas) {
    StreamNetwork const net = test::chain(2);
    std::vector<double> const good{1.0, 2.0};
    for (GradedParams const& wrong :
         {GradedParams{.slope = 0.0, .least_area_m2 = 1.0}, GradedParams{.slope = infinite, .least_area_m2 = 1.0},
          GradedParams{.theta = -0.1, .least_area_m2 = 1.0}, GradedParams{.theta = 1.1, .least_area_m2 = 1.0},
          GradedParams{.least_area_m2 = 0.0}, GradedParams{.least_area_m2 = infinite}}) {
        EXPECT_THROW(set_heights_graded(net, good, good, wrong), BadParameter);
    }
    for (std::vector<double> const& wrong :
         {std::vector<double>{1.0}, {1.0, -1.0}, {1.0, nan_value}, {infinite, 1.0}}) {
        EXPECT_THROW(set_heights_graded(net, wrong, good, {.least_area_m2 = 1.0}), BadInput);
        EXPECT_THROW(set_heights_graded(net, good, wrong, {.least_area_m2 = 1.0}), BadInput);
    }
    EXPECT_EQ(set_heights_graded({}, {}, {}, {.least_area_m2 = 1.0}).steepness, 0.0);
    // No area counts as the least one.
    EXPECT_NEAR(set_heights_graded(test::chain(1), {0.0}, {0.0}, {.least_area_m2 = 1.0}).network.node_z[1], 0.087,
                1e-15);
    StreamNetwork const far = test::network_of({{0, 0}, {1e154, 0}}, {{1, 0}}); // heights beyond doubles
    auto const act = [&] { set_heights_graded(far, {1.0}, {1.0}, {.slope = 1e200, .least_area_m2 = 1.0}); };
    EXPECT_TRUE(refused("network.set_heights_graded", act, "(1e+154, 0)"));
}

TEST(SetHeights, ALongChain) {
    StreamNetwork const net = test::chain(200000);
    EXPECT_EQ(set_heights(net, {HeightMode::along_stream, 1.0}).network.node_z.back(), 2e5);
    EXPECT_DOUBLE_EQ(set_heights(net).network.node_z.back(), 0.087 * 2e5); // five degrees, repaired
    std::vector<double> const areas(200000, 4.0);
    auto const graded = set_heights_graded(net, areas, areas, {.slope = 0.5, .theta = 0.5, .least_area_m2 = 1.0});
    EXPECT_NEAR(graded.network.node_z.back(), 1e5, 1e-6);
    EXPECT_NEAR(graded.steepness, 1.0, 1e-12);
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

TEST(SetHeightsGraded, Laws) {
    ASSERT_TRUE(rc::check("outlets at 0, arcs fall strictly, the main stem's mean slope, flatter with more area", [] {
        StreamNetwork const net = test::any_network();
        Areas const areas = areas_of(net);
        GradedParams const params{.slope = *rc::gen::element(1e-6, 0.087, 3.0),
                                  .theta = *rc::gen::element(0.0, 0.2, 0.45, 1.0),
                                  .least_area_m2 = *rc::gen::element(1e-3, 100.0, 1e9)};
        auto const graded = set_heights_graded(net, areas.us, areas.ds, params);
        test::require_heights(graded.network);
        auto const& z = graded.network.node_z;
        for (NodeId const outlet : net.outlets()) {
            RC_ASSERT(z[outlet] == 0.0);
        }
        std::vector<double> const way = network::order(net).node_dist_out_m;
        auto const source = static_cast<std::size_t>(std::ranges::max_element(way) - way.begin());
        RC_ASSERT(std::fabs(z[source] / way[source] / params.slope - 1.0) <= 1e-12);
        for (std::size_t a = 0; a < net.arc_count(); ++a) {
            auto const& arc_z = graded.network.arc_z[a];
            auto const& line = net.arc(a).line;
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

} // namespace set_heights_test
