// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/network_laws.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/measure/laws/fits.hpp>
#include <thalweg/measure/laws/internal/network_laws.hpp>
#include <thalweg/measure/relief/relief.hpp>

#include "dems.hpp"
#include "trees.hpp"

namespace network_laws_test {

using namespace thalweg;
using namespace thalweg::measure;
using measure::horton;
using measure::HortonLaws;

namespace {

using Numbers = std::vector<double>;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Rivers of chance whose areas and heights are made to order.
struct MadeToOrder {
    ElevatedNetwork rivers;
    flow::ContributingAreas areas;
    NetworkOrders orders;

    explicit MadeToOrder(std::uint64_t seed, std::int64_t cols = 24, std::int64_t rows = 60)
        : rivers(random_rivers(seed, cols, rows, 30.0)), orders(orders_of(rivers.planform)) {
        for (std::size_t a = 0; a < rivers.planform.arc_count(); ++a) {
            areas.us_area_m2.push_back(1e5 * static_cast<double>(orders.shreve[a]));
            areas.ds_area_m2.push_back(areas.us_area_m2.back() + 40.0 * rivers.planform.length_m(a));
        }
        areas.node_m2.assign(rivers.planform.node_count(), 0.0);
    }
};

/// By node, the longest way along rivers above it, found by walking down from every source.
Numbers longest_slowly(StreamNetwork const& network, Numbers const& head) {
    Numbers longest(network.node_count(), 0.0);
    for (NodeId n = 0; n < network.node_count(); ++n) {
        if (!network.in(n).empty()) {
            continue;
        }
        double length = head.empty() ? 0.0 : head[n];
        for (NodeId at = n;;) {
            longest[at] = std::max(longest[at], length);
            if (network.out(at) == no_arc) {
                break;
            }
            auto const a = network.out(at);
            length += network.length_m(a);
            at = network.to(a);
        }
    }
    return longest;
}

/// Two straight rivers of these lengths meet at an angle and go on to the west.
StreamNetwork fork(double degrees, double one, double other) {
    NetworkDraft net;
    double const half = degrees / 360.0 * 3.14159265358979323846;
    NodeId const outlet = net.add_node({-100.0, 0.0});
    NodeId const meet = net.add_node({0.0, 0.0});
    NodeId const left = net.add_node({one * std::cos(half), one * std::sin(half)});
    NodeId const right = net.add_node({other * std::cos(half), -other * std::sin(half)});
    net.add_arc(left, meet);
    net.add_arc(right, meet);
    net.add_arc(meet, outlet);
    return net;
}

/// A tree in which two streams of each order meet to one of the next; the stream of order k is 3^k m long and drains
/// 5^k m2.
struct PerfectTree {
    NetworkDraft net;
    Numbers areas;

