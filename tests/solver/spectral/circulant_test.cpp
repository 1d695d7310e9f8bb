// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/circulant.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

namespace circulant_test {

using namespace thalweg;
using solver::Circulant;
using solver::StableCovariance;

namespace {

using test::frame_below;
using test::on_threads;

double covariance_of(Circulant const& torus, solver::Quarter const& table, Cell a, Cell b) {
    auto const apart = [](std::int64_t p, std::int64_t q, std::int64_t around) {
        return std::min(std::abs(p - q), around - std::abs(p - q));
    };
    std::int64_t const columns = torus.width / 2 + 1;
    return table[static_cast<std::size_t>(apart(a.row, b.row, torus.height) * columns +
                                          apart(a.col, b.col, torus.width))];
}

} // namespace

TEST(StableCovariance, IsOneOverEAtItsLengths) {
    StableCovariance const c{7.0, 11.0, 2.39};
    EXPECT_EQ(c(0.0, 0.0), 1.0);
    EXPECT_NEAR(c(7.0, 0.0), std::exp(-1.0), 1e-15);
    EXPECT_NEAR(c(0.0, -11.0), std::exp(-1.0), 1e-15);
    EXPECT_NEAR(c(3.0, 4.0), std::exp(-std::pow(std::hypot(3.0 / 7.0, 4.0 / 11.0), 1.22)), 1e-15);
    EXPECT_THROW(check(StableCovariance{0.0, 1.0, 2.5}, "a.b"), BadParameter);
    EXPECT_THROW(check(StableCovariance{1.0, 1.0, 2.0}, "a.b"), BadParameter);
    EXPECT_THROW(check(StableCovariance{1.0, std::nan(""), 2.5}, "a.b"), BadParameter);
}

TEST(ExpectedSlope, IsThatOfTheLandsOfTable4) {
    // 1.505 was found over many random fields of these statistics; the table says 1.499.
    EXPECT_NEAR(solver::expected_slope({20.68, 39.74, 2.39}, 131.6), 1.505, 0.003);
    EXPECT_EQ(solver::expected_slope({20.68, 39.74, 2.39}, 0.0), 0.0);
}

TEST(ExpectedSlope, FineFormsMakeLandsSteeperAndLeaveTheLengths) {
    StableCovariance const plain{288.0, 216.0, 2.1};
    double const is = solver::expected_slope(plain, 369.0);
    StableCovariance const steep = solver::with_slope(plain, 369.0, 1.45);
    EXPECT_LT(is, 1.45);
    EXPECT_NEAR(solver::expected_slope(steep, 369.0), 1.45, 1e-6);
    EXPECT_GT(steep.fine_share, 0.0);
    EXPECT_NEAR(steep(288.0, 0.0), std::exp(-1.0), 1e-3);
    EXPECT_EQ(solver::with_slope(plain, 369.0, is / 2.0).fine_share, 0.0);
    EXPECT_EQ(solver::with_slope(plain, 1.0, 1.5).fine_share, 0.5); // as much as there may be
}

TEST(Circulant, EigenvaluesAndCovariancesBelongTogether) {
    StableCovariance const wanted{3.0, 2.0, 2.4};
    Circulant const torus = solver::circulant(wanted, 50, 36);
    EXPECT_LT(torus.negative_share, 1e-9);
    auto const table = solver::covariances(torus);
    ASSERT_EQ(table.size(), 26U * 19U);
    for (std::int64_t y = 0; y <= 18; ++y) {
        for (std::int64_t x = 0; x <= 25; ++x) {
            EXPECT_NEAR(table[static_cast<std::size_t>(y * 26 + x)],
                        wanted(static_cast<double>(x), static_cast<double>(y)), 1e-7);
        }
    }
    EXPECT_TRUE(std::all_of(torus.eigenvalues.begin(), torus.eigenvalues.end(), [](double v) { return v >= 0.0; }));
    // A smooth covariance on a torus too small for it has negative eigenvalues, and says so.
    EXPECT_GT(solver::circulant({20.0, 20.0, 2.05}, 30, 30).negative_share, 1e-3);
}

TEST(Circulant, TheSmallestTorus) {
    Circulant const torus = solver::circulant({1.0, 1.0, 2.5}, 2, 2);
    EXPECT_NEAR(solver::covariances(torus)[3], std::exp(-std::sqrt(2.0)), 1e-15);
    EXPECT_TRUE(std::isfinite(solver::sample(torus, frame_below(1, 1), 1, 1)[0]));
}

TEST(Circulant, MultipliesAsTheMatrixDoes) {
    Circulant const torus = solver::circulant({4.0, 2.0, 2.3}, 30, 16);
    auto const table = solver::covariances(torus);
    Grid const grid = frame_below(17, 9);
    Raster<double> a(grid);
    Raster<double> b(grid);
    for (std::int64_t i = 0; i < a.cells(); ++i) {
        a[i] = unit(random_word(1, static_cast<std::uint64_t>(i))) - 0.5;
        b[i] = unit(random_word(2, static_cast<std::uint64_t>(i)));
    }
    Raster<double> product_a = a;
    Raster<double> product_b = b;
    solver::multiply(torus, product_a, product_b);
    for (std::int64_t i = 0; i < a.cells(); ++i) {
        double sum_a = 0.0;
        double sum_b = 0.0;
        for (std::int64_t j = 0; j < a.cells(); ++j) {
            double const c = covariance_of(torus, table, grid.at(i), grid.at(j));
            sum_a += c * a[j];
            sum_b += c * b[j];
        }
        ASSERT_NEAR(product_a[i], sum_a, 1e-12);
        ASSERT_NEAR(product_b[i], sum_b, 1e-12);
    }
}

TEST(Circulant, SamplesHaveItsCovariance) {
    Circulant const torus = solver::circulant({3.0, 5.0, 2.4}, 24, 30);
    auto const table = solver::covariances(torus);
    Grid const grid = frame_below(9, 8); // an even and an odd number of rows meet the pairing of rows
    constexpr int draws = 4000;
    Cell const here{4, 3};
    Raster<double> sums(grid);
    double mean = 0.0;
    for (int seed = 0; seed < draws; ++seed) {
        Raster<double> const field = solver::sample(torus, grid, static_cast<std::uint64_t>(seed), 1);
        for (std::int64_t i = 0; i < field.cells(); ++i) {
            sums[i] += field[here] * field[i];
        }
        mean += field[here];
    }
    EXPECT_LT(std::fabs(mean / draws), 4.0 / std::sqrt(draws));
    for (std::int64_t i = 0; i < sums.cells(); ++i) {
        // The deviation of one product is sqrt(1 + c^2).
        double const c = covariance_of(torus, table, here, grid.at(i));
        EXPECT_NEAR(sums[i] / draws, c, 4.5 * std::sqrt((1.0 + c * c) / draws)) << i;
    }
}

TEST(Circulant, SameBitsForAnyNumberOfThreads) {
    thalweg::Run run = on_threads(1);
    auto const made = [&] {
        Circulant const torus = solver::circulant({9.0, 5.0, 2.4}, 200, 120, run);
        Raster<double> field = solver::sample(torus, frame_below(97, 61), 3, 1, run);
        Raster<double> other = field;
        solver::multiply(torus, field, other, run);
        return std::vector<double>(field.values().begin(), field.values().end());
    };
    auto const one = made();
    for (int const threads : {2, 5}) {
        run.threads = threads;
        EXPECT_EQ(made(), one);
    }
}

TEST(NormalPair, IsNormal) {
    constexpr int count = 100000;
    double sum = 0.0;
    double squares = 0.0;
    double fourths = 0.0;
    double products = 0.0;
    for (std::uint64_t i = 0; i < count; ++i) {
        auto const [a, b] = normal_pair(random_word(5, i, 0), random_word(5, i, 1));
        sum += a + b;
        squares += a * a + b * b;
        fourths += a * a * a * a + b * b * b * b;
        products += a * b;
    }
    EXPECT_NEAR(sum / (2 * count), 0.0, 4.0 / std::sqrt(2.0 * count));
    EXPECT_NEAR(squares / (2 * count), 1.0, 4.0 * std::sqrt(2.0 / (2 * count)));
    EXPECT_NEAR(fourths / (2 * count), 3.0, 4.0 * std::sqrt(96.0 / (2 * count)));
    EXPECT_NEAR(products / count, 0.0, 4.0 / std::sqrt(count));
    auto const [far, still] = normal_pair(~std::uint64_t{0}, 0);
    EXPECT_NEAR(far, std::sqrt(2.0 * 53.0 * std::log(2.0)), 1e-12);
    EXPECT_EQ(still, 0.0);
    EXPECT_EQ(normal_pair(0, 5)[0], 0.0);
}

} // namespace circulant_test
