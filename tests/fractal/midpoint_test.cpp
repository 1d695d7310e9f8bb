// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/midpoint.hpp>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/fractal/estimate_fractal.hpp>
#include <thalweg/fractal/internal/refine.hpp>

#include "land.hpp"
#include "ordinary_kriging.hpp"

namespace midpoint_test {

using namespace thalweg::fractal;

namespace {

using namespace thalweg;
using namespace thalweg::fractal;
using test::on_threads;
using test::same_bits;

constexpr Stencil stencils[] = {Stencil::four, Stencil::four_exact, Stencil::twelve, Stencil::sixteen};

Stencil any_stencil() {
    return *rc::gen::element(Stencil::four, Stencil::four_exact, Stencil::twelve, Stencil::sixteen).as("stencil");
}

MidpointParams with(int levels, Stencil stencil, double hurst, double sigma) {
    MidpointParams params;
    params.levels = levels;
    params.stencil = stencil;
    params.hurst = hurst;
    params.sigma = sigma;
    return params;
}

// ---- The slow, obvious oracle: in place, on the whole lattice, with doubles and libm.

using Point = std::pair<std::int64_t, std::int64_t>; // column, row

/// Weights of known neighbours of (0, 0), and the deviation of what is left in units of sigma.
void oracle_kriging(std::vector<Point> const& at, Stencil stencil, double h, std::vector<double>& weights,
                    double& deviation) {
    auto const gamma = [&](Point const& p, Point const& q) {
        double const dx = static_cast<double>(p.first - q.first);
        double const dy = static_cast<double>(p.second - q.second);
        return 0.5 * std::pow(dx * dx + dy * dy, h);
    };
    std::size_t const n = at.size();
    Point const here{0, 0};
    if (stencil == Stencil::four || stencil == Stencil::four_exact) {
        weights.assign(n, 1.0 / static_cast<double>(n));
    } else {
        weights = ordinary_kriging(at, here, gamma);
    }
    double variance = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        variance += 2.0 * weights[i] * gamma(at[i], here);
        for (std::size_t k = 0; k < n; ++k) {
            variance -= weights[i] * weights[k] * gamma(at[i], at[k]);
        }
    }
    deviation = std::sqrt(std::max(variance, 0.0));
}

float oracle_noise(MidpointParams const& params, int level, std::int64_t col, std::int64_t row) {
    std::array<float, noise_batch> batch{};
    std::int64_t const i = col / 2;
    noise_row(params.noise, {params.seed, level, row, col % 2}, i / noise_batch * noise_batch, batch, Lanes::plain);
    return batch[static_cast<std::size_t>(i % noise_batch)];
}

/// Whether all coarse cells nearest to a place, in coarse cells, are holes.
bool oracle_hole(Raster<float> const& coarse, double x, double y) {
    auto const distance = [&](std::int64_t i) {
        Cell const c = coarse.grid().at(i);
        return std::hypot(static_cast<double>(c.col) - x, static_cast<double>(c.row) - y);
    };
    double nearest = distance(0);
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        nearest = std::min(nearest, distance(i));
    }
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        if (distance(i) <= nearest + 1e-9 && !std::isnan(coarse[i])) {
            return false;
        }
    }
    return true;
}

