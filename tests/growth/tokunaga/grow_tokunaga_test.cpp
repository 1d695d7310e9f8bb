// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/tokunaga/grow_tokunaga.hpp>

#include <cmath>

#include <growth/plain_streams.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/order/order.hpp>

namespace grow_tokunaga_test {

using namespace thalweg;
using growth::grow_tokunaga;
using growth::SideRule;
using test::down_of;
using test::plain_streams;

namespace {

TEST(GrowTokunaga, RefusesWhatCannotGrow) {
    for (growth::TokunagaParams const& wrong : std::vector<growth::TokunagaParams>{{.generator = 0},
                                                                                   {.generator = 51},
                                                                                   {.order = 0},
                                                                                   {.order = 31},
                                                                                   {.max_links = 0},
                                                                                   {.generator = 50, .order = 30},
                                                                                   {.order = 8, .max_links = 21844}}) {
        EXPECT_TRUE(test::refused<BadParameter>("growth.grow_tokunaga", [&] { grow_tokunaga(wrong); }));
    }
    EXPECT_NO_THROW(grow_tokunaga({.order = 8, .max_links = 21845}));
}

TEST(GrowTokunaga, OrdersOneAndTwo) {
    auto const tree = grow_tokunaga({.generator = 7, .order = 1});
    ASSERT_EQ(tree.links.size(), 1U);
    EXPECT_EQ(tree.links[0].down, -1);
    EXPECT_EQ(tree.links[0].up[0], -1);
    EXPECT_EQ(tree.links[0].order, 1);
    EXPECT_EQ(tree.link_length, 1.0);
    for (int lambda = 1; lambda <= 50; ++lambda) { // order 2 is the generator
        EXPECT_EQ(grow_tokunaga({.generator = lambda, .order = 2}).links.size(),
                  static_cast<std::size_t>(2 * lambda + 1));
    }
}

TEST(GrowTokunaga, GeneratorTwoHasExactlyTheNumbersOfTokunaga) {
    auto const tree = grow_tokunaga({.generator = 2, .order = 8});
    EXPECT_EQ(tree.links.size(), 21845U);
    auto const plain = plain_streams(down_of(tree));
    EXPECT_EQ(plain.order, 8);
    for (int k = 1; k <= 7; ++k) {
        EXPECT_EQ(plain.side(k), std::ldexp(1.0, k - 1)) << k;
    }
    EXPECT_NEAR(plain.ratio(1), 4.0, 5e-4);
    EXPECT_EQ(tree.link_length, 1.0 / 64.0);
}

TEST(GrowTokunaga, SideBranchesFollowTheLawInTheMean) {
    for (int const lambda : {3, 4}) {
        auto const laws = growth::tokunaga_laws(lambda);
        double side[4] = {};
        double first = 0.0;
        double second = 0.0;
        int const runs = 6;
        for (int seed = 1; seed <= runs; ++seed) {
            auto const tree =
                grow_tokunaga({.seed = static_cast<std::uint64_t>(seed), .generator = lambda, .order = 7});
            auto const plain = plain_streams(down_of(tree));
            ASSERT_EQ(plain.order, 7);
            for (int k = 1; k <= 3; ++k) {
                side[k] += plain.side(k) / runs;
            }
            first += plain.ratio(1) / runs;
            second += plain.ratio(2) / runs;
        }
        double want = laws.a;
        for (int k = 1; k <= 3; ++k) {
            EXPECT_NEAR(side[k], want, 0.03 * want) << "lambda " << lambda << ", T_" << k;
            want *= laws.c;
        }
        EXPECT_NEAR(first, laws.bifurcation, 0.02 * laws.bifurcation);
        EXPECT_NEAR(second, laws.bifurcation, 0.02 * laws.bifurcation);
    }
}

TEST(GrowTokunaga, ThePlanesRuleFillsThePlane) {
    for (int const lambda : {1, 2, 3, 4, 9}) {
        double const c = growth::tokunaga_laws(lambda).c;
        auto const links = [&](int order) {
            return static_cast<double>(
                grow_tokunaga({.generator = lambda, .order = order, .rule = SideRule::plane}).links.size());
        };
        int const order = lambda == 1 ? 13 : lambda > 4 ? 6 : 7;
        EXPECT_NEAR(links(order) / links(order - 1), c * c, 0.01 * c * c) << lambda;
    }
}

TEST(GrowTokunaga, TheConstantRuleIsRightForTheFirstTwo) {
    auto const plain = plain_streams(down_of(grow_tokunaga({.generator = 3, .order = 8, .rule = SideRule::constant})));
    double const c = growth::tokunaga_laws(3).c;
    EXPECT_NEAR(plain.side(1), 2.0, 0.02);
    EXPECT_NEAR(plain.side(2), 2.0 * c, 0.06);
    EXPECT_NEAR(plain.side(3), 11.66, 0.2);
}

RC_GTEST_PROP(GrowTokunaga, GivesABinaryTreeOfItsOrder, ()) {
    int const lambda = *rc::gen::inRange(1, 13);
    int const order = *rc::gen::inRange(1, lambda > 5 ? 4 : 6);
    auto const rule = *rc::gen::element(SideRule::tokunaga, SideRule::constant, SideRule::plane);
    auto const seed = *rc::gen::arbitrary<std::uint64_t>();
    auto const tree = grow_tokunaga({.seed = seed, .generator = lambda, .order = order, .rule = rule});
    std::vector<int> arrivals(tree.links.size(), 0);
    std::size_t sources = 0;
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        auto const& link = tree.links[i];
        RC_ASSERT((i == 0) == (link.down < 0));
        RC_ASSERT(link.down < static_cast<std::int64_t>(i));
        RC_ASSERT((link.up[0] < 0) == (link.up[1] < 0));
        sources += link.up[0] < 0 ? 1U : 0U;
        int turns = 0;
        for (auto const up : link.up) {
            if (up >= 0) {
                auto const& above = tree.links[static_cast<std::size_t>(up)];
                RC_ASSERT(above.down == static_cast<std::int64_t>(i));
                turns += above.turn;
            }
        }
        if (link.up[0] >= 0) {
            auto const& first = tree.links[static_cast<std::size_t>(link.up[0])];
            auto const& second = tree.links[static_cast<std::size_t>(link.up[1])];
            bool const fork = first.order == second.order;
            RC_ASSERT((fork ? (turns == 0 && first.turn != 0) : (first.turn == 0 && (turns == 2 || turns == -2))));
            RC_ASSERT(link.order == first.order + (fork ? 1 : 0));
            RC_ASSERT(first.order >= second.order);
        } else {
            RC_ASSERT(link.order == 1);
        }
    }
    RC_ASSERT(2 * sources == tree.links.size() + 1);
    auto const plain = plain_streams(down_of(tree));
    RC_ASSERT(plain.order == order);
    auto const counts = network::count_streams(down_of(tree));
    RC_ASSERT(counts.order == order);
    RC_ASSERT(counts.sources == static_cast<std::int64_t>(sources));
    for (int w = 1; w <= order; ++w) {
        RC_ASSERT(static_cast<double>(counts.streams[static_cast<std::size_t>(w - 1)]) == plain.streams.at(w));
        if (w < order) {
            RC_ASSERT(counts.side[static_cast<std::size_t>(w - 1)] == plain.side(w));
        }
    }
}

TEST(TokunagaLaws, AreThePapersTable) {
    double const share[] = {1.6180, 1.0, 0.7676, 0.6404};
    double const bifurcation[] = {2.0, 4.0, 5.459, 6.809};
    for (int lambda = 1; lambda <= 4; ++lambda) {
        auto const laws = growth::tokunaga_laws(lambda);
        EXPECT_NEAR(laws.share, share[lambda - 1], 5e-5);
        EXPECT_NEAR(laws.bifurcation, bifurcation[lambda - 1], 5e-4);
        EXPECT_EQ(laws.a, lambda - 1.0);
        EXPECT_NEAR(laws.c * laws.c, laws.c + lambda, 1e-12);
        EXPECT_NEAR(growth::mean_side_branches(lambda, SideRule::tokunaga, 2), laws.share * laws.a, 1e-12);
    }
    EXPECT_NEAR(growth::mean_side_branches(3, SideRule::tokunaga, 20), growth::tokunaga_laws(3).c - 1.0, 1e-4);
    EXPECT_THROW(growth::tokunaga_laws(0), BadParameter);
    EXPECT_THROW(growth::tokunaga_laws(51), BadParameter);
}

} // namespace

} // namespace grow_tokunaga_test
