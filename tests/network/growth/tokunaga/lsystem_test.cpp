// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/tokunaga/lsystem.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <network/plain_streams.hpp>
#include <support.hpp>
#include <thalweg/core/run/error.hpp>

namespace lsystem_test {

using namespace thalweg;
using network::BankRule;
using network::lsystem;
using network::read_lsystem;
using network::write_lsystem;

namespace {

using test::full_message_of;

std::string complaint(std::string const& word) {
    return full_message_of<BadInput>([&] { read_lsystem(word); });
}

/// The L-system itself: every sign replaced by its rule.
std::string rewritten(std::string const& word, std::string const& f, std::string const& g) {
    std::string out;
    for (char const sign : word) {
        out += sign == 'F' ? f : sign == 'G' ? g : std::string(1, sign);
    }
    return out;
}

TEST(LSystem, RefusesWhatIsNoWord) {
    auto const at = [](std::string const& word) {
        auto const text = complaint(word);
        auto const begin = text.find("at position ");
        return begin == std::string::npos ? -1 : std::stoi(text.substr(begin + 12));
    };
    EXPECT_EQ(at(""), 1);
    EXPECT_EQ(at("F"), 1);
    EXPECT_EQ(at("GG"), 2);
    EXPECT_EQ(at("+G"), 2);
    EXPECT_EQ(at("G+"), 2);
    EXPECT_EQ(at("F[-G]"), 1);
    EXPECT_EQ(at("FF[-G][+G]"), 2);
    EXPECT_EQ(at("F[-G][+G]G"), 10);
    EXPECT_EQ(at("F[-G][+G][+G]"), 12);
    EXPECT_EQ(at("F[-G][+G]]"), 10);
    EXPECT_EQ(at("F[-G][+G"), 6);
    EXPECT_EQ(at("F[-G][]"), 7);
    EXPECT_EQ(at("F[[-G]]"), 3);
    EXPECT_EQ(at("[G]"), 1);
    EXPECT_EQ(at("F[G]G"), 3);
    EXPECT_EQ(at("F[-G]+G"), 7);
    EXPECT_EQ(at("F[---G]G"), 5);
    EXPECT_EQ(at("F[-G]X"), 6);
    EXPECT_EQ(at("G[-G][+G]"), 4);
    EXPECT_EQ(complaint("F[-G]X"), "network.read_lsystem: at position 6: 'X' is not one of F G + - [ ]");
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
    auto const back = read_lsystem(word);
    RC_ASSERT(write_lsystem(back) == word);
    RC_ASSERT(back.links.size() == tree.links.size());
    auto const a = test::plain_streams(test::down_of(tree));
    auto const b = test::plain_streams(test::down_of(back));
    RC_ASSERT(a.streams == b.streams);
    RC_ASSERT(a.branches == b.branches);
    RC_ASSERT(back.links.front().order == params.order);
}

TEST(LSystem, ReadsBlanksAndUnequalForks) {
    auto const tree = read_lsystem(" F [-G]\n[+F[-G][+G]]\t");
    ASSERT_EQ(tree.links.size(), 5U);
    EXPECT_EQ(tree.links[0].order, 2);
    EXPECT_EQ(tree.links[0].up[0], 2); // the higher order continues the stream
    EXPECT_EQ(write_lsystem(tree), "F[-G][+F[-G][+G]]");
}

TEST(DrawTurtle, DrawsWhatTheWordSays) {
    auto const lines = network::draw_turtle(read_lsystem("F[-G][++G]"), {.delta_deg = 30.0, .link_m = 2.0});
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0], (std::vector<Vec2>{{0.0, 0.0}, {0.0, 2.0}}));
    EXPECT_NEAR(lines[1][1].x, 1.0, 1e-12);
    EXPECT_NEAR(lines[1][1].y, 2.0 + std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(lines[2][1].x, -std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(lines[2][1].y, 3.0, 1e-12);
    EXPECT_THROW(network::draw_turtle({}, {.delta_deg = 91.0, .link_m = 1.0}), BadParameter);
    EXPECT_THROW(network::draw_turtle({}, {.link_m = 0.0}), BadParameter);
}

} // namespace

} // namespace lsystem_test
