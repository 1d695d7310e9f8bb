// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/diffusion.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>
#include <thalweg/recipe/frame.hpp>
#include <thalweg/surface/diffusion/internal/diffusion.hpp>
#include <thalweg/surface/dilation/dilation.hpp>

#include "valleys.hpp"

namespace diffusion_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

using test::full_message_of;
using test::has;
using test::on_threads;
using test::same_bits;

DiffuseParams sweeps(int iterations, DiffusionStart start = DiffusionStart::coarse) {
    DiffuseParams params;
    params.mode = Diffusion::explicit_sweeps;
    params.iterations = iterations;
    params.start = start;
    return params;
}

DiffuseParams unsmoothed(DiffuseParams params = {}) {
    params.sigma_cells = 0.0;
    return params;
}

Skeleton skeleton_of(Valley const& valley) {
    return {valley.z};
}

/// A valley of the first paper: the longest branch of a cluster grown at random, raised upstream.
Valley grown() {
    growth::Branch const branch = growth::pick_branch(growth::grow_dla({.particles = 8000}));
    recipe::FramedBranch const framed = recipe::frame_branch(branch, {});
    StreamNetwork const traced = network::trace(network::thin(framed.mask), {framed.mouth});
    double const cell_m = framed.mask.grid().cell_m;
    StreamNetwork const pruned = network::prune(traced, {.length_m = 8 * cell_m, .cell_m = cell_m}).network;
    return network::rasterise(network::set_heights(pruned).network, framed.mask.grid()).valley;
}

struct Scarps {
    double share = 0.0;    ///< of cells whose greatest step to a 4-neighbour is more than five increments
    double greatest = 0.0; ///< step
};

Scarps scarps_of(Raster<double> const& z, double increment) {
    Scarps scarps;
    Grid const& grid = z.grid();
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        Cell const c = grid.at(i);
        double step = 0.0;
        for (Cell const n : {Cell{c.col - 1, c.row}, {c.col + 1, c.row}, {c.col, c.row - 1}, {c.col, c.row + 1}}) {
            step = grid.contains(n) ? std::max(step, std::fabs(z[n] - z[i])) : step;
        }
        count += step > 5.0 * increment ? 1 : 0;
        scarps.greatest = std::max(scarps.greatest, step);
    }
    scarps.share = static_cast<double>(count) / static_cast<double>(z.cells());
    return scarps;
}

} // namespace

TEST(Diffuse, RefusesWhatCannotBeSpread) {
    EXPECT_THROW(diffuse(Skeleton{}), BadInput);
    Skeleton bare{Raster<float>(test::frame_below(5, 4), valleys::nan)};
    EXPECT_TRUE(has(full_message_of<BadInput>([&] { diffuse(bare); }), "surface.diffuse"));
    bare.z[{3, 1}] = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(has(full_message_of<BadInput>([&] { diffuse(bare); }), "column 3, row 1"));
    Skeleton land{Raster<float>(test::frame_below(5, 4), 1.0F)};
    EXPECT_THROW(diffuse(land, Mask(test::frame_below(4, 5), 1)), BadInput);
    EXPECT_THROW(diffuse(land, Mask(test::frame_below(5, 4), 0)), BadInput);
    auto const refused = [&](auto const& change) {
        DiffuseParams params;
        change(params);
        return full_message_of<BadParameter>([&] { diffuse(land, params); });
    };
    for (double const alpha : {std::nextafter(0.25, 1.0), 0.26, 0.0, -0.1, std::nan("")}) {
        EXPECT_TRUE(has(refused([&](auto& p) { p.alpha = alpha; }), "1/4"));
    }
    EXPECT_TRUE(has(refused([](auto& p) { p.tolerance = 0.0; }), "tolerance"));
    EXPECT_TRUE(has(refused([](auto& p) { p.iterations = -1; }), "iterations"));
    EXPECT_TRUE(has(refused([](auto& p) { p.passes = -1; }), "passes"));
    EXPECT_TRUE(has(refused([](auto& p) { p.sigma_cells = -1.0; }), "sigma"));
    EXPECT_TRUE(has(refused([](auto& p) { p.noise_m = -1.0; }), "noise"));
    EXPECT_TRUE(has(refused([](auto& p) { p.noise_cells = 0.5; }), "noise"));
}

