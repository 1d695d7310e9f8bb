// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/linear/linear.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace linear_test {

using namespace thalweg;
using namespace thalweg::solver;

namespace {

using test::on_threads;

double drawn(std::uint64_t seed, std::uint64_t i, std::uint64_t j) {
    return 2.0 * unit(random_word(seed, i, j)) - 1.0;
}

Matrix random_matrix(std::size_t rows, std::size_t columns, std::uint64_t seed) {
    Matrix a(rows, columns);
    for (std::size_t r = 0; r < rows; ++r) {
        for (std::size_t c = 0; c < columns; ++c) {
            a.at(r, c) = drawn(seed, r, c);
        }
    }
    return a;
}

std::vector<double> random_vector(std::size_t rows, std::uint64_t seed) {
    std::vector<double> b(rows);
    for (std::size_t r = 0; r < rows; ++r) {
        b[r] = drawn(seed, r, 1000);
    }
    return b;
}

double squares(Matrix const& a, std::vector<double> const& b, std::vector<double> const& x) {
    double sum = 0.0;
    for (std::size_t r = 0; r < a.rows; ++r) {
        double off = -b[r];
        for (std::size_t c = 0; c < a.columns; ++c) {
            off += a.at(r, c) * x[c];
        }
        sum += off * off;
    }
    return sum;
}

Matrix diagonal(std::vector<double> const& d) {
    Matrix q(d.size(), d.size());
    for (std::size_t i = 0; i < d.size(); ++i) {
        q.at(i, i) = d[i];
    }
    return q;
}

/// A A' + 1 for random A: positive definite.
std::vector<double> positive_definite(std::size_t n, std::uint64_t seed) {
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

TEST(LeastSquares, RefusesWhatDoesNotFit) {
    EXPECT_THROW(least_squares(Matrix(2, 0), {1.0, 2.0}), BadInput);
    EXPECT_THROW(least_squares(Matrix(2, 1), {1.0}), BadInput);
    Matrix a(1, 1);
    a.at(0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(least_squares(a, {1.0}), BadInput);
}

TEST(LeastSquares, NoStepAwayMakesTheResidualSmaller) {
    for (std::uint64_t seed = 1; seed < 20; ++seed) {
        Matrix const a = random_matrix(40, 5, seed);
        std::vector<double> const b = random_vector(40, seed);
        Solution const s = least_squares(a, b);
        EXPECT_EQ(s.rank, 5U);
        EXPECT_NEAR(s.rms, std::sqrt(squares(a, b, s.x) / 40.0), 1e-14);
        for (std::size_t k = 0; k < 5; ++k) {
            for (double const step : {1e-3, -1e-3}) {
                std::vector<double> x = s.x;
                x[k] += step;
                EXPECT_GT(squares(a, b, x), squares(a, b, s.x));
            }
        }
    }
}

TEST(LeastSquares, TellsLostRankAndStaysSmall) {
    Matrix a = random_matrix(20, 3, 5);
    for (std::size_t r = 0; r < 20; ++r) {
        a.at(r, 2) = a.at(r, 0);
    }
    Solution const s = least_squares(a, random_vector(20, 5));
    EXPECT_EQ(s.rank, 2U);
    EXPECT_NEAR(s.x[0], s.x[2], 1e-6);
    Solution const none = least_squares(Matrix(4, 2), random_vector(4, 6));
    EXPECT_EQ(none.rank, 0U);
    EXPECT_EQ(none.x, (std::vector<double>{0.0, 0.0}));
}

TEST(LeastSquaresOnSphere, EqualsASearchOverAllAngles) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Matrix const a = random_matrix(25, 4, seed);
        std::vector<double> const b = random_vector(25, seed);
        Sphere const sphere{{1, 3}, diagonal({4.0, 0.25}), 0.05 * static_cast<double>(seed * seed)};
        Solution const s = least_squares_on_sphere(a, b, sphere);
        double const square = 4.0 * s.x[1] * s.x[1] + 0.25 * s.x[3] * s.x[3];
        EXPECT_NEAR(square / (sphere.tau * sphere.tau), 1.0, 1e-10);
        double best = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 20000; ++k) {
            double const angle = k * 3.14159265358979 / 10000.0;
            double const y1 = sphere.tau * std::cos(angle) / 2.0;
            double const y3 = sphere.tau * std::sin(angle) / 0.5;
            Matrix rest(25, 2);
            std::vector<double> right = b;
            for (std::size_t r = 0; r < 25; ++r) {
                rest.at(r, 0) = a.at(r, 0);
                rest.at(r, 1) = a.at(r, 2);
                right[r] -= a.at(r, 1) * y1 + a.at(r, 3) * y3;
            }
            best = std::min(best, std::pow(least_squares(rest, right).rms, 2) * 25.0);
        }
        EXPECT_LE(squares(a, b, s.x), best * (1.0 + 1e-12));
        EXPECT_GE(squares(a, b, s.x), best * (1.0 - 1e-4));
    }
}