    explicit PerfectTree(int highest) { grow(net.add_node({0.0, 0.0}), highest); }

private:
    void grow(NodeId below, int order) {
        NodeId const above = net.add_node({0.0, net.nodes[below].at.y + std::pow(3.0, order)});
        net.add_arc(above, below);
        areas.push_back(std::pow(5.0, order));
        for (int k = 0; order > 1 && k < 2; ++k) {
            grow(above, order - 1);
        }
    }
};

/// What the slope of the fitted line is, by the textbook's formula of sums.
double fitted(Numbers const& logarithms) {
    double n = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    for (std::size_t i = 0; i < logarithms.size(); ++i) {
        double const order = static_cast<double>(i + 1);
        n += 1.0;
        x += order;
        y += logarithms[i];
        xx += order * order;
        xy += order * logarithms[i];
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

} // namespace

TEST(LineFit, NeedsTwoPlaces) {
    EXPECT_FALSE(fit_line({}));
    EXPECT_FALSE(fit_line({{1, 2}}));
    EXPECT_FALSE(fit_line({{1, 2}, {1, 3}}));
    auto const two = fit_line({{0, 1}, {2, 5}});
    ASSERT_TRUE(two);
    EXPECT_EQ(two->slope, 2.0);
    EXPECT_EQ(two->intercept, 1.0);
    EXPECT_TRUE(std::isnan(two->r2));
    EXPECT_TRUE(std::isnan(two->slope_error));
    // A point of weight 3 is three points.
    auto const heavy = fit_line({{0, 1}, {2, 4}, {3, 9}}, {1.0, 3.0, 2.0});
    auto const many = fit_line({{0, 1}, {2, 4}, {2, 4}, {2, 4}, {3, 9}, {3, 9}});
    EXPECT_NEAR(heavy->slope, many->slope, 1e-12);
    EXPECT_NEAR(heavy->intercept, many->intercept, 1e-12);
    EXPECT_NEAR(heavy->r2, many->r2, 1e-12);
    EXPECT_NEAR(heavy->slope_error, many->slope_error * 2.0, 1e-12); // but three still, not six
    EXPECT_EQ(fit_line({{0, 1}, {2, 5}, {1, 3}})->r2, 1.0);
    EXPECT_TRUE(std::isnan(fit_line({{0, 1}, {2, 1}, {3, 1}})->r2));
}

TEST(LineFit, AnscombesFirst) { // Anscombe 1973, with the figures published for it
    std::vector<Vec2> const points{{10, 8.04}, {8, 6.95}, {13, 7.58},  {9, 8.81}, {11, 8.33}, {14, 9.96},
                                   {6, 7.24},  {4, 4.26}, {12, 10.84}, {7, 4.82}, {5, 5.68}};
    auto const fit = fit_line(points);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->slope, 0.5001, 5e-5);
    EXPECT_NEAR(fit->intercept, 3.0001, 5e-5);
    EXPECT_NEAR(fit->slope_error, 0.1179, 5e-5);
    EXPECT_NEAR(fit->r2, 0.6665, 5e-5);
}

TEST(PowerLaw, RefusesWhatCannotBe) {
    EXPECT_THROW(fit_power_law({}, {.bins_per_decade = 0}), BadParameter);
    EXPECT_THROW(fit_power_law({}, {.least_places = 0}), BadParameter);
    EXPECT_THROW(fit_power_law({}, {.least_bins = 1}), BadParameter);
}

TEST(PowerLaw, TooFewPlacesHaveNone) {
    EXPECT_FALSE(fit_power_law({}));
    EXPECT_FALSE(fit_power_law(std::vector<AtArea>(50, AtArea{1e6, 2.0}))); // all of one area
    EXPECT_FALSE(fit_power_law(std::vector<AtArea>(50, AtArea{1e6, 0.0})));
    EXPECT_FALSE(fit_power_law({{1e4, 1}, {1e5, 1}, {1e6, 1}, {1e7, 1}})); // one a bin
}

TEST(PowerLaw, IsRecovered) {
    ASSERT_TRUE(rc::check("a power law comes back, whatever the areas, and what has no logarithm is counted", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        double const exponent = static_cast<double>(*evenly(-150, 151)) / 100.0;
        double const coefficient = static_cast<double>(*evenly(1, 1000)) / 100.0;
        auto const count = *evenly<std::uint64_t>(60, 400);
        std::vector<AtArea> places{{0.0, 1.0}, {1.0, 0.0}, {1.0, -3.0}, {not_a_number, 1.0}, {1.0, not_a_number}};
        for (std::uint64_t i = 0; i < count; ++i) {
            double const area = std::pow(10.0, 3.0 + 4.0 * unit(random_word(seed, i)));
            places.push_back({area, coefficient * std::pow(area, exponent)});
        }
        auto const law = fit_power_law(places);
        RC_ASSERT(law.has_value());
        RC_ASSERT(std::fabs(law->exponent - exponent) < 1e-9);
        RC_ASSERT(std::fabs(law->coefficient / coefficient - 1.0) < 1e-8);
        RC_ASSERT(law->exponent_error < 1e-9);
        RC_ASSERT((exponent == 0.0 || law->r2 > 1.0 - 1e-9));
        RC_ASSERT(law->places + law->left_out == static_cast<std::int64_t>(places.size()));
        RC_ASSERT(law->left_out >= 5);
        std::int64_t in_bins = 0;
        for (std::size_t i = 0; i < law->bins.size(); ++i) {
            RC_ASSERT(law->bins[i].places >= 3);
            RC_ASSERT((i == 0 || law->bins[i].area_m2 > law->bins[i - 1].area_m2));
            in_bins += law->bins[i].places;
        }
        RC_ASSERT(in_bins == law->places);
    }));
}

TEST(PowerLaw, EveryBinCountsOnce) {
    // A thousand places of small area off the line weigh as much as three of each larger one.
    std::vector<AtArea> places(1000, AtArea{2e3, 8.0});
    for (double const area : {2e4, 2e5, 2e6}) {
        places.insert(places.end(), 3, AtArea{area, 1.0});
    }
    auto const law = fit_power_law(places);
    ASSERT_TRUE(law);
    // Slope of (0, ln 8), (1, 0), (2, 0), (3, 0) against ln 10: -0.3 ln 8 / ln 10.
    EXPECT_NEAR(law->exponent, -0.3 * std::log(8.0) / std::log(10.0), 1e-12);
}

TEST(Concavity, OneArcHasNone) {
    MadeToOrder one(1, 1, 2);
    ASSERT_EQ(one.rivers.planform.arc_count(), 1U);
    EXPECT_FALSE(concavity(one.rivers, one.areas));
    EXPECT_FALSE(hack(one.rivers.planform, one.areas.ds_area_m2));
    EXPECT_THROW(concavity(one.rivers, {}), BadInput);
    EXPECT_FALSE(concavity({}, {}));
}

TEST(Concavity, IsRecoveredFromRiversThatHaveIt) {
    ASSERT_TRUE(rc::check("S = k A^-theta by construction gives theta to 1e-6; arcs that do not fall are left out", [] {
        MadeToOrder made(*rc::gen::arbitrary<std::uint64_t>());
        double const theta = static_cast<double>(*evenly(-20, 120)) / 100.0;
        for (std::size_t a = 0; a < made.rivers.planform.arc_count(); ++a) {
            double const area = 0.5 * (made.areas.us_area_m2[a] + made.areas.ds_area_m2[a]);
            made.rivers.arc_z[a] = {1.7 * std::pow(area, -theta) * made.rivers.planform.length_m(a), 0.0};
        }
        auto const law = concavity(made.rivers, made.areas);
        RC_ASSERT(law.has_value());
        RC_ASSERT(std::fabs(law->exponent + theta) < 1e-6);
        RC_ASSERT(std::fabs(law->coefficient / 1.7 - 1.0) < 1e-4);
        made.rivers.arc_z[0] = {0.0, 0.0};
        made.rivers.arc_z[1] = {0.0, 1.0};
        auto const without = concavity(made.rivers, made.areas);
        RC_ASSERT(without.has_value());
        RC_ASSERT(std::fabs(without->exponent + theta) < 1e-6);
        RC_ASSERT(without->left_out >= 2);
    }));
}

TEST(Hack, RefusesWhatDoesNotBelongTogether) {
    MadeToOrder const made(3);
    EXPECT_THROW(hack(made.rivers.planform, {}), BadInput);
    EXPECT_THROW(hack(made.rivers.planform, made.areas.ds_area_m2, {1.0}), BadInput);
}

TEST(Hack, IsRecoveredFromRiversThatHaveIt) {
    ASSERT_TRUE(rc::check("A = (L / c)^(1/h) by construction gives h to 1e-6, with and without heads", [] {
        MadeToOrder made(*rc::gen::arbitrary<std::uint64_t>(), 24, 120);
        double const h = static_cast<double>(*evenly(40, 110)) / 100.0;
        Numbers head;
        if (*rc::gen::arbitrary<bool>()) {
            for (NodeId n = 0; n < made.rivers.planform.node_count(); ++n) {
                head.push_back(500.0 * unit(random_word(9, n)));
            }
        }
        Numbers const longest = longest_slowly(made.rivers.planform, head);
        for (std::size_t a = 0; a < made.rivers.planform.arc_count(); ++a) {
            NodeId const from = made.rivers.planform.from(a);
            made.areas.ds_area_m2[a] = std::pow((longest[from] + made.rivers.planform.length_m(a)) / 1.4, 1.0 / h);
        }
        auto const law = hack(made.rivers.planform, made.areas.ds_area_m2, head);
        RC_ASSERT(law.has_value());
        RC_ASSERT(std::fabs(law->exponent - h) < 1e-6);
    }));
}

TEST(Tokunaga, NeedsTwoTerms) {
    EXPECT_FALSE(tokunaga({}));
    EXPECT_FALSE(tokunaga({1.2}));
    EXPECT_FALSE(tokunaga({0.0, 2.5, 0.0}));
}

TEST(Tokunaga, IsRecovered) {
    for (double const a : {0.3, 1.0, 1.2, 4.0}) {
        for (double const c : {0.8, 1.0, 2.0, 2.7}) {
            auto const law = tokunaga({a, a * c, a * c * c, 0.0, a * c * c * c * c});
            ASSERT_TRUE(law);
            EXPECT_NEAR(law->a, a, 1e-12 * a);
            EXPECT_NEAR(law->c, c, 1e-12);
            EXPECT_EQ(law->terms, 4);
        }
    }
}

TEST(LinkLengths, NoneAndOne) {
    LinkLengths const none = link_lengths({});
    EXPECT_EQ(none.exterior.links + none.interior.links, 0);
    EXPECT_TRUE(std::isnan(none.exterior.mean_m));
    EXPECT_FALSE(none.ratio);
    LinkLengths const one = link_lengths(random_rivers(1, 1, 5, 2.0).planform);
    EXPECT_EQ(one.exterior.links, 1);
    EXPECT_EQ(one.exterior.mean_m, 8.0);
    EXPECT_EQ(one.exterior.median_m, 8.0);
    EXPECT_EQ(one.exterior.cv, 0.0);
    EXPECT_FALSE(one.ratio);
}

TEST(LinkLengths, ArcsThatMeetOneToOneAreOneLink) {
    NetworkDraft net = fork(60.0, 30.0, 50.0).draft();
    NodeId const outlet = 0;
    NodeId const sea = net.add_node({-150.0, 0.0});
    net.add_arc(outlet, sea);
    LinkLengths const lengths = link_lengths(net);
    EXPECT_EQ(lengths.exterior.links, 2);
    EXPECT_NEAR(lengths.exterior.mean_m, 40.0, 1e-12);
    EXPECT_NEAR(lengths.exterior.median_m, 40.0, 1e-12);
    EXPECT_NEAR(lengths.exterior.cv, 0.25, 1e-12);
    EXPECT_EQ(lengths.interior.links, 1);
    EXPECT_EQ(lengths.interior.mean_m, 150.0);
    EXPECT_NEAR(lengths.ratio.value(), 40.0 / 150.0, 1e-12);
}

TEST(JunctionAngles, RefusesNoReach) {
    EXPECT_THROW(junction_angles({}, 0.0), BadParameter);
    EXPECT_THROW(junction_angles({}, not_a_number), BadParameter);
    EXPECT_EQ(junction_angles({}, 1.0).junctions, 0);
    EXPECT_TRUE(std::isnan(junction_angles({}, 1.0).mean_deg));
}

TEST(JunctionAngles, AreThoseDrawn) {
    for (double const degrees : {0.5, 45.0, 72.0, 90.0, 135.0, 179.0}) {
        JunctionAngles const angles = junction_angles(fork(degrees, 30.0, 50.0), 20.0);
        EXPECT_EQ(angles.junctions, 1);
        EXPECT_NEAR(angles.mean_deg, degrees, 1e-9);
        EXPECT_EQ(angles.std_deg, 0.0);
    }
    // 30 m hold half of 59 m, not of 61 m.
    EXPECT_EQ(junction_angles(fork(72.0, 30.0, 50.0), 59.0).junctions, 1);
    EXPECT_EQ(junction_angles(fork(72.0, 30.0, 50.0), 61.0).left_out, 1);
}

TEST(JunctionAngles, StairsOfCellsHaveTheDirectionOfTheirChord) {
    // One river comes from the east, the other down stairs of three cells east and one north: atan(1/3) on the whole,
    // where its last step alone says 0 degrees.
    NetworkDraft net;
    NodeId const outlet = net.add_node({-5.0, 0.0});
    NodeId const meet = net.add_node({0.0, 0.0});
    NodeId const east = net.add_node({40.0, 0.0});
    NodeId const stairs = net.add_node({60.0, 20.0});
    Arc steps;
    for (int i = 20; i >= 0; --i) {
        steps.line.push_back({3.0 * i, 1.0 * i});
        if (i > 0) {
            steps.line.push_back({3.0 * i - 2.0, 1.0 * i - 1.0});
        }
    }
    net.add_arc(stairs, meet, steps);
    net.add_arc(east, meet);
    net.add_arc(meet, outlet);
    double const expected = std::atan2(1.0, 3.0) * 180.0 / 3.14159265358979323846;
    EXPECT_NEAR(junction_angles(net, 30.0).mean_deg, expected, 2.0);
    EXPECT_NEAR(junction_angles(net, 1.0).mean_deg, 0.0, 1e-9);
}

TEST(NetworkLaws, AreThoseOfTheirVerbs) {
    MadeToOrder const made(11);
    EXPECT_THROW(network_laws(made.rivers, made.orders, made.areas, {.land_m2 = 0.0, .junction_reach_m = 60.0}),
                 BadParameter);
    EXPECT_THROW(network_laws(made.rivers, made.orders, made.areas, {.land_m2 = 1e6, .junction_reach_m = 0.0}),
                 BadParameter);
    NetworkLaws const laws =
        network_laws(made.rivers, made.orders, made.areas,
                     {.land_m2 = 2e6, .junction_reach_m = 60.0, .head_m = {}, .side_branches = {1.0, 2.0, 4.0}});
    double const length =
        std::accumulate(made.rivers.planform.length_m().begin(), made.rivers.planform.length_m().end(), 0.0);
    EXPECT_NEAR(laws.drainage_density_m, length / 2e6, 1e-15);
    EXPECT_NEAR(laws.tokunaga.value().c, 2.0, 1e-12);
    EXPECT_EQ(laws.hack.value().exponent, hack(made.rivers.planform, made.areas.ds_area_m2)->exponent);
    EXPECT_EQ(laws.junctions.mean_deg, junction_angles(made.rivers.planform, 60.0).mean_deg);
    EXPECT_EQ(laws.links.exterior.mean_m, link_lengths(made.rivers.planform).exterior.mean_m);
    EXPECT_EQ(laws.horton.orders.size(),
              horton(made.rivers.planform, made.orders, made.areas.ds_area_m2).orders.size());
}

TEST(NaturalRanges, SayWhereTheyComeFrom) {
    for (NaturalRange const& range : natural_ranges()) {
        EXPECT_LT(range.low, range.high) << range.law;
        EXPECT_NE(range.source.find_first_of("0123456789"), std::string_view::npos) << range.law; // a year
        EXPECT_EQ(natural_range(range.law), &range);
    }
    EXPECT_EQ(natural_range("colour"), nullptr);
}

TEST(Horton, NoArcsNoLaws) {
    HortonLaws const laws = horton({}, {}, {});
    EXPECT_TRUE(laws.orders.empty());
    EXPECT_FALSE(laws.bifurcation || laws.length || laws.area);
}

TEST(Horton, OneArcIsOneStreamWithoutRatios) {
    PerfectTree const tree(1);
    HortonLaws const laws = horton(tree.net, orders_of(tree.net), tree.areas);
    ASSERT_EQ(laws.orders.size(), 1U);
    EXPECT_EQ(laws.orders[0].order, 1);
    EXPECT_EQ(laws.orders[0].streams, 1);
    EXPECT_EQ(laws.orders[0].length_m, 3.0);
    EXPECT_EQ(laws.orders[0].area_m2, 5.0);
    EXPECT_FALSE(laws.bifurcation || laws.length || laws.area);
}

TEST(Horton, RefusesWhatDoesNotBelongTogether) {
    PerfectTree const tree(2);
    NetworkOrders orders = orders_of(tree.net);
    EXPECT_THROW(horton(tree.net, orders, {}), BadInput);
    EXPECT_THROW(horton(tree.net, {}, tree.areas), BadInput);
    orders.strahler[1] = 0;
    EXPECT_THROW(horton(tree.net, orders, tree.areas), BadInput);
}

TEST(Horton, ThePerfectTreeHasItsRatios) {
    for (int highest = 2; highest < 9; ++highest) {
        PerfectTree const tree(highest);
        HortonLaws const laws = horton(tree.net, orders_of(tree.net), tree.areas);
        ASSERT_EQ(laws.orders.size(), static_cast<std::size_t>(highest));
        for (auto const& o : laws.orders) {
            EXPECT_EQ(o.streams, std::int64_t{1} << (highest - o.order));
            EXPECT_NEAR(o.length_m, std::pow(3.0, o.order), 1e-9);
            EXPECT_NEAR(o.area_m2, std::pow(5.0, o.order), 1e-9);
        }
        EXPECT_NEAR(laws.bifurcation.value().ratio, 2.0, 1e-12);
        EXPECT_NEAR(laws.length.value().ratio, 3.0, 1e-12);
        EXPECT_NEAR(laws.area.value().ratio, 5.0, 1e-12);
        EXPECT_TRUE(highest == 2 ? std::isnan(laws.area->r2) : std::fabs(laws.area->r2 - 1.0) < 1e-12);
        EXPECT_EQ(laws.area->orders, highest);
    }
}

TEST(Horton, AnOrderWithoutAreaIsLeftOutOfTheRatioOfAreas) {
    PerfectTree const tree(3);
    NetworkOrders const orders = orders_of(tree.net);
    Numbers areas = tree.areas;
    for (std::size_t a = 0; a < areas.size(); ++a) {
        areas[a] = orders.strahler[a] == 1 ? 0.0 : areas[a];
    }
    HortonLaws const laws = horton(tree.net, orders, areas);
    EXPECT_EQ(laws.orders[0].area_m2, 0.0);
    EXPECT_NEAR(laws.area.value().ratio, 5.0, 1e-12);
    EXPECT_FALSE(horton(tree.net, orders, Numbers(areas.size(), 0.0)).area.has_value());
}

TEST(Horton, StreamsAreChainsOfEqualOrder) {
    ASSERT_TRUE(rc::check("arcs joined two by two where the order stays give the same streams", [] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const cols = *evenly<std::int64_t>(1, 16);
        auto const rows = *evenly<std::int64_t>(2, 24);
        StreamNetwork const net = random_rivers(seed, cols, rows, 2.0).planform;
        NetworkOrders const orders = orders_of(net);
        std::size_t const arcs = net.arc_count();
        Numbers areas(arcs);
        for (std::size_t a = 0; a < arcs; ++a) {
            areas[a] = static_cast<double>(orders.shreve[a]) * 100.0; // greatest at the end of a chain
        }
        std::vector<std::size_t> chain(arcs);
        std::iota(chain.begin(), chain.end(), std::size_t{0});
        for (std::size_t a = 0; a < arcs; ++a) {
            for (std::size_t b = 0; b < arcs; ++b) {
                if (net.to(a) == net.from(b) && orders.strahler[a] == orders.strahler[b]) {
                    std::size_t const old = chain[a];
                    std::replace(chain.begin(), chain.end(), old, chain[b]);
                }
            }
        }
        struct Stream {
            double length = 0.0;
            double area = 0.0;
        };
        std::map<int, std::map<std::size_t, Stream>> streams;
        for (std::size_t a = 0; a < arcs; ++a) {
            Stream& s = streams[orders.strahler[a]][chain[a]];
            s.length += net.length_m(a);
            s.area = std::max(s.area, areas[a]);
        }
        HortonLaws const laws = horton(net, orders, areas);
        RC_ASSERT(laws.orders.size() == streams.size());
        Numbers counts;
        Numbers lengths;
        for (auto const& o : laws.orders) {
            auto const& slow = streams.at(o.order);
            double length = 0.0;
            double area = 0.0;
            for (auto const& [number, s] : slow) {
                length += s.length;
                area += s.area;
            }
            auto const n = static_cast<double>(slow.size());
            RC_ASSERT(o.streams == static_cast<std::int64_t>(slow.size()));
            RC_ASSERT(std::fabs(o.length_m - length / n) < 1e-9 * length);
            RC_ASSERT(o.area_m2 == area / n);
            counts.push_back(std::log(n));
            lengths.push_back(std::log(o.length_m));
        }
        RC_ASSERT(laws.bifurcation.has_value() == (counts.size() > 1));
        if (laws.bifurcation) {
            RC_ASSERT(std::fabs(laws.bifurcation->ratio - std::exp(-fitted(counts))) < 1e-9);
            RC_ASSERT(std::fabs(laws.length->ratio - std::exp(fitted(lengths))) < 1e-9);
        }
    }));
}

} // namespace network_laws_test
