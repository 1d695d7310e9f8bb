// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/circulant.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace fractional_surface_test {

using namespace thalweg;
using solver::fractional_surface;
using solver::FractionalSurface;

namespace {

using test::frame_below;
using test::message_of;
using test::on_threads;

double variogram(Cell a, Cell b, double hurst) {
    double const dx = static_cast<double>(a.col - b.col);
    double const dy = static_cast<double>(a.row - b.row);
    return std::pow(dx * dx + dy * dy, hurst);
}

std::string refusal_of(std::int64_t width, std::int64_t height, double hurst) {
    return message_of<BadParameter>([&] { fractional_surface(width, height, hurst); });
}

} // namespace

TEST(FractionalSurface, OfOneCellIsZero) {
    EXPECT_EQ(sample(fractional_surface(1, 1, 0.4), 1, 2)[0], 0.0);
    EXPECT_EQ(sample(fractional_surface(7, 1, 0.9), 1, 2).cells(), 7);
}

TEST(FractionalSurface, RefusesWhatItCannotMake) {
    for (double const hurst : {0.0, 1.0, -0.5, std::nan("")}) {
        EXPECT_TRUE(test::has(refusal_of(4, 4, hurst), "greater than 0 and less than 1"));
    }
    EXPECT_TRUE(test::has(refusal_of(0, 4, 0.5), "0 x 4 cells"));
    EXPECT_TRUE(test::has(refusal_of(60000, 60000, 0.5), "more than 2^31 cells"));
    EXPECT_THROW(solver::check_fractional_surface(40000, 30, 0.5), BadParameter);
    EXPECT_NO_THROW(solver::check_fractional_surface(30000, 30, 0.5));            // without the work
    EXPECT_THROW(solver::check_fractional_surface(30000, 30, 0.8), BadParameter); // the reach is twice as far
    EXPECT_TRUE(test::has(refusal_of(std::int64_t{1} << 40, 1, 0.5), "more than 2^31 cells"));
}

TEST(FractionalSurface, HasNoNegativeEigenvalues) {
    double least = 1.0;
    for (double const hurst : {0.05, 0.3, 0.5, 0.7, 0.75, 0.76, 0.8, 0.9, 0.95}) {
        for (auto const& [width, height] :
             {std::pair{2, 1}, std::pair{2, 2}, std::pair{3, 3}, std::pair{9, 3}, std::pair{41, 1}, std::pair{65, 65},
              std::pair{40, 301}, std::pair{257, 257}}) {
            FractionalSurface const surface = fractional_surface(width, height, hurst);
            // Negative ones are 0 in the torus, and counted.
            EXPECT_EQ(surface.torus.negative_share, 0.0) << hurst << ": " << width << " x " << height;
            auto const& values = surface.torus.eigenvalues;
            double const smallest = *std::min_element(values.begin(), values.end());
            least = std::min(least, smallest / *std::max_element(values.begin(), values.end()));
        }
    }
    std::printf("least eigenvalue, as a share of the greatest: %.3g\n", least);
    EXPECT_GE(least, 0.0);
}

TEST(FractionalSurface, FieldAndPlaneTogetherHaveTheVariogram) {
    for (double const hurst : {0.05, 0.5, 0.75, 0.8, 0.95}) {
        for (auto const& [width, height] : {std::pair{33, 33}, std::pair{60, 5}, std::pair{1, 12}, std::pair{2, 2}}) {
            FractionalSurface const surface = fractional_surface(width, height, hurst);
            solver::Quarter const table = covariances(surface.torus);
            std::int64_t const columns = surface.torus.width / 2 + 1;
            auto const at = [&](std::int64_t col, std::int64_t row) {
                std::int64_t const around_col = std::min(col, surface.torus.width - col);
                std::int64_t const around_row = std::min(row, surface.torus.height - row);
                return table[static_cast<std::size_t>(around_row * columns + around_col)];
            };
            double const d = surface.diagonal_cells;
            for (std::int64_t row = 0; row < height; ++row) {
                for (std::int64_t col = 0; col < width; ++col) {
                    double const r = variogram({col, row}, {0, 0}, 1.0) / (d * d);
                    double const field = 2.0 * (at(0, 0) - at(col, row));
                    double const plane = 2.0 * surface.square * r;
                    EXPECT_NEAR(0.5 * (field + plane), std::pow(r, hurst), 1e-12)
                        << hurst << ": " << col << ", " << row;
                }
            }
        }
    }
}

