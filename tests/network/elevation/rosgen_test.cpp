// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/elevation/river_types.hpp>

#include <string>

#include <gtest/gtest.h>

namespace rosgen_test {

using namespace thalweg::network;

TEST(Rosgen, NamesReadBackAndNothingElseIsAName) {
    std::string all;
    for (Rosgen const type : rosgen_types) {
        EXPECT_EQ(rosgen_of(name_of(type)), type);
        all += std::string(name_of(type)) + " ";
    }
    EXPECT_EQ(all, "Aa+ A B C D DA E F G ");
    EXPECT_EQ(rosgen_of("A+"), Rosgen::aa_plus); // as the paper's text has it
    for (char const* const wrong : {"", "a", "AA+", "aa+", "Aa", "H", "A ", "DAD", "none"}) {
        EXPECT_FALSE(rosgen_of(wrong)) << wrong;
    }
}

TEST(Rosgen, SlopesAreTheTables) {
    struct Row {
        double low;
        double high;
        double usual;
    };
    Row const table[] = {{0.10, 0.20, 0.12},  {0.04, 0.10, 0.07},  {0.02, 0.04, 0.03},
                         {0.001, 0.02, 0.01}, {0.001, 0.04, 0.02}, {0.001, 0.005, 0.003},
                         {0.001, 0.02, 0.01}, {0.001, 0.02, 0.01}, {0.02, 0.04, 0.03}};
    for (std::size_t i = 0; Rosgen const type : rosgen_types) {
        SlopeRange const range = slope_range(type);
        EXPECT_EQ(range.low, table[i].low) << name_of(type);
        EXPECT_EQ(range.high, table[i].high) << name_of(type);
        EXPECT_EQ(range.usual, table[i].usual) << name_of(type);
        EXPECT_LE(range.low, range.usual);
        EXPECT_LE(range.usual, range.high);
        ++i;
    }
}

TEST(Rosgen, OnlyTypesDAreBraided) {
    std::string braided;
    for (Rosgen const type : rosgen_types) {
        braided += is_braided(type) ? std::string(name_of(type)) + " " : "";
    }
    EXPECT_EQ(braided, "D DA ");
}

} // namespace rosgen_test