Raster<float> oracle(Raster<float> const& coarse, MidpointParams const& params) {
    Raster<float> from = coarse;
    std::map<std::pair<std::vector<Point>, bool>, std::pair<std::vector<double>, double>> solved;
    for (int level = 1; level <= params.levels; ++level) {
        double const side = std::ldexp(1.0, -level);
        Raster<float> to(test::frame_below(2 * from.width() - 1, 2 * from.height() - 1), land::nan);
        for (std::int64_t i = 0; i < from.cells(); ++i) {
            Cell const c = from.grid().at(i);
            to[Cell{2 * c.col, 2 * c.row}] = from[i];
        }
        for (bool const edges : {false, true}) {
            for (std::int64_t i = 0; i < to.cells(); ++i) {
                Cell const c = to.grid().at(i);
                bool const odd_col = c.col % 2 != 0;
                bool const odd_row = c.row % 2 != 0;
                if (edges ? odd_col == odd_row : !(odd_col && odd_row)) {
                    continue;
                }
                if (oracle_hole(coarse, static_cast<double>(c.col) * side, static_cast<double>(c.row) * side)) {
                    continue;
                }
                std::vector<Point> at;
                std::vector<double> heights;
                for (std::int64_t a = -3; a <= 3; a += 2) {
                    for (std::int64_t b = -3; b <= 3; b += 2) {
                        std::int64_t const far = std::abs(a) + std::abs(b);
                        if (far > (params.stencil == Stencil::sixteen  ? 6
                                   : params.stencil == Stencil::twelve ? 4
                                                                       : 2)) {
                            continue;
                        }
                        Point const p = edges ? Point{(a + b) / 2, (a - b) / 2} : Point{a, b};
                        Cell const n{c.col + p.first, c.row + p.second};
                        if (to.grid().contains(n) && !std::isnan(to[n])) {
                            at.push_back(p);
                            heights.push_back(static_cast<double>(to[n]));
                        }
                    }
                }
                auto& [weights, deviation] = solved[{at, edges}];
                if (weights.empty()) {
                    oracle_kriging(at, params.stencil, *params.hurst, weights, deviation);
                }
                double const r = edges ? side : side * std::sqrt(2.0);
                double amount = *params.sigma * std::pow(side, *params.hurst) * deviation;
                if (params.stencil == Stencil::four) {
                    amount = *params.sigma * std::pow(r, *params.hurst) *
                             std::sqrt(1.0 - std::pow(2.0, 2.0 * *params.hurst - 2.0));
                }
                double z = amount * static_cast<double>(oracle_noise(params, level, c.col, c.row));
                for (std::size_t k = 0; k < at.size(); ++k) {
                    z += weights[k] * heights[k];
                }
                to[i] = static_cast<float>(z);
            }
        }
        from = to;
    }
    return from;
}

bool alike(Raster<float> const& dem, Raster<float> const& truth) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        auto const z = static_cast<double>(dem[i]);
        auto const true_z = static_cast<double>(truth[dem.grid().at(i)]);
        if (std::isnan(z) != std::isnan(true_z) || std::fabs(z - true_z) > 2e-5) {
            return false;
        }
    }
    return true;
}

// ---- The statistics of the surface.

/// Mean squared step along the rows that are multiples of a number, shared by that along all rows.
double crease(Raster<float> const& dem, std::int64_t multiple) {
    std::array<double, 2> sum{};
    std::array<double, 2> count{};
    for (std::int64_t row = 0; row < dem.height(); ++row) {
        std::size_t const old = row % multiple == 0 ? 1 : 0;
        for (std::int64_t col = 0; col + 1 < dem.width(); ++col) {
            auto const step = static_cast<double>(dem[Cell{col + 1, row}]) - static_cast<double>(dem[Cell{col, row}]);
            sum[old] += step * step;
            count[old] += 1.0;
        }
    }
    return sum[1] / count[1] / ((sum[0] + sum[1]) / (count[0] + count[1]));
}

class MidpointOfExactLand : public testing::TestWithParam<double> {};

double sum(StencilWeights const& weights) {
    double total = 0.0;
    for (double const w : weights.weight) {
        total += w;
    }
    return total;
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

} // namespace

TEST(Midpoint, IsTheOracleWithAnyCrop) {
    ASSERT_TRUE(rc::check("the oracle's heights, cropped", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(1, 9).as("coarse columns");
        auto const height = *rc::gen::inRange<std::int64_t>(1, 9).as("coarse rows");
        MidpointParams params = with(*rc::gen::inRange(1, 4).as("levels"), any_stencil(),
                                     *rc::gen::element(0.05, 0.3, 0.5, 0.8, 0.95).as("H"), 0.5);
        params.noise = *rc::gen::element(Noise::normal, Noise::uniform);
        params.seed = *rc::gen::arbitrary<std::uint64_t>().as("seed");
        double const holes = *rc::gen::element(0.0, 0.1, 0.6).as("holes");
        Raster<float> const coarse = land::by_chance(width, height, params.seed, holes);
        Raster<float> const truth = oracle(coarse, params);
        params.width = *rc::gen::inRange<std::int64_t>(1, truth.width() + 1).as("width");
        params.height = *rc::gen::inRange<std::int64_t>(1, truth.height() + 1).as("height");
        DisplacedDem const displaced = midpoint(coarse, params);
        RC_ASSERT(displaced.dem.width() == params.width);
        RC_ASSERT(displaced.dem.height() == params.height);
        RC_ASSERT(alike(displaced.dem, truth));
    }));
}