TEST(FractionalSurface, DiffersAsTheVariogramSaysInEveryDirection) {
    constexpr int runs = 6000;
    for (double const hurst : {0.2, 0.7, 0.9}) {
        for (auto const& [width, height] : {std::pair{5, 5}, std::pair{8, 3}}) {
            FractionalSurface const surface = fractional_surface(width, height, hurst);
            std::size_t const cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
            std::vector<double> squares(cells * cells, 0.0);
            for (std::uint64_t seed = 1; seed <= runs; ++seed) {
                Raster<double> const z = sample(surface, seed, 7, on_threads(1));
                ASSERT_EQ(z[0], 0.0);
                for (std::size_t a = 0; a < cells; ++a) {
                    for (std::size_t b = 0; b < a; ++b) {
                        double const step = z[static_cast<std::int64_t>(a)] - z[static_cast<std::int64_t>(b)];
                        squares[a * cells + b] += step * step / runs;
                    }
                }
            }
            Grid const grid = frame_below(width, height);
            for (std::size_t a = 0; a < cells; ++a) {
                for (std::size_t b = 0; b < a; ++b) {
                    double const truth =
                        variogram(grid.at(static_cast<std::int64_t>(a)), grid.at(static_cast<std::int64_t>(b)), hurst);
                    // A mean of squares of normal numbers deviates by sqrt(2 / runs) of itself.
                    EXPECT_NEAR(squares[a * cells + b] / truth, 1.0, 5.0 * std::sqrt(2.0 / runs))
                        << hurst << ": " << a << ", " << b;
                }
            }
        }
    }
}

TEST(FractionalSurface, VariogramsAreSuperposedAsTheSlowSumsAre) {
    for (double const hurst : {0.05, 0.6, 0.9}) {
        for (auto const& [width, height] : {std::pair{12, 9}, std::pair{1, 1}, std::pair{30, 1}, std::pair{2, 17}}) {
            Raster<double> weights(frame_below(width, height));
            for (std::int64_t i = 0; i < weights.cells(); ++i) {
                weights[i] = unit(random_word(3, static_cast<std::uint64_t>(i))) - 0.3;
            }
            Raster<double> sums = weights;
            superpose_variograms(fractional_surface(width, height, hurst), sums);
            for (std::int64_t p = 0; p < weights.cells(); ++p) {
                double slow = 0.0;
                double size = 1.0;
                for (std::int64_t q = 0; q < weights.cells(); ++q) {
                    double const part =
                        p == q ? 0.0 : weights[q] * variogram(weights.grid().at(p), weights.grid().at(q), hurst);
                    slow += part;
                    size += std::fabs(part);
                }
                EXPECT_NEAR(sums[p], slow, 1e-11 * size) << hurst << ": " << p;
            }
        }
    }
}

TEST(FractionalSurface, IsTheSameOnAnyThreads) {
    for (double const hurst : {0.4, 0.9}) {
        FractionalSurface const one = fractional_surface(150, 77, hurst, on_threads(1));
        FractionalSurface const two = fractional_surface(150, 77, hurst, on_threads(2));
        EXPECT_EQ(one.torus.eigenvalues, two.torus.eigenvalues);
        Raster<double> a = sample(one, 5, 6, on_threads(1));
        Raster<double> b = sample(two, 5, 6, on_threads(2));
        EXPECT_TRUE(std::equal(a.values().begin(), a.values().end(), b.values().begin()));
        superpose_variograms(one, a, on_threads(1));
        superpose_variograms(two, b, on_threads(2));
        EXPECT_TRUE(std::equal(a.values().begin(), a.values().end(), b.values().begin()));
    }
}

} // namespace fractional_surface_test
