// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/tokunaga/lsystem.hpp>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <growth/plain_streams.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace lsystem_test {

using namespace thalweg;
using namespace thalweg::growth;

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

} // namespace

TEST(Rewrite, RefusesWhatIsNoSystem) {
    for (auto const& [text, words] :
         std::vector<std::pair<std::string, std::string>>{{"", "no axiom"},
                                                          {"axiom\n", "no axiom"},
                                                          {"axiom F\nFF -> F", "r.txt, line 2"},
                                                          {"axiom F\n[ -> F", "other than [ and ]"},
                                                          {"axiom F\nF -> F]F[", "brackets"},
                                                          {"axiom F\nF -> F[", "brackets"},
                                                          {"axiom F\niterations 2.5", "whole number from 0 to 60"},
                                                          {"axiom F\niterations -1", "whole number"},
                                                          {"axiom F\nangle 200", "0 to 180"},
                                                          {"axiom F\nangle nan", "0 to 180"},
                                                          {"axiom F\nangel 20", "'angel 20' is not one of"},
                                                          {"axiom F\xff", "ASCII"}}) {
        EXPECT_TRUE(test::refused(
            "growth.read_rules", [&] { read_rules(text, "r.txt"); }, words))
            << text;
    }
    for (LSystem const& wrong : std::vector<LSystem>{
             {"F]", 1, 30.0, {}}, {"[F", 1, 30.0, {}}, {"F", 40, 30.0, {{'F', {"FF"}}}}, {"F", 61, 30.0, {}}}) {
        EXPECT_TRUE(test::refused<BadParameter>("growth.rewrite", [&] { rewrite(wrong); })) << wrong.axiom;
    }
}

TEST(Rewrite, TheRulesOfTheThesisGiveTheWordsOfTokunaga) {
    for (int order = 1; order <= 5; ++order) {
        LSystem system =
            read_rules("# lambda = 2\naxiom G\nangle 30\nG -> F[--G]F[-G][+G]\nF -> F [++G] F # mu = 1\n", "");
        system.iterations = order - 1;
        TokunagaParams params;
        params.generator = 2;
        params.order = order;
        params.banks = BankRule::alternating;
        EXPECT_EQ(rewrite(system), lsystem(params)) << order;
    }
}

TEST(Rewrite, SeveralRulesAreAsLikelyAndFollowTheSeed) {
    LSystem const system = read_rules("axiom A\niterations 13\nA -> AA\nA -> AA", "");
    EXPECT_EQ(rewrite(system).size(), 8192U);
    LSystem choice = read_rules("axiom " + std::string(4000, 'A') + "\nA -> B\nA -> C\nA ->\n", "");
    std::string const word = rewrite(choice, 5);
    EXPECT_EQ(word, rewrite(choice, 5));
    EXPECT_NE(word, rewrite(choice, 6));
    EXPECT_NEAR(static_cast<double>(word.size()), 4000.0 * 2.0 / 3.0, 120.0);
}

TEST(Rewrite, TheTurtleDrawsWhatTheWordSays) {
    double const root = std::sqrt(0.75); // cosine of 30 degrees
    using Lines = std::vector<std::vector<Vec2>>;
    for (auto const& [word, angle_deg, wanted] : std::vector<std::tuple<std::string, double, Lines>>{
             {"F[--G]F[-G][+G]",
              30.0,
              {{{0, 0}, {0, 1}, {root, 1.5}}, {{0, 1}, {0, 2}, {0.5, 2 + root}}, {{0, 2}, {-0.5, 2 + root}}}},
             {"F+F+F+F", 90.0, {{{0, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, 0}}}},
             {"FfF|fX", 90.0, {{{0, 0}, {0, 1}}, {{0, 2}, {0, 3}}, {{0, 2}, {0, 1}}}},
             {"+-[]!", 90.0, {}}}) {
        SCOPED_TRACE(word);
        Lines const lines = draw_word(word, angle_deg);
        ASSERT_EQ(lines.size(), wanted.size());
        for (std::size_t l = 0; l < lines.size(); ++l) {
            ASSERT_EQ(lines[l].size(), wanted[l].size());
            for (std::size_t i = 0; i < lines[l].size(); ++i) {
                EXPECT_LT(distance(lines[l][i], wanted[l][i]), 1e-12) << l << " " << i;
            }
        }
    }
}

TEST(LSystem, WritesTheGenerators) {
    auto const word = [](int lambda, int order = 2) {
        return lsystem({.generator = lambda, .order = order, .banks = BankRule::alternating});
    };
    EXPECT_EQ(word(2, 1), "G");
    EXPECT_EQ(word(2, 3), "F[++G]F[--F[--G]F[-G][+G]]F[++G]F[-F[--G]F[-G][+G]][+F[--G]F[-G][+G]]");
    EXPECT_EQ(word(1), "F[-G][+G]");
    EXPECT_EQ(word(3), "F[++G]F[--G]F[-G][+G]");
    EXPECT_EQ(word(4), "F[++G]F[--G]F[++G]F[-G][+G]");
}

RC_GTEST_PROP(LSystem, TheWordKeepsTheTree, ()) {
    growth::TokunagaParams params;
    params.seed = *rc::gen::arbitrary<std::uint64_t>();
    params.generator = *rc::gen::inRange(1, 6);
    params.order = *rc::gen::inRange(1, 6);
    params.banks = *rc::gen::element(BankRule::alternating, BankRule::random);
    auto const tree = growth::grow_tokunaga(params);
    auto const word = write_lsystem(tree);
    RC_ASSERT(word == lsystem(params));
    auto const down = down_of_word(word);
    RC_ASSERT(down.size() == tree.links.size());
    auto const a = test::plain_streams(test::down_of(tree));
    auto const b = test::plain_streams(down);
    RC_ASSERT(a.streams == b.streams);
    RC_ASSERT(a.branches == b.branches);
}

} // namespace lsystem_test