TEST(Midpoint, IsTheOracleOverChunksAndBands) {
    for (Stencil const stencil : stencils) {
        MidpointParams params = with(3, stencil, 0.6, 0.5);
        Raster<float> const coarse = land::by_chance(300, 5, 3);
        EXPECT_TRUE(alike(midpoint(coarse, params, on_threads(2)).dem, oracle(coarse, params)));
    }
}

TEST(Midpoint, ASmallerOneIsPartOfALargerOneBitForBit) {
    ASSERT_TRUE(rc::check("crops, and fewer levels", [] {
        Stencil const stencil = any_stencil();
        Raster<float> const coarse = land::by_chance(11, 9, 5, *rc::gen::element(0.0, 0.2));
        MidpointParams params = with(4, stencil, 0.6, 2.0);
        Raster<float> const large = midpoint(coarse, params).dem;
        params.width = *rc::gen::inRange<std::int64_t>(1, large.width() + 1).as("width");
        params.height = *rc::gen::inRange<std::int64_t>(1, large.height() + 1).as("height");
        Raster<float> const small = midpoint(coarse, params).dem;
        params.width = 0;
        params.height = 0;
        params.levels = 3;
        Raster<float> const rough = midpoint(coarse, params).dem;
        auto const bits = [](float z) { return std::bit_cast<std::uint32_t>(z); };
        for (std::int64_t i = 0; i < small.cells(); ++i) {
            RC_ASSERT(bits(small[i]) == bits(large[small.grid().at(i)]));
        }
        for (std::int64_t i = 0; i < rough.cells(); ++i) {
            Cell const c = rough.grid().at(i);
            RC_ASSERT(bits(rough[i]) == bits(large[Cell{2 * c.col, 2 * c.row}]));
        }
    }));
}

TEST(Midpoint, IsTheSameOnAnyThreadsAndInstructions) {
    Raster<float> const coarse = land::by_chance(40, 37, 8, 0.03);
    for (Stencil const stencil : stencils) {
        for (Adaptation const adaptation : {Adaptation::global, Adaptation::local}) {
            MidpointParams params = with(4, stencil, 0.5, 0.3);
            params.width = 601;
            params.height = 557;
            params.adaptation = adaptation;
            DisplacedDem const one = midpoint(coarse, params, on_threads(1));
            EXPECT_TRUE(same_bits(one.dem, midpoint(coarse, params, on_threads(2)).dem));
            if (adaptation == Adaptation::global) {
                Refinement refinement;
                refinement.coarse = &coarse;
                refinement.holes = true;
                refinement.levels = 4;
                refinement.stencil = stencil;
                refinement.seed = params.seed;
                refinement.character.sigma = 0.3;
                Raster<float> plain(one.dem.grid());
                Floors floors;
                refine(refinement, plain, floors, on_threads(2));
                EXPECT_TRUE(same_bits(one.dem, plain));
            }
        }
    }
}

TEST(Midpoint, IsTheSameWhereItIsStoredPastTheCache) {
    Raster<float> const coarse = land::by_chance(40, 40, 8);
    for (std::int64_t const width : {2304, 2303}) { // rows that begin at the vectors' bounds, and rows that do not
        MidpointParams params = with(6, Stencil::sixteen, 0.5, 0.3);
        params.width = width;
        params.height = 1900;
        Raster<float> const large = midpoint(coarse, params, on_threads(2)).dem;
        params.height = 700;
        Raster<float> const small = midpoint(coarse, params, on_threads(1)).dem;
        EXPECT_TRUE(std::equal(small.values().begin(), small.values().end(), large.values().begin()));
    }
}