TEST(LeastSquaresOnSphere, NoPointOfTheSphereIsBetterInManyUnknowns) {
    Matrix const a = random_matrix(60, 6, 3);
    std::vector<double> const b = random_vector(60, 3);
    for (double const tau : {1e-3, 0.1, 1.0, 50.0}) {
        Sphere const sphere{{0, 1, 2, 3, 4, 5}, diagonal({1, 2, 3, 4, 5, 6}), tau};
        Solution const s = least_squares_on_sphere(a, b, sphere);
        for (std::uint64_t k = 0; k < 20000; ++k) {
            std::vector<double> x(6);
            double square = 0.0;
            for (std::size_t i = 0; i < 6; ++i) {
                // Near the solution and far from it.
                x[i] = (k % 2 == 0 ? s.x[i] : 0.0) + tau * (k % 4 < 2 ? 1.0 : 0.01) * drawn(9, k, i);
                square += static_cast<double>(i + 1) * x[i] * x[i];
            }
            for (double& v : x) {
                v *= tau / std::sqrt(square);
            }
            EXPECT_GE(squares(a, b, x), squares(a, b, s.x) * (1.0 - 1e-12));
        }
    }
}

TEST(LeastSquaresOnSphere, TheHardCase) {
    // Columns at right angles; b has no part along the second, the weaker one: its sign is free, its length is not.
    Matrix a(4, 2);
    a.at(0, 0) = 2.0;
    a.at(1, 1) = 1.0;
    std::vector<double> const b{1.0, 0.0, 0.5, 0.0};
    Solution const s = least_squares_on_sphere(a, b, {{0, 1}, diagonal({1.0, 1.0}), 3.0});
    // lambda = -1: x0 = 2 / (4 - 1), x1 = sqrt(9 - x0^2).
    EXPECT_NEAR(s.x[0], 2.0 / 3.0, 1e-9);
    EXPECT_NEAR(std::fabs(s.x[1]), std::sqrt(9.0 - 4.0 / 9.0), 1e-9);
    // And with nothing at all on the right.
    Solution const bare = least_squares_on_sphere(a, {0.0, 0.0, 0.0, 0.0}, {{0, 1}, diagonal({1.0, 1.0}), 3.0});
    EXPECT_NEAR(bare.x[0], 0.0, 1e-9);
    EXPECT_NEAR(std::fabs(bare.x[1]), 3.0, 1e-12);
}

TEST(LeastSquaresOnSphere, RefusesWhatIsNoSphere) {
    Matrix const a = random_matrix(9, 3, 2);
    std::vector<double> const b = random_vector(9, 2);
    EXPECT_THROW(least_squares_on_sphere(a, b, {{}, Matrix(), 1.0}), BadParameter);
    EXPECT_THROW(least_squares_on_sphere(a, b, {{0, 1}, diagonal({1, 1}), 0.0}), BadParameter);
    EXPECT_THROW(least_squares_on_sphere(a, b, {{0, 1}, diagonal({1, -1}), 1.0}), BadParameter);
    EXPECT_THROW(least_squares_on_sphere(a, b, {{0, 7}, diagonal({1, 1}), 1.0}), BadParameter);
    EXPECT_THROW(least_squares_on_sphere(a, b, {{1, 1}, diagonal({1, 1}), 1.0}), BadParameter);
    Matrix twice = a;
    for (std::size_t r = 0; r < 9; ++r) {
        twice.at(r, 2) = twice.at(r, 1);
    }
    EXPECT_THROW(least_squares_on_sphere(twice, b, {{0}, diagonal({1}), 1.0}), BadInput);
}

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
    auto const matrix = positive_definite(n, 4);
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

} // namespace linear_test
