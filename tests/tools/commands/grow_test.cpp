// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support.hpp>

#include "command.hpp"

namespace grow_test {

namespace {

/// Exit 2 and the words in the message, nothing on stdout.
void refused(std::string const& arguments, std::string const& words) {
    Workplace const place;
    Outcome const o = expect_run(place, "grow " + arguments, 2, words);
    EXPECT_EQ(o.err.rfind("error: ", 0), 0U) << o.err;
    EXPECT_EQ(o.out, "") << arguments;
}

std::string grown(std::string const& arguments) {
    Workplace const place;
    Outcome const o = expect_run(place, "grow " + arguments, 0);
    EXPECT_EQ(o.err, "") << arguments;
    return o.out;
}

} // namespace

TEST(Grow, RefusesWhatCannotGrow) {
    refused("--generator 0", "generator");
    refused("--generator 51", "generator");
    refused("--generator many", "many");
    refused("--order 0", "order");
    refused("--order 40", "order");
    refused("--generator 50 --order 30", "has more than 2000000 links");
    refused("--rule tokunga", "--rule is one of tokunaga, constant, plane, not 'tokunga'");
    refused("--rule", "");
    refused("--lsystem --json", "--lsystem or --json, not both");
    refused("valley", "one word too many");
}

TEST(Grow, WordsOfTheLSystem) {
    EXPECT_EQ(grown("--lsystem --order 1"), "G\n");
    EXPECT_EQ(grown("--lsystem --order 2"), "F[--G]F[-G][+G]\n");
    EXPECT_EQ(grown("--lsystem --order 3"), "F[++G]F[--F[--G]F[-G][+G]]F[++G]F[-F[--G]F[-G][+G]][+F[--G]F[-G][+G]]\n");
}

TEST(Grow, CountsAreTokunagas) {
    auto const json = nlohmann::json::parse(grown("--generator 2 --order 8 --json"));
    EXPECT_EQ(json["links"], 21845);
    EXPECT_EQ(json["sources"], 10923);
    EXPECT_EQ(json["order"], 8);
    EXPECT_EQ(json["rule"], "tokunaga");
    ASSERT_EQ(json["side_branches"].size(), 7U);
    for (std::size_t k = 0; k < 7; ++k) {
        EXPECT_EQ(json["side_branches"][k], std::ldexp(1.0, static_cast<int>(k)));
        EXPECT_EQ(json["side_branches_law"][k], std::ldexp(1.0, static_cast<int>(k)));
    }
    EXPECT_EQ(json["streams"], nlohmann::json({10923, 2731, 683, 171, 43, 11, 3, 1}));
    EXPECT_EQ(json["bifurcation_law"], 4.0);
    ASSERT_EQ(json["bifurcation"].size(), 7U);
    EXPECT_EQ(json["bifurcation"][0], 10923.0 / 2731.0);
}

TEST(Grow, TableOfAGenerator) {
    EXPECT_EQ(grown("--order 1"), "links    1, of which 1 are sources\norder    1\n\n"
                                  "order w      streams N_w  N_w / N_w+1 (law 4.000)\n      1                1\n");
    std::string const table = grown("--order 3");
    EXPECT_EQ(table, "links    21, of which 11 are sources\norder    3\n\n"
                     "order w      streams N_w  N_w / N_w+1 (law 4.000)\n"
                     "      1               11        3.667\n"
                     "      2                3        3.000\n"
                     "      3                1\n\n"
                     "orders lower k   side branches T_k    law 1 * 2.000^(k-1)\n"
                     "            1                1.000                    1.000\n"
                     "            2                2.000                    2.000\n");
}

TEST(Grow, SeedAndRuleDecide) {
    std::string const some = "--generator 3 --order 6 --json ";
    EXPECT_EQ(grown(some + "--seed 4"), grown(some + "--seed 4"));
    EXPECT_NE(grown(some + "--seed 4"), grown(some + "--seed 5"));
    EXPECT_NE(grown(some + "--rule constant"), grown(some + "--rule plane"));
}

TEST(Grow, RulesOfAFileAreDrawnOrPrinted) {
    Workplace const place;
    place.write("koch.txt", "axiom F\niterations 2\nangle 60\nF -> F+F--F+F\n");
    Outcome const word = expect_run(place, "grow --rules koch.txt --lsystem", 0);
    EXPECT_EQ(word.out, "F+F--F+F+F+F--F+F--F+F--F+F+F+F--F+F\n");
    Outcome const drawn = expect_run(place, "grow --rules koch.txt -o koch.svg --json", 0);
    auto const json = nlohmann::json::parse(drawn.out);
    EXPECT_EQ(json["signs"], 36);
    EXPECT_EQ(json["lines"], 1);
    EXPECT_TRUE(std::filesystem::exists(place / "koch.svg"));
    auto const refused_here = [&](std::string const& arguments, std::string const& words) {
        expect_run(place, "grow " + arguments, 2, words);
    };
    place.write("bad.txt", "axiom F\nF > FF\n");
    refused_here("--rules koch.txt -o koch.svg", "already exists");
    refused_here("--rules koch.txt", "needs --lsystem");
    refused_here("--rules koch.txt -o koch.txt", ".svg, .png or .pdf");
    refused_here("--rules koch.txt --order 3 --lsystem", "--rules has its own");
    refused_here("--rules bad.txt --lsystem", "bad.txt, line 2");
    refused_here("--rules none.txt --lsystem", "none.txt");
    refused_here("-o koch.svg", "--rules FILE");
}

} // namespace grow_test
