// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/rosgen.hpp>

#include <string>

#include <gtest/gtest.h>

namespace rosgen_test {

using namespace thalweg;

TEST(Rosgen, NamesReadBackAndNothingElseIsAName) {
    std::string all;
    for (Rosgen const type : rosgen_types) {
        EXPECT_EQ(rosgen_of(name_of(type)), type);
        all += std::string(name_of(type)) + " ";
    }
    EXPECT_EQ(all, "Aa+ A B C D DA E F G ");
    EXPECT_EQ(rosgen_of("A+"), Rosgen::aa_plus); // as in the paper's text
    for (char const* const wrong : {"", "a", "AA+", "aa+", "Aa", "H", "A ", "DAD", "none"}) {
        EXPECT_FALSE(rosgen_of(wrong)) << wrong;
    }
}

} // namespace rosgen_test
