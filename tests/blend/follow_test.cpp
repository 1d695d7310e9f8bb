// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/blend/internal/region.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "lands.hpp"

namespace follow_test {

using namespace thalweg;
using namespace thalweg::blend;
using solver::fixed_cell;
using solver::free_cell;

namespace {

solver::PoissonParams tight() {
    solver::PoissonParams params;
    params.tolerance = 1e-12;
    return params;
}

Raster<double> doubles(Raster<float> const& land) {
    return lands::patch_of(land, Mask(land.grid())).z;
}

/// A frame of fixed cells around free ones, some fixed among them.
Raster<std::uint8_t> framed(Grid const& grid, std::uint64_t seed) {
    Raster<std::uint8_t> kind(grid, free_cell);
    Mask const drawn = lands::mask_by_chance(grid, seed, 0.05);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (grid.on_border(grid.at(i)) || drawn[i] != 0) {
            kind[i] = fixed_cell;
        }
    }
    return kind;
}

Guidance differences_of(Raster<double> const& z) {
    Guidance guidance{Raster<double>(z.grid()), Raster<double>(z.grid())};
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        Cell const c = z.grid().at(i);
        if (c.col + 1 < z.width()) {
            guidance.east[i] = z[i + 1] - z[i];
        }
        if (c.row + 1 < z.height()) {
            guidance.south[i] = z[i + z.width()] - z[i];
        }
    }
    return guidance;
}

double farthest(Raster<double> const& a, Raster<double> const& b) {
    double most = 0.0;
    for (std::int64_t i = 0; i < a.cells(); ++i) {
        most = std::max(most, std::fabs(a[i] - b[i]));
    }
    return most;
}

} // namespace

TEST(Follow, CellsWithoutFreeOnesStay) {
    Grid const grid = test::frame(3, 2);
    Raster<double> const fixed = doubles(lands::by_chance(grid, 1));
    auto const solution = solve_guided(Raster<std::uint8_t>(grid, fixed_cell), fixed, Raster<double>(grid), {});
    EXPECT_EQ(farthest(solution.value, fixed), 0.0);
}

TEST(Follow, CarrierWithHarmonicExtensionEqualsTheGradientForm) {
    ASSERT_TRUE(rc::check("to 1e-8", [] {
        Grid const grid = test::frame(*rc::gen::inRange<std::int64_t>(3, 40).as("columns"),
                                      *rc::gen::inRange<std::int64_t>(3, 40).as("rows"));
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        auto const kind = framed(grid, seed);
        Raster<double> const target = doubles(lands::by_chance(grid, seed + 1));
        Raster<double> const source = doubles(lands::by_chance(grid, seed + 2));
        auto const extended = solve_guided(kind, target, source, {}, tight());
        auto const gradients = solve_guided(kind, target, Raster<double>(grid), differences_of(source), tight());
        RC_ASSERT(farthest(extended.value, gradients.value) <= 1e-8);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT((kind[i] == free_cell || extended.value[i] == target[i]));
        }
    }));
}

TEST(Follow, IsLinearAndBlindToTheLevel) {
    ASSERT_TRUE(rc::check("to 1e-10 of the heights", [] {
        Grid const grid = test::frame(23, 17);
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 100000).as("seed");
        auto const kind = framed(grid, seed);
        double const level = *rc::gen::element(1.0, -1000.0, 8848.86).as("level");
        double const share = *rc::gen::element(2.0, -0.3, 0.7).as("share");
        Raster<double> target[3];
        Raster<double> source[3];
        for (std::uint64_t k = 0; k < 2; ++k) {
            target[k] = doubles(lands::by_chance(grid, seed + k + 1));
            source[k] = doubles(lands::by_chance(grid, seed + k + 11));
        }
        target[2] = target[0];
        source[2] = source[0];
        Raster<double> lifted = source[0];
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            target[2][i] += share * target[1][i];
            source[2][i] += share * source[1][i];
            lifted[i] += level;
        }
        Raster<double> f[3];
        for (int k = 0; k < 3; ++k) {
            f[k] = solve_guided(kind, target[k], source[k], {}, tight()).value;
        }
        RC_ASSERT(farthest(solve_guided(kind, target[0], lifted, {}, tight()).value, f[0]) <=
                  1e-10 * (100.0 + std::fabs(level)));
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            RC_ASSERT(std::fabs(f[0][i] + share * f[1][i] - f[2][i]) <= 1e-8);
        }
    }));
}

} // namespace follow_test
