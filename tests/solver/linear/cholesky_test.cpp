// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/linear/linear.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace cholesky_test {

using namespace thalweg;

namespace {

using test::on_threads;

/// A A' + 1 for random A: positive definite.
std::vector<double> random_matrix(std::size_t n, std::uint64_t seed) {
    std::vector<double> a(n * n);
    for (std::size_t i = 0; i < a.size(); ++i) {
        a[i] = unit(random_word(seed, i)) - 0.5;
    }
    std::vector<double> m(n * n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            m[i * n + j] = i == j ? 1.0 : 0.0;
            for (std::size_t k = 0; k < n; ++k) {
                m[i * n + j] += a[i * n + k] * a[j * n + k];
            }
        }
    }
    return m;
}

} // namespace

TEST(Cholesky, OfNothingAndOfOneNumber) {
    EXPECT_TRUE(solver::solve(solver::factor({}, 0, 0.0), {}).empty());
    EXPECT_EQ(solver::solve(solver::factor({4.0}, 1, 0.0), {8.0}), (std::vector<double>{2.0}));
    EXPECT_EQ(solver::solve(solver::factor({2.0}, 1, 1.0), {8.0}), (std::vector<double>{2.0}));
}

TEST(Cholesky, RefusesWhatIsNotPositiveDefinite) {
    EXPECT_THROW(solver::factor({1.0, 0.0, 2.0, 1.0}, 2, 0.0), NotConverged);
    EXPECT_THROW(solver::factor({1.0, 0.0, 1.0, 1.0}, 2, 0.0), NotConverged);
    EXPECT_THROW(solver::factor({std::nan("")}, 1, 0.0), NotConverged);
}

TEST(Cholesky, SolvesWithTheSameBitsForAnyNumberOfThreads) {
    constexpr std::size_t n = 300;
    auto const matrix = random_matrix(n, 4);
    std::vector<double> x(n);
    std::vector<double> b(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        x[i] = unit(random_word(5, i));
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            b[i] += matrix[i * n + j] * x[j];
        }
    }
    thalweg::Run run = on_threads(1);
    auto const one = solver::factor(matrix, n, 0.0, run);
    auto const found = solver::solve(one, b);
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_NEAR(found[i], x[i], 1e-9);
    }
    run.threads = 5;
    auto const many = solver::factor(matrix, n, 0.0, run);
    EXPECT_EQ(solver::solve(many, b), found);
}

} // namespace cholesky_test