TEST(Diffuse, AllSkeleton) {
    Skeleton const land{Raster<float>(test::frame_below(3, 2), -0.0F)};
    for (DiffuseParams const& params : {DiffuseParams{}, sweeps(10)}) {
        EXPECT_TRUE(same_bits(diffuse(land, params).dem, land.z));
    }
}

TEST(Diffuse, PartsWithoutASkeletonStayEmpty) {
    Skeleton land{Raster<float>(test::frame_below(9, 5), valleys::nan)};
    land.z[{1, 2}] = 7.0F;
    land.z[{4, 2}] = 9.0F; // outside: does not count
    Mask inside(land.z.grid(), 1);
    for (std::int64_t row = 0; row < 5; ++row) {
        inside[{4, row}] = 0;
    }
    for (DiffuseParams const& params : {DiffuseParams{}, sweeps(10)}) {
        DiffusedDem const d = diffuse(land, inside, params);
        for (std::int64_t i = 0; i < d.dem.cells(); ++i) {
            Cell const c = d.dem.grid().at(i);
            EXPECT_TRUE(c.col < 4 ? d.dem[i] == 7.0F : std::isnan(d.dem[i])) << c.col << ' ' << c.row;
        }
    }
}

TEST(Diffuse, KeepsSkeletonAndRange) {
    ASSERT_TRUE(rc::check("skeleton cells to the bit, all else between its lowest and highest", [] {
        Valley const valley = valleys::any(40);
        bool const walled = *rc::gen::element(false, true).as("walled");
        Mask const inside = walled ? valleys::barriers(valley, 0.3, 7) : Mask(valley.z.grid(), 1);
        DiffuseParams params = *rc::gen::element(0, 1).as("explicit") == 0 ? DiffuseParams{} : sweeps(7);
        params.sigma_cells = *rc::gen::element(0.0, 0.4, 1.0, 2.5).as("sigma");
        params.passes = *rc::gen::element(0, 1, 3).as("passes");
        DiffusedDem const d = diffuse(skeleton_of(valley), inside, params);
        float lowest = std::numeric_limits<float>::infinity();
        float highest = -lowest;
        for (std::int64_t i = 0; i < d.dem.cells(); ++i) {
            if (inside[i] != 0 && !std::isnan(valley.z[i])) {
                RC_ASSERT(std::bit_cast<std::uint32_t>(d.dem[i]) == std::bit_cast<std::uint32_t>(valley.z[i]));
                lowest = std::min(lowest, valley.z[i]);
                highest = std::max(highest, valley.z[i]);
            }
        }
        for (std::int64_t i = 0; i < d.dem.cells(); ++i) {
            RC_ASSERT(std::isnan(d.dem[i]) || (d.dem[i] >= lowest && d.dem[i] <= highest));
            RC_ASSERT(inside[i] != 0 || std::isnan(d.dem[i]));
        }
    }));
}