TEST(Midpoint, TakesDegenerateLand) {
    for (Stencil const stencil : stencils) {
        Raster<float> const point(test::frame_below(1, 1), 7.0F);
        EXPECT_TRUE(std::ranges::equal(midpoint(point, with(5, stencil, 0.5, 3.0)).dem.values(), point.values()));
        Raster<float> const line = land::by_chance(6, 1, 3);
        Raster<float> const fine = midpoint(line, with(3, stencil, 0.5, 0.1)).dem;
        EXPECT_EQ(fine.width(), 41);
        EXPECT_EQ(fine.height(), 1);
        EXPECT_EQ(midpoint(land::by_chance(1, 6, 3), with(3, stencil, 0.5, 0.1)).dem.height(), 41);
        Raster<float> const all_holes(test::frame_below(4, 4), land::nan);
        Raster<float> const nothing = midpoint(all_holes, with(2, stencil, 0.5, 1.0)).dem;
        for (float const z : nothing.values()) {
            EXPECT_TRUE(std::isnan(z));
        }
        Raster<float> const coarse = land::by_chance(4, 4, 3);
        EXPECT_TRUE(same_bits(midpoint(coarse, with(0, stencil, 0.5, 1.0)).dem, coarse));
    }
}

TEST(Midpoint, CentresStayWhereTheyAre) {
    Raster<float> coarse(Grid{5, 4, 80.0, 1000.0, 9000.0, "EPSG:32631"}, 1.0F);
    Grid const fine = midpoint(coarse, with(3, Stencil::sixteen, 0.5, 1.0)).dem.grid();
    EXPECT_EQ(fine.cell_m, 10.0);
    EXPECT_EQ(fine.crs, coarse.grid().crs);
    EXPECT_EQ(fine.width, 33);
    EXPECT_EQ(fine.centre({16, 8}).x, coarse.grid().centre({2, 1}).x);
    EXPECT_EQ(fine.centre({16, 8}).y, coarse.grid().centre({2, 1}).y);
}

TEST(Midpoint, RefusesWhatItCannotUse) {
    Raster<float> coarse = land::by_chance(4, 3, 1);
    EXPECT_NE(
        land::refusal(coarse, with(2, Stencil::sixteen, 1.2, 1.0)).find("H is 1.2; it must be between 0.05 and 0.95"),
        std::string::npos);
    EXPECT_NE(land::refusal(coarse, with(2, Stencil::sixteen, std::nan(""), 1.0)), "");
    EXPECT_NE(land::refusal(coarse, with(2, Stencil::sixteen, 0.5, -1.0)).find("sigma is -1 m"), std::string::npos);
    EXPECT_NE(
        land::refusal(coarse, with(31, Stencil::sixteen, 0.5, 1.0)).find("levels is 31; it must be between 0 and 30"),
        std::string::npos);
    EXPECT_NE(land::refusal(coarse, with(-1, Stencil::sixteen, 0.5, 1.0)), "");
    EXPECT_NE(land::refusal(Raster<float>(test::frame_below(3000, 1)), with(30, Stencil::four, 0.5, 1.0)).find("2^40"),
              std::string::npos);
    MidpointParams params = with(2, Stencil::sixteen, 0.5, 1.0);
    params.width = 13; // just covered
    params.height = 10;
    EXPECT_NE(land::refusal(coarse, params).find("at least 4 columns and 4 rows"), std::string::npos);
    params.height = -1;
    EXPECT_NE(land::refusal(coarse, params), "");
    params.height = 0;
    coarse[5] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(midpoint(coarse, params), BadInput);
    EXPECT_THROW(midpoint(Raster<float>(), params), BadInput);
}

TEST(Midpoint, EstimatesWhatIsNotGiven) {
    Raster<float> const coarse = land::exact_fbm(12, 0.6, 4.0, 1);
    Fractal const fractal = estimate_fractal(coarse);
    MidpointParams params;
    params.levels = 3;
    DisplacedDem const estimated = midpoint(coarse, params);
    EXPECT_EQ(estimated.hurst, fractal.hurst);
    EXPECT_EQ(estimated.sigma, fractal.sigma);
    params.hurst = fractal.hurst;
    params.sigma = fractal.sigma;
    EXPECT_TRUE(same_bits(midpoint(coarse, params).dem, estimated.dem));
    params.hurst = 0.4;
    params.sigma.reset();
    EXPECT_EQ(midpoint(coarse, params).sigma, estimate_fractal(coarse, {Differences::squares, 0.4}).sigma);
}

