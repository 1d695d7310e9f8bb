// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/random.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace random_test {

using thalweg::random_block;
using thalweg::random_word;
using thalweg::RandomStream;

// Known answer of Philox4x64-10 (kat_vectors of Random123): counter and key of zeros.
TEST(Chance, is_philox_4x64_10) {
    std::array<std::uint64_t, 4> const known = {0x16554d9eca36314cULL, 0xdb20fe9d672d0fdcULL, 0xd7e772cee186176bULL,
                                                0x7e68b68aec7ba23bULL};
    EXPECT_EQ(random_block(0, 0), known);
}

TEST(Chance, unit_lies_in_the_half_open_interval) {
    EXPECT_EQ(thalweg::unit(0), 0.0);
    EXPECT_EQ(thalweg::unit(~std::uint64_t{0}), 1.0 - 0x1p-53);
}

TEST(Chance, every_number_of_the_place_matters) {
    std::vector<std::uint64_t> words = {random_word(1, 1, 1, 1, 1), random_word(2, 1, 1, 1, 1),
                                        random_word(1, 2, 1, 1, 1), random_word(1, 1, 2, 1, 1),
                                        random_word(1, 1, 1, 2, 1), random_word(1, 1, 1, 1, 2)};
    std::ranges::sort(words);
    EXPECT_EQ(std::ranges::adjacent_find(words), words.end());
    EXPECT_EQ(random_word(1, 2, 3, 4, 5), random_block(1, 2, 3, 4, 5)[0]);
}

TEST(Chance, a_stream_belongs_to_its_place) {
    RandomStream first(7, 3, 9);
    RandomStream again(7, 3, 9);
    RandomStream other_seed(8, 3, 9);
    RandomStream other_stage(7, 4, 9);
    RandomStream other_item(7, 3, 10);
    for (int i = 0; i < 100; ++i) {
        std::uint64_t const word = first.word();
        ASSERT_EQ(again.word(), word);
        ASSERT_NE(other_seed.word(), word);
        ASSERT_NE(other_stage.word(), word);
        ASSERT_NE(other_item.word(), word);
    }
}

TEST(Chance, a_stream_never_repeats_its_words) {
    RandomStream stream(1, 2, 3);
    std::vector<std::uint64_t> words(10000);
    std::ranges::generate(words, [&] { return stream.word(); });
    std::ranges::sort(words);
    EXPECT_EQ(std::ranges::adjacent_find(words), words.end());
}

// Law: mean 1/2 and variance 1/12, within five standard errors.
TEST(Chance, reals_are_uniform) {
    RandomStream stream(5, 6, 7);
    int const n = 1000000;
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < n; ++i) {
        double const u = stream.real() - 0.5;
        sum += u;
        squares += u * u;
    }
    EXPECT_NEAR(sum / n, 0.0, 5.0 * std::sqrt(1.0 / 12.0 / n));
    EXPECT_NEAR(squares / n, 1.0 / 12.0, 5.0 * std::sqrt(1.0 / 180.0 / n));
}

} // namespace random_test