TEST(Diffuse, SweepsAreTheFormula) {
    ASSERT_TRUE(rc::check("U += alpha (sum of neighbours - n U), all cells at once", [] {
        Valley const valley = valleys::any(80);
        int const count = *rc::gen::inRange(0, 12).as("sweeps");
        double const alpha = *rc::gen::element(0.25, 0.1).as("alpha");
        Mask const inside = valleys::barriers(valley, 0.2, 3);
        DiffuseParams params = unsmoothed(sweeps(count, DiffusionStart::zero));
        params.alpha = alpha;
        Raster<float> const dem = diffuse(skeleton_of(valley), inside, params).dem;
        float lowest = std::numeric_limits<float>::infinity();
        float highest = -lowest;
        Grid const& grid = dem.grid();
        Raster<double> u(grid);
        for (std::int64_t i = 0; i < u.cells(); ++i) {
            if (inside[i] != 0 && !std::isnan(valley.z[i])) {
                u[i] = static_cast<double>(valley.z[i]);
                lowest = std::min(lowest, valley.z[i]);
                highest = std::max(highest, valley.z[i]);
            }
        }
        for (int sweep = 0; sweep < count; ++sweep) {
            Raster<double> next = u;
            for (std::int64_t i = 0; i < u.cells(); ++i) {
                Cell const c = grid.at(i);
                if (std::isnan(valley.z[i]) && inside[i] != 0) {
                    for (Cell const n :
                         {Cell{c.col - 1, c.row}, {c.col + 1, c.row}, {c.col, c.row - 1}, {c.col, c.row + 1}}) {
                        next[i] += grid.contains(n) && inside[n] != 0 ? alpha * (u[n] - u[i]) : 0.0;
                    }
                }
            }
            u = next;
        }
        for (std::int64_t i = 0; i < u.cells(); ++i) {
            double const in_range = std::clamp(u[i], static_cast<double>(lowest), static_cast<double>(highest));
            RC_ASSERT((std::isnan(dem[i]) || std::fabs(static_cast<double>(dem[i]) - in_range) <= 1e-5));
        }
    }));
}

TEST(Diffuse, SweepsTendToTheSteadyState) {
    Skeleton const skeleton = skeleton_of(valleys::by_chance(64, 64, 0.01, 12));
    Raster<float> const steady = diffuse(skeleton, unsmoothed()).dem;
    double before = std::numeric_limits<double>::infinity();
    for (int const count : {10, 100, 1000}) {
        for (DiffusionStart const start : {DiffusionStart::zero, DiffusionStart::coarse}) {
            DiffusedDem const d = diffuse(skeleton, unsmoothed(sweeps(count, start)));
            EXPECT_LT(d.residual, before) << count;
            before = start == DiffusionStart::zero ? before : d.residual;
            EXPECT_EQ(d.iterations, count);
        }
    }
    Raster<float> const sweeping = diffuse(skeleton, unsmoothed(sweeps(30000, DiffusionStart::zero))).dem;
    for (std::int64_t i = 0; i < steady.cells(); ++i) {
        EXPECT_NEAR(sweeping[i], steady[i], 1e-6);
    }
}

TEST(Diffuse, EqualHeightsMakeAPlain) {
    Valley valley = valleys::by_chance(90, 60, 0.01, 5);
    for (float& z : valley.z.values()) {
        z = std::isnan(z) ? z : 123.4F;
    }
    for (DiffuseParams const& params : {DiffuseParams{}, sweeps(50)}) {
        DiffusedDem const d = diffuse(skeleton_of(valley), params);
        EXPECT_EQ(std::count(d.dem.values().begin(), d.dem.values().end(), 123.4F), d.dem.cells());
    }
}

TEST(Diffuse, LastSweepsTakeTheSeam) {
    Skeleton land{Raster<float>(test::frame_below(41, 41), valleys::nan)};
    for (std::int64_t i = 0; i < land.z.cells(); ++i) {
        land.z[i] = land.z.grid().on_border(land.z.grid().at(i)) ? 0.0F : land.z[i];
    }
    land.z[{20, 20}] = 100.0F;
    Raster<float> const sharp = diffuse(land, unsmoothed()).dem;
    Raster<std::uint8_t> kind(land.z.grid(), 1);
    Raster<double> averaged(land.z.grid());
    for (std::int64_t i = 0; i < kind.cells(); ++i) {
        kind[i] = std::isnan(land.z[i]) ? 1 : 2;
        averaged[i] = static_cast<double>(sharp[i]);
    }
    DiffuseParams params;
    params.passes = 3;
    for (int pass = 0; pass < params.passes; ++pass) {
        smooth_free(kind, params.sigma_cells, averaged, on_threads(1));
    }
    Raster<float> const soft = diffuse(land, params).dem;
    Cell const beside{21, 20};
    EXPECT_LT(averaged[beside], sharp[beside] - 5.0F); // a wall around the peak
    EXPECT_NEAR(soft[beside], sharp[beside], 1.0F);
    EXPECT_LT(soft[beside], sharp[beside]);
}

