// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/linear/linear.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace sparse_test {

using namespace thalweg;
using namespace thalweg::solver;

TEST(SparseFactor, RefusesWhatIsNoPositiveMatrix) {
    EXPECT_THROW(SparseFactor(2, {{0, 1, 1.0}}), BadInput);
    EXPECT_THROW(SparseFactor(2, {{2, 1, 1.0}}), BadInput);
    EXPECT_THROW(SparseFactor(1, {{0, 0, std::numeric_limits<double>::quiet_NaN()}}), BadInput);
    EXPECT_THROW(SparseFactor(2, {{0, 0, 1.0}}), NotConverged);
    EXPECT_THROW(SparseFactor(1, {{0, 0, -1.0}}), NotConverged);
    EXPECT_THROW(SparseFactor(2, {{0, 0, 1.0}, {1, 0, 2.0}, {1, 1, 1.0}}), NotConverged);
    EXPECT_THROW(SparseFactor(1, {{0, 0, 1.0}}).solve({1.0, 2.0}), BadInput);
    EXPECT_TRUE(SparseFactor(0, {}).solve({}).empty());
}

TEST(SparseFactor, SolvesForEveryRightHandSide) {
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        constexpr std::uint32_t size = 60;
        std::vector<SparseEntry> entries;
        std::vector<std::vector<double>> dense(size, std::vector<double>(size, 0.0));
        auto const add = [&](std::uint32_t row, std::uint32_t column, double value) {
            entries.push_back({row, column, value});
            dense[row][column] += value;
            if (row != column) {
                dense[column][row] += value;
            }
        };
        for (std::uint32_t i = 0; i < size; ++i) {
            add(i, i, 0.5);
            add(i, i, 0.5); // two numbers in one place add up
        }
        for (std::uint64_t k = 0; k < 150; ++k) {
            auto const a = static_cast<std::uint32_t>(random_word(seed, k, 1) % size);
            auto const b = static_cast<std::uint32_t>(random_word(seed, k, 2) % size);
            if (a > b) {
                add(a, b, -1.0); // a spring between two
                add(a, a, 1.0);
                add(b, b, 1.0);
            }
        }
        SparseFactor const factor(size, entries);
        for (std::uint64_t side = 0; side < 3; ++side) {
            std::vector<double> b;
            for (std::uint64_t i = 0; i < size; ++i) {
                b.push_back(unit(random_word(seed, i, 10 + side)));
            }
            std::vector<double> const x = factor.solve(b);
            for (std::uint32_t i = 0; i < size; ++i) {
                double sum = 0.0;
                for (std::uint32_t j = 0; j < size; ++j) {
                    sum += dense[i][j] * x[j];
                }
                EXPECT_NEAR(sum, b[i], 1e-12);
            }
        }
    }
}

} // namespace sparse_test
