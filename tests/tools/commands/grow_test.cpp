// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include "command.hpp"

namespace grow_test {

namespace {

std::string grown(std::string const& arguments) {
    Workplace const place;
    Outcome const o = expect_run(place, "grow " + arguments, 0);
    EXPECT_EQ(o.err, "") << arguments;
    return o.out;
}

} // namespace

TEST(Grow, RefusesWhatCannotGrow) {
    Workplace const place;
    place.write("koch.txt", "axiom F\niterations 2\nangle 60\nF -> F+F--F+F\n");
    place.write("bad.txt", "axiom F\nF > FF\n");
    place.write("koch.svg", "mine");
    expect_refused(place, "grow",
                   {"--generator 0", "--generator 51", "--generator many", "--order 0", "--order 40",
                    "--generator 50 --order 30", "--rule tokunga", "--rule", "--lsystem --json", "valley",
                    "--rules koch.txt -o koch.svg", "--rules koch.txt", "--rules koch.txt -o koch.txt",
                    "--rules koch.txt --order 3 --lsystem", "--rules bad.txt --lsystem", "--rules none.txt --lsystem",
                    "-o koch.pdf"});
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
    auto const json = expect_run(place, "grow --rules koch.txt -o koch.svg --json", 0).json();
    EXPECT_EQ(json["signs"], 36);
    EXPECT_EQ(json["lines"], 1);
    EXPECT_TRUE(std::filesystem::exists(place / "koch.svg"));
}

} // namespace grow_test