TEST(SmoothFree, IsTheMeanOfTheCellsThere) {
    Raster<std::uint8_t> kind(test::frame_below(5, 1), 1);
    kind[0] = 2;
    kind[3] = 0;
    Raster<double> value(kind.grid(), 1.0);
    value[0] = 5.0;
    value[3] = 1e9;
    smooth_free(kind, 1.0, value, on_threads(1));
    double const near = portable::exp(-0.5);
    double const far = portable::exp(-2.0);
    EXPECT_EQ(value[0], 5.0);
    EXPECT_NEAR(value[1], (1.0 + near + near * 5.0 + portable::exp(-4.5)) / (1.0 + 2.0 * near + portable::exp(-4.5)),
                1e-12);
    EXPECT_NEAR(value[2], (1.0 + near + far + far * 5.0) / (1.0 + near + 2.0 * far), 1e-12);
    EXPECT_EQ(value[3], 1e9);
}

TEST(ValueNoise, IsSmoothAndFillsItsRange) {
    double least = 1.0;
    double greatest = -1.0;
    for (std::int64_t row = 0; row < 200; ++row) {
        for (std::int64_t col = 0; col < 200; ++col) {
            double const here = value_noise(3, {col, row}, 8.0);
            least = std::min(least, here);
            greatest = std::max(greatest, here);
            EXPECT_LE(std::fabs(value_noise(3, {col + 1, row}, 8.0) - here), 2.0 * 1.5 / 8.0);
        }
    }
    EXPECT_GE(least, -1.0);
    EXPECT_LT(least, -0.8);
    EXPECT_LE(greatest, 1.0);
    EXPECT_GT(greatest, 0.8);
}

TEST(Diffuse, NoiseVanishesAtTheSkeleton) {
    Skeleton land{Raster<float>(test::frame_below(60, 50), valleys::nan)};
    land.z[{0, 25}] = 0.0F;
    DiffuseParams params;
    params.noise_m = 10.0;
    Raster<float> const dem = diffuse(land, params).dem;
    EXPECT_EQ((dem[{0, 25}]), 0.0F);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        double const d = std::sqrt(static_cast<double>(c.col * c.col + (c.row - 25) * (c.row - 25)));
        double const expected = 10.0 * (1.0 - portable::exp(-d / 4.0)) * value_noise(1, c, 8.0);
        EXPECT_NEAR(dem[i], i == dem.grid().index({0, 25}) ? 0.0 : expected, 1e-5);
    }
}

TEST(Diffuse, SameBytesForAnyThreads) {
    Skeleton const skeleton = skeleton_of(valleys::by_chance(300, 211, 0.01, 6));
    for (DiffuseParams params : {DiffuseParams{}, sweeps(33)}) {
        params.noise_m = 2.0;
        Raster<float> const one = diffuse(skeleton, params, on_threads(1)).dem;
        for (int const threads : {2, 5}) {
            EXPECT_TRUE(same_bits(diffuse(skeleton, params, on_threads(threads)).dem, one));
        }
    }
}

TEST(Diffuse, StopsWhenAsked) {
    std::stop_source stopped;
    stopped.request_stop();
    thalweg::Run run;
    run.stop = stopped.get_token();
    Skeleton const skeleton = skeleton_of(valleys::by_chance(30, 30, 0.05, 6));
    EXPECT_THROW(diffuse(skeleton, {}, run), Cancelled);
    EXPECT_THROW(diffuse(skeleton, sweeps(10), run), Cancelled);
}

TEST(Harmonic, RefusesWhatHasNoHeights) {
    EXPECT_THROW(harmonic(Valley{}), BadInput);
    Valley dry{Raster<float>(test::frame_below(5, 5), valleys::nan)};
    EXPECT_THROW(harmonic(dry), BadInput);
    dry.z[{3, 1}] = std::numeric_limits<float>::infinity();
    auto const text = full_message_of<BadInput>([&] { harmonic(dry); });
    EXPECT_TRUE(test::has(text, "surface.harmonic", "column 3, row 1"));
    dry.z[{3, 1}] = 1.0F;
    EXPECT_THROW(harmonic(dry, Mask(test::frame_below(4, 5), 1)), BadInput);
    EXPECT_THROW(harmonic(dry, Mask(test::frame_below(5, 5), 0)), BadInput);
}

