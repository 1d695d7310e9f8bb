// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/laws/network_laws.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>

#include "dems.hpp"
#include "trees.hpp"

namespace horton_test {

using namespace thalweg;
using measure::horton;
using measure::HortonLaws;

namespace {

using Numbers = std::vector<double>;

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
        StreamNetwork const net = random_rivers(seed, cols, rows, 2.0).plan;
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

} // namespace horton_test