TEST(Midpoint, AdaptsToLandOfTwoKinds) {
    // The west is level, the east is rough.
    Raster<float> coarse = land::by_chance(40, 20, 6);
    for (std::int64_t row = 0; row < 20; ++row) {
        for (std::int64_t col = 0; col < 20; ++col) {
            coarse[{col, row}] = 0.0F;
        }
    }
    MidpointParams params;
    params.levels = 3;
    params.adaptation = Adaptation::local;
    DisplacedDem const local = midpoint(coarse, params);
    EXPECT_GT(local.adapted, 300);
    auto const roughness = [&](Raster<float> const& dem, std::int64_t west, std::int64_t east) {
        double sum = 0.0;
        for (std::int64_t row = 0; row < dem.height(); ++row) {
            for (std::int64_t col = west; col < east; ++col) {
                double const step =
                    static_cast<double>(dem[Cell{col + 1, row}]) - static_cast<double>(dem[Cell{col, row}]);
                sum += step * step;
            }
        }
        return sum;
    };
    EXPECT_EQ(roughness(local.dem, 0, 8 * 12), 0.0);
    EXPECT_GT(roughness(local.dem, 8 * 22, 8 * 37), 0.0);
    params.adaptation = Adaptation::global;
    DisplacedDem const global = midpoint(coarse, params);
    EXPECT_EQ(global.adapted, 0);
    EXPECT_GT(roughness(global.dem, 0, 8 * 12), 0.0);
}

TEST_P(MidpointOfExactLand, HasTheDimensionAndNoCreases) {
    double const hurst = GetParam();
    constexpr int runs = 8;
    constexpr int levels = 7; // 5 x 5 to 513 x 513
    double dimension = 0.0;
    double first = 0.0;
    std::map<std::int64_t, double> creases;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
        double const sigma = std::pow(2.0, levels * hurst); // so that it is 1 between cells of the result
        MidpointParams params = with(levels, Stencil::sixteen, hurst, sigma);
        params.seed = seed;
        Raster<float> const dem = midpoint(land::exact_fbm(5, hurst, sigma, seed), params).dem;
        ASSERT_EQ(dem.width(), 513);
        std::array<double, 4> x{};
        std::array<double, 4> y{};
        for (std::size_t k = 0; k < 4; ++k) {
            x[k] = static_cast<double>(k) * std::log(2.0);
            y[k] = 0.5 * std::log(land::differences(dem, std::int64_t{1} << k));
        }
        // Least squares over 1, 2, 4, 8: weights -3, -1, 1, 3 of equal steps.
        double const slope = (3.0 * (y[3] - y[0]) + (y[2] - y[1])) / (10.0 * std::log(2.0));
        dimension += (3.0 - slope) / runs;
        first += std::exp(2.0 * y[0]) / runs;
        for (std::int64_t const multiple : {2, 4, 8}) {
            creases[multiple] += crease(dem, multiple) / runs;
        }
    }
    RecordProperty("dimension", std::to_string(dimension));
    std::printf("H %.1f: D %.3f, V(1)/sigma^2 %.3f, creases %.3f %.3f %.3f\n", hurst, dimension, first, creases[2],
                creases[4], creases[8]);
    EXPECT_NEAR(dimension, 3.0 - hurst, 0.05);
    if (hurst <= 0.7) {
        EXPECT_GT(first, 0.9);
        EXPECT_LT(first, 1.1);
    }
    for (auto const& [multiple, ratio] : creases) {
        EXPECT_NEAR(ratio, 1.0, 0.05) << multiple;
    }
}

INSTANTIATE_TEST_SUITE_P(Hurst, MidpointOfExactLand, testing::Values(0.3, 0.5, 0.7, 0.9));

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

} // namespace midpoint_test
