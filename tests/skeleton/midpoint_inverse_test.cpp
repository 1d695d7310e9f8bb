// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/midpoint_inverse.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

#include "fields.hpp"

namespace midpoint_inverse_test {

using namespace thalweg;
using skeleton::midpoint_inverse;

namespace {

using test::has;
using test::message_of;
using test::on_threads;
using test::same_bits;

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr double endless = std::numeric_limits<double>::infinity();

Skeleton empty(std::int64_t width, std::int64_t height) {
    return {Raster<float>(frame(width, height), none)};
}

std::int64_t known(Skeleton const& skeleton) {
    return std::ranges::count_if(skeleton.z.values(), [](float z) { return !std::isnan(z); });
}

Skeleton any_skeleton(std::int64_t longest) {
    Skeleton skeleton = empty(*rc::gen::inRange<std::int64_t>(1, longest), *rc::gen::inRange<std::int64_t>(1, longest));
    double const share = *rc::gen::element(0.0, 0.01, 0.05, 0.3);
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    for (std::int64_t i = 0; i < skeleton.z.cells(); ++i) {
        auto const words = random_block(seed, static_cast<std::uint64_t>(i));
        if (unit(words[0]) < share) {
            skeleton.z[i] = static_cast<float>(200.0 * unit(words[1]) - 50.0);
        }
    }
    return skeleton;
}

/// The rule as it is printed: known children send height and distance to empty parents, in a square of 2^n + 1.
Skeleton plain_inverse(Skeleton const& skeleton, double longest_cells) {
    std::int64_t whole = 1;
    while (whole + 1 < std::max(skeleton.z.width(), skeleton.z.height())) {
        whole *= 2;
    }
    Skeleton square = empty(whole + 1, whole + 1);
    for (std::int64_t i = 0; i < skeleton.z.cells(); ++i) {
        square.z[skeleton.z.grid().at(i)] = skeleton.z[i];
    }
    struct Sum {
        double heights = 0.0;
        double weights = 0.0;
    };
    for (std::int64_t h = 1; 2 * h <= whole; h *= 2) {
        for (bool const edges : {true, false}) {
            double const d = static_cast<double>(h) * (edges ? 1.0 : std::sqrt(2.0));
            std::map<std::int64_t, Sum> parents;
            for (std::int64_t i = 0; i < square.z.cells(); ++i) {
                Cell const child = square.z.grid().at(i);
                bool const odd_column = child.col % (2 * h) == h;
                bool const odd_row = child.row % (2 * h) == h;
                bool const on_lattice = child.col % h == 0 && child.row % h == 0;
                bool const takes_part = edges ? odd_column != odd_row : odd_column && odd_row;
                if (!on_lattice || !takes_part || std::isnan(square.z[i]) || d > longest_cells) {
                    continue;
                }
                std::vector<Cell> const ways = edges ? std::vector<Cell>{{h, 0}, {-h, 0}, {0, h}, {0, -h}}
                                                     : std::vector<Cell>{{h, h}, {-h, h}, {h, -h}, {-h, -h}};
                for (Cell const way : ways) {
                    Cell const parent{child.col + way.col, child.row + way.row};
                    if (square.z.grid().contains(parent) && std::isnan(square.z[parent])) {
                        Sum& sum = parents[square.z.grid().index(parent)];
                        sum.heights += square.z[i] / d;
                        sum.weights += 1.0 / d;
                    }
                }
            }
            for (auto const& [parent, sum] : parents) {
                square.z[parent] = static_cast<float>(sum.heights / sum.weights);
            }
        }
    }
    Skeleton out = skeleton;
    for (std::int64_t i = 0; i < out.z.cells(); ++i) {
        out.z[i] = square.z[out.z.grid().at(i)];
    }
    return out;
}

/// The longest way that heights go under L: a step a half-level.
double chain(double longest_cells, std::int64_t side) {
    double sum = 0.0;
    for (std::int64_t h = 1; h < side; h *= 2) {
        for (double const d : {static_cast<double>(h), static_cast<double>(h) * std::sqrt(2.0)}) {
            sum += d <= longest_cells ? d : 0.0;
        }
    }
    return sum;
}

/// Thin lines at random, about 2.5 % of the cells.
Skeleton thin_lines(std::int64_t side) {
    Skeleton skeleton = empty(side, side);
    std::uint64_t word = 0;
    auto const anywhere = [&] {
        auto const words = random_block(5, word++);
        return Cell{static_cast<std::int64_t>(unit(words[0]) * static_cast<double>(side)),
                    static_cast<std::int64_t>(unit(words[1]) * static_cast<double>(side))};
    };
    while (known(skeleton) < side * side / 40) {
        Cell const from = anywhere();
        Cell const to = anywhere();
        Cell const near{from.col + (to.col - from.col) / 8, from.row + (to.row - from.row) / 8};
        walk_cells(from, near, [&](Cell c, std::int64_t k, std::int64_t) {
            skeleton.z[c] = 500.0F + 0.5F * static_cast<float>(k);
        });
    }
    return skeleton;
}

} // namespace

TEST(MidpointInverse, RefusesWhatIsNoDistanceAndEndlessHeights) {
    EXPECT_THROW(midpoint_inverse(empty(3, 3), {.longest_cells = -1.0}), BadParameter);
    EXPECT_THROW(midpoint_inverse(empty(3, 3), {.longest_cells = std::nan("")}), BadParameter);
    Skeleton high = empty(4, 3);
    high.z[Cell{3, 1}] = -std::numeric_limits<float>::infinity();
    EXPECT_TRUE(has(message_of<BadInput>([&] { midpoint_inverse(high); }), "column 3, row 1"));
}

TEST(MidpointInverse, HardlyAGrid) {
    EXPECT_EQ(midpoint_inverse({}).z.cells(), 0);
    EXPECT_EQ(known(midpoint_inverse(empty(5, 4), {endless})), 0);
    Skeleton one = empty(1, 1);
    one.z[0] = 5.0F;
    EXPECT_EQ(known(midpoint_inverse(one, {endless})), 1);
    Skeleton row = empty(9, 1);
    row.z[Cell{3, 0}] = 5.0F;
    EXPECT_EQ(known(midpoint_inverse(row)), 3);
}

TEST(MidpointInverse, AMidpointOfAnEdgeAndACentre) {
    Skeleton skeleton = empty(5, 5);
    skeleton.z[Cell{1, 0}] = 4.0F;
    skeleton.z[Cell{0, 1}] = 2.0F;
    skeleton.z[Cell{3, 3}] = 8.0F;
    Skeleton const edges = midpoint_inverse(skeleton, {1.0});
    EXPECT_EQ((edges.z[Cell{0, 0}]), 3.0F); // both
    EXPECT_EQ((edges.z[Cell{1, 1}]), 3.0F);
    EXPECT_EQ((edges.z[Cell{2, 0}]), 4.0F);
    EXPECT_EQ((edges.z[Cell{0, 2}]), 2.0F);
    EXPECT_EQ(known(edges), 7);
    Skeleton const centres = midpoint_inverse(skeleton, {1.5});
    EXPECT_EQ((centres.z[Cell{2, 2}]), 5.5F); // between the two centres
    EXPECT_EQ((centres.z[Cell{4, 4}]), 8.0F);
    EXPECT_EQ((centres.z[Cell{4, 2}]), 8.0F);
    EXPECT_EQ((centres.z[Cell{2, 0}]), 4.0F); // not empty any more
    EXPECT_EQ(known(centres), 11);
}

TEST(MidpointInverse, IsThePrintedRule) {
    ASSERT_TRUE(rc::check([] {
        Skeleton const skeleton = any_skeleton(40);
        double const longest = *rc::gen::element(0.0, 0.9, 1.0, 1.5, 2.0, 3.0, 6.0, 20.0, endless);
        Skeleton const fast = midpoint_inverse(skeleton, {longest});
        Skeleton const slow = plain_inverse(skeleton, longest);
        for (std::int64_t i = 0; i < skeleton.z.cells(); ++i) {
            RC_ASSERT(std::isnan(fast.z[i]) == std::isnan(slow.z[i]));
            RC_ASSERT((std::isnan(fast.z[i]) || std::fabs(fast.z[i] - slow.z[i]) < 1e-3F));
        }
    }));
}

TEST(MidpointInverse, KeepsDataRangeAndReachAndGrowsWithTheDistance) {
    ASSERT_TRUE(rc::check([] {
        Skeleton const skeleton = any_skeleton(70);
        std::vector<std::int64_t> at;
        float lowest = std::numeric_limits<float>::infinity();
        float highest = -lowest;
        for (std::int64_t i = 0; i < skeleton.z.cells(); ++i) {
            if (!std::isnan(skeleton.z[i])) {
                at.push_back(i);
                lowest = std::min(lowest, skeleton.z[i]);
                highest = std::max(highest, skeleton.z[i]);
            }
        }
        std::int64_t before = known(skeleton);
        for (double const longest : {0.0, 1.0, 1.5, 2.5, 5.0, 12.0, endless}) {
            Skeleton const grown = midpoint_inverse(skeleton, {longest}, on_threads(2));
            RC_ASSERT(known(grown) >= before);
            RC_ASSERT((longest > 0.0 || known(grown) == before));
            before = known(grown);
            double const reach = chain(longest, std::max(skeleton.z.width(), skeleton.z.height())) + 1e-9;
            for (std::int64_t i = 0; i < skeleton.z.cells(); ++i) {
                Cell const here = skeleton.z.grid().at(i);
                if (!std::isnan(skeleton.z[i])) {
                    RC_ASSERT(same_bits(skeleton.z[i], grown.z[i]));
                } else if (!std::isnan(grown.z[i])) {
                    RC_ASSERT((grown.z[i] >= lowest && grown.z[i] <= highest));
                    RC_ASSERT(std::ranges::any_of(at, [&](std::int64_t j) {
                        Cell const there = skeleton.z.grid().at(j);
                        return std::hypot(here.col - there.col, here.row - there.row) <= reach;
                    }));
                }
            }
        }
    }));
}

TEST(MidpointInverse, TheSameForAnyNumberOfThreads) {
    Skeleton const lines = thin_lines(500);
    Skeleton const one = midpoint_inverse(lines, {endless}, on_threads(1));
    Skeleton const four = midpoint_inverse(lines, {endless}, on_threads(4));
    EXPECT_TRUE(same_bits(one.z, four.z));
}

// In a trial other thin lines grew x 2.55 at 1.5, 3.23 at 3, 3.50 at 6, 3.57 without bound; the paper's x 2.21.
TEST(MidpointInverse, ThinLinesGrowAboutAsThePapers) {
    Skeleton const lines = thin_lines(1024);
    auto const growth = [&](double longest) {
        return static_cast<double>(known(midpoint_inverse(lines, {longest}))) / static_cast<double>(known(lines));
    };
    EXPECT_NEAR(growth(1.0), 2.0, 0.1);
    EXPECT_NEAR(growth(1.5), 2.65, 0.1);
    EXPECT_NEAR(growth(3.0), 3.4, 0.2);
    EXPECT_NEAR(growth(6.0), 3.7, 0.2);
    EXPECT_NEAR(growth(endless), 3.8, 0.2);
}

} // namespace midpoint_inverse_test
