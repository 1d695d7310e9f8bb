// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/order/pfafstetter.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/order.hpp>

namespace pfafstetter_test {

using namespace thalweg;
using network::order_links;
using network::pfafstetter;

namespace {

using Links = std::vector<std::int64_t>;

/// A random forest whose links are numbered in any order, and areas that grow downstream.
struct Forest {
    Links down;
    std::vector<double> area;
};

Forest any_forest() {
    auto const links = *rc::gen::inRange<std::size_t>(1, 60);
    auto const shift = *rc::gen::inRange<std::size_t>(0, 60);
    bool const known = *rc::gen::arbitrary<bool>();
    Links plain; // each flows into a lower number
    for (std::size_t i = 0; i < links; ++i) {
        plain.push_back(i == 0 ? -1 : *rc::gen::inRange<std::int64_t>(-1, static_cast<std::int64_t>(i)));
    }
    std::vector<double> area(links, 0.0);
    for (std::size_t i = links; i-- > 0;) {
        area[i] += *rc::gen::inRange(1, 20);
        if (plain[i] >= 0) {
            area[static_cast<std::size_t>(plain[i])] += area[i];
        }
    }
    Forest forest{Links(links, -1), std::vector<double>(links, -1.0)};
    auto const at = [&](std::size_t i) { return (i + shift) % links; };
    for (std::size_t i = 0; i < links; ++i) {
        forest.down[at(i)] = plain[i] < 0 ? -1 : static_cast<std::int64_t>(at(static_cast<std::size_t>(plain[i])));
        forest.area[at(i)] = known ? area[i] : -1.0;
    }
    return forest;
}

std::int64_t mouth_of(Links const& down, std::int64_t a) {
    while (down[static_cast<std::size_t>(a)] >= 0) {
        a = down[static_cast<std::size_t>(a)];
    }
    return a;
}

bool flows_through(Links const& down, std::int64_t from, std::int64_t through) {
    for (; from >= 0; from = down[static_cast<std::size_t>(from)]) {
        if (from == through) {
            return true;
        }
    }
    return false;
}

/// What the codes alone say, for different codes of one basin: from the first digit that differs on, those of the lower
/// one are odd, and that digit is the smaller.
bool says_upstream(std::string const& upper, std::string const& lower) {
    std::size_t same = 0;
    while (same < std::min(upper.size(), lower.size()) && upper[same] == lower[same]) {
        ++same;
    }
    if (same == lower.size() || same == upper.size()) {
        return false;
    }
    bool odd = lower[same] < upper[same];
    for (std::size_t k = same; k < lower.size(); ++k) {
        odd = odd && (lower[k] - '0') % 2 == 1;
    }
    return odd;
}

} // namespace

TEST(Pfafstetter, FourLargestTributariesOfABasin) {
    // The stem 0 1 2 3 4 5 and its tributaries 6 to 10, of which 7 is the smallest; 10 has one of its own, 11.
    Links const down{-1, 0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 10};
    std::vector<double> const area{100, 89, 85, 75, 65, 50, 9, 2, 8, 7, 14, 6};
    EXPECT_EQ(pfafstetter(down, area),
              (std::vector<std::string>{"1", "31", "33", "5", "7", "9", "2", "32", "4", "6", "8", "8"}));
    EXPECT_EQ(pfafstetter(down, area, {1})[7], "3");
    EXPECT_EQ(pfafstetter({-1, 0, 1}, {3, 2, 1}), (std::vector<std::string>{"", "", ""}));
    // Three rivers meet: the main stem goes on along the largest, both others are tributaries.
    EXPECT_EQ(pfafstetter({-1, 0, 0, 0}, {9, 2, 4, 3}), (std::vector<std::string>{"1", "2", "5", "4"}));
}

TEST(Pfafstetter, CodesAloneTellWhatFlowsThroughWhat) {
    ASSERT_TRUE(rc::check("Verdin and Verdin's rule", [] {
        auto const [down, area] = any_forest();
        auto const codes = pfafstetter(down, area, {18});
        for (std::int64_t a = 0; a < std::ssize(down); ++a) {
            for (std::int64_t b = 0; b < std::ssize(down); ++b) {
                std::string const& upper = codes[static_cast<std::size_t>(a)];
                std::string const& lower = codes[static_cast<std::size_t>(b)];
                if (mouth_of(down, a) == mouth_of(down, b) && upper != lower) {
                    RC_ASSERT(flows_through(down, a, b) == says_upstream(upper, lower));
                }
            }
        }
    }));
}

TEST(Pfafstetter, RefusesWhatIsNoForest) {
    EXPECT_THROW(pfafstetter({1, 0}, {1, 1}), BadInput);
    EXPECT_THROW(pfafstetter({2, 0}, {1, 1}), BadInput);
    EXPECT_THROW(pfafstetter({-1}, {}), BadInput);
    EXPECT_THROW(pfafstetter({-1}, {1}, {0}), BadParameter);
    EXPECT_THROW(order_links({0}), BadInput);
}

TEST(OrderLinks, CountsAsCountStreams) {
    ASSERT_TRUE(rc::check("streams of each order", [] {
        Links down{-1};
        auto const links = *rc::gen::inRange<std::int64_t>(1, 60);
        for (std::int64_t i = 1; i < links; ++i) {
            down.push_back(*rc::gen::inRange<std::int64_t>(0, i));
        }
        network::LinkOrders const orders = order_links(down);
        network::StreamCounts const counts = network::count_streams(down);
        RC_ASSERT(orders.strahler[0] == counts.order);
        RC_ASSERT(orders.shreve[0] == counts.sources);
        std::vector<std::int64_t> streams(counts.streams.size(), 0);
        for (std::size_t i = 0; i < down.size(); ++i) {
            bool const ends = down[i] < 0 || orders.strahler[static_cast<std::size_t>(down[i])] != orders.strahler[i];
            streams[static_cast<std::size_t>(orders.strahler[i] - 1)] += ends ? 1 : 0;
        }
        RC_ASSERT(streams == counts.streams);
    }));
}

} // namespace pfafstetter_test