TEST(Harmonic, ATighterToleranceIsNearerToTheEnd) {
    Valley valley{Raster<float>(test::frame_below(200, 150), valleys::nan)};
    valley.z[{3, 1}] = 0.0F;
    valley.z[{190, 140}] = 1000.0F;
    Raster<float> const end = harmonic(valley, {}, HarmonicParams{1e-12});
    auto const off = [&](double tolerance) {
        Raster<float> const e = harmonic(valley, {}, HarmonicParams{tolerance});
        double most = 0.0;
        for (std::int64_t i = 0; i < e.cells(); ++i) {
            most = std::max(most, static_cast<double>(std::fabs(e[i] - end[i])));
        }
        return most;
    };
    EXPECT_LT(off(1e-10), 1e-4); // as printed: floats of 1000 m end at 6e-5
    EXPECT_GT(off(1e-2), 10.0 * off(1e-8));
    EXPECT_THROW(harmonic(valley, {}, HarmonicParams{0.0}), BadParameter);
}

TEST(Harmonic, IsTheMeanOfTheNeighbours) {
    ASSERT_TRUE(rc::check("valley exact, every other reached cell the mean of its neighbours inside", [] {
        Valley const valley = valleys::any(40);
        Mask const inside = valleys::barriers(valley, 0.2, 9);
        Raster<float> const e = harmonic(valley, inside);
        Expansion const reached = expand_frontier(valley, inside);
        for (std::int64_t i = 0; i < e.cells(); ++i) {
            RC_ASSERT(std::isnan(e[i]) == (reached.level[i] < 0));
            if (reached.level[i] == 0) {
                RC_ASSERT(std::bit_cast<std::uint32_t>(e[i]) == std::bit_cast<std::uint32_t>(valley.z[i]));
            } else if (reached.level[i] > 0) {
                double sum = 0.0;
                double count = 0.0;
                Cell const c = e.grid().at(i);
                for (Cell const n :
                     {Cell{c.col - 1, c.row}, {c.col + 1, c.row}, {c.col, c.row - 1}, {c.col, c.row + 1}}) {
                    if (e.grid().contains(n) && inside[n] != 0) {
                        sum += static_cast<double>(e[n]);
                        count += 1.0;
                    }
                }
                RC_ASSERT(std::fabs(sum / count - static_cast<double>(e[i])) <= 1e-4);
            }
        }
    }));
}

TEST(Harmonic, LeavesNoScarpsOnRidges) {
    Valley const valley = grown();
    double const increment = 0.1 * valley.z.grid().cell_m; // uniform
    Expansion const paper = expand(valley);
    Raster<float> const base = harmonic(valley);
    Raster<double> on_paper(valley.z.grid());
    Raster<double> on_harmonic(valley.z.grid());
    for (std::int64_t i = 0; i < base.cells(); ++i) {
        double const rise = increment * static_cast<double>(paper.level[i]);
        on_paper[i] = static_cast<double>(paper.base[i]) + rise;
        on_harmonic[i] = static_cast<double>(base[i]) + rise;
        EXPECT_TRUE(paper.level[i] > 0 || base[i] == valley.z[i]);
    }
    Scarps const before = scarps_of(on_paper, increment);
    Scarps const after = scarps_of(on_harmonic, increment);
    std::printf("%lld x %lld cells: scarps %.3f %% -> %.4f %%, greatest step %.2f -> %.2f m\n",
                static_cast<long long>(base.width()), static_cast<long long>(base.height()), 100.0 * before.share,
                100.0 * after.share, before.greatest, after.greatest);
    EXPECT_GT(before.share, 0.01);
    EXPECT_LE(after.share, 0.0002);
    EXPECT_LE(after.greatest, 0.15 * before.greatest);
}

} // namespace diffusion_test
