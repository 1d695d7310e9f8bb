// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/lsystem.hpp>

#include <gtest/gtest.h>
#include <network/plain_streams.hpp>
#include <rapidcheck/gtest.h>

namespace lsystem_test {

using namespace thalweg;
using network::BankRule;
using network::lsystem;
using network::write_lsystem;

namespace {

/// By link of a word, in its order: the link downstream, -1 for the outlet.
std::vector<std::int64_t> down_of_word(std::string const& word) {
    std::vector<std::int64_t> down;
    std::vector<std::int64_t> open;
    std::int64_t here = -1;
    for (char const sign : word) {
        if (sign == '[') {
            open.push_back(here);
        } else if (sign == ']') {
            here = open.back();
            open.pop_back();
        } else if (sign == 'F' || sign == 'G') {
            down.push_back(here);
            here = static_cast<std::int64_t>(down.size()) - 1;
        }
    }
    return down;
}

/// The L-system itself: every sign replaced by its rule.
std::string rewritten(std::string const& word, std::string const& f, std::string const& g) {
    std::string out;
    for (char const sign : word) {
        out += sign == 'F' ? f : sign == 'G' ? g : std::string(1, sign);
    }
    return out;
}

TEST(LSystem, GeneratorTwoFollowsThePapersRules) {
    auto const word = [](int order) { return lsystem({.order = order, .banks = BankRule::alternating}); };
    EXPECT_EQ(word(1), "G");
    EXPECT_EQ(word(2), "F[--G]F[-G][+G]");
    EXPECT_EQ(word(3), "F[++G]F[--F[--G]F[-G][+G]]F[++G]F[-F[--G]F[-G][+G]][+F[--G]F[-G][+G]]");
    for (int order = 1; order < 7; ++order) {
        EXPECT_EQ(word(order + 1), rewritten(word(order), "F[++G]F", "F[--G]F[-G][+G]"));
    }
}

TEST(LSystem, WritesTheOtherGenerators) {
    auto const word = [](int lambda) {
        return lsystem({.generator = lambda, .order = 2, .banks = BankRule::alternating});
    };
    EXPECT_EQ(word(1), "F[-G][+G]");
    EXPECT_EQ(word(3), "F[++G]F[--G]F[-G][+G]");
    EXPECT_EQ(word(4), "F[++G]F[--G]F[++G]F[-G][+G]");
}

RC_GTEST_PROP(LSystem, TheWordKeepsTheTree, ()) {
    network::TokunagaParams params;
    params.seed = *rc::gen::arbitrary<std::uint64_t>();
    params.generator = *rc::gen::inRange(1, 6);
    params.order = *rc::gen::inRange(1, 6);
    params.banks = *rc::gen::element(BankRule::alternating, BankRule::random);
    auto const tree = network::grow_tokunaga(params);
    auto const word = write_lsystem(tree);
    RC_ASSERT(word == lsystem(params));
    auto const down = down_of_word(word);
    RC_ASSERT(down.size() == tree.links.size());
    auto const a = test::plain_streams(test::down_of(tree));
    auto const b = test::plain_streams(down);
    RC_ASSERT(a.streams == b.streams);
    RC_ASSERT(a.branches == b.branches);
}

} // namespace

} // namespace lsystem_test
