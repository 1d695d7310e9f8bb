// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/midpoint.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace stencil_weights_test {

namespace {

using namespace thalweg::fractal;

double sum(StencilWeights const& weights) {
    double total = 0.0;
    for (double const w : weights.weight) {
        total += w;
    }
    return total;
}

TEST(StencilWeights, OneNeighbourIsTaken) {
    for (Stencil const stencil : {Stencil::four_exact, Stencil::twelve, Stencil::sixteen}) {
        StencilWeights const one = stencil_weights(stencil, 1, 0.7);
        EXPECT_NEAR(one.weight[0], 1.0, 1e-12);
        EXPECT_NEAR(one.deviation, 1.0, 1e-12);
    }
}

TEST(StencilWeights, FourHaveTheDeviationsOfTheSpecification) {
    for (double const h : {0.05, 0.3, 0.5, 0.7, 0.95}) {
        EXPECT_DOUBLE_EQ(stencil_weights(Stencil::four, 0xf, h).deviation,
                         std::sqrt(1.0 - std::pow(2.0, 2.0 * h - 2.0)));
        EXPECT_NEAR(std::pow(stencil_weights(Stencil::four_exact, 0xf, h).deviation, 2.0),
                    1.0 - std::pow(2.0, h - 2.0) - std::pow(2.0, 2.0 * h - 3.0), 1e-12);
        // Three at a border: two opposite and one between.
        EXPECT_NEAR(std::pow(stencil_weights(Stencil::four_exact, 0x7, h).deviation, 2.0),
                    1.0 - (std::pow(2.0, 2.0 * h) + 2.0 * std::pow(2.0, h)) / 9.0, 1e-12);
        EXPECT_NEAR(stencil_weights(Stencil::four, 0x7, h).weight[1], 1.0 / 3.0, 1e-15);
    }
}

TEST(StencilWeights, TheEdgeHasTheCentresNeighboursTurned) {
    for (std::size_t a = 0; a < 16; ++a) {
        Offset const c = around_centre[a];
        Offset const e = around_edge[a];
        EXPECT_EQ(c.col * c.col + c.row * c.row, 2 * (e.col * e.col + e.row * e.row));
        for (std::size_t b = 0; b < a; ++b) {
            auto const square = [](Offset const& p, Offset const& q) {
                return (p.col - q.col) * (p.col - q.col) + (p.row - q.row) * (p.row - q.row);
            };
            EXPECT_EQ(square(c, around_centre[b]), 2 * square(e, around_edge[b]));
        }
    }
}

/// Conditional variance of weights that sum to 1, straight from the definition.
double variance(StencilWeights const& weights, double h) {
    auto const gamma = [&](Offset const& p, Offset const& q) {
        return std::pow(std::hypot(p.col - q.col, p.row - q.row) / std::sqrt(2.0), 2.0 * h);
    };
    double total = 0.0;
    for (std::size_t i = 0; i < 16; ++i) {
        total += weights.weight[i] * gamma(around_centre[i], {});
        for (std::size_t k = 0; k < 16; ++k) {
            total -= 0.5 * weights.weight[i] * weights.weight[k] * gamma(around_centre[i], around_centre[k]);
        }
    }
    return total;
}

TEST(StencilWeights, KrigingIsTheLeastVariance) {
    for (double const h : {0.05, 0.3, 0.5, 0.7, 0.95}) {
        for (std::uint32_t const known : {0xffffU, 0x0fffU, 0x00ffU, 0x8421U, 0x1234U, 0xf0f0U}) {
            StencilWeights const best = stencil_weights(Stencil::sixteen, known, h);
            EXPECT_NEAR(sum(best), 1.0, 1e-11);
            EXPECT_NEAR(best.deviation * best.deviation, variance(best, h), 1e-10);
            for (std::size_t i = 0; i < 16; ++i) {
                if ((known >> i & 1U) == 0) {
                    EXPECT_EQ(best.weight[i], 0.0);
                    continue;
                }
                for (std::size_t k = 0; k < 16; ++k) {
                    if ((known >> k & 1U) != 0 && k != i) {
                        StencilWeights other = best;
                        other.weight[i] += 0.01;
                        other.weight[k] -= 0.01;
                        EXPECT_GT(variance(other, h), variance(best, h));
                    }
                }
            }
        }
    }
}

TEST(StencilWeights, MoreNeighboursKnowMore) {
    for (double const h : {0.3, 0.5, 0.7, 0.9}) {
        double const four = stencil_weights(Stencil::four_exact, 0xf, h).deviation;
        double const twelve = stencil_weights(Stencil::twelve, 0xfff, h).deviation;
        double const sixteen = stencil_weights(Stencil::sixteen, 0xffff, h).deviation;
        EXPECT_LE(twelve, four);
        EXPECT_LE(sixteen, twelve);
    }
}

} // namespace

} // namespace stencil_weights_test
