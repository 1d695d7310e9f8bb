// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/diffusion/diffusion.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>
#include <thalweg/network/vectorise/prune.hpp>
#include <thalweg/network/vectorise/rasterise.hpp>
#include <thalweg/network/vectorise/vectorise.hpp>
#include <thalweg/pipeline/plan/frame.hpp>
#include <thalweg/surface/dilation/dilation.hpp>

#include "valleys.hpp"

namespace harmonic_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

using test::full_message_of;

TEST(Harmonic, RefusesWhatHasNoHeights) {
    EXPECT_THROW(harmonic(Valley{}), BadInput);
    Valley dry{Raster<float>(test::frame_below(5, 5), valleys::nan)};
    EXPECT_THROW(harmonic(dry), BadInput);
    dry.z[{3, 1}] = std::numeric_limits<float>::infinity();
    auto const text = full_message_of<BadInput>([&] { harmonic(dry); });
    EXPECT_NE(text.find("surface.harmonic"), std::string::npos) << text;
    EXPECT_NE(text.find("column 3, row 1"), std::string::npos) << text;
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

/// A valley of the first paper: the longest branch of a cluster grown at random, raised upstream.
Valley grown() {
    network::Branch const branch = network::pick_branch(network::grow_dla({.particles = 8000}));
    pipeline::FramedBranch const framed = pipeline::frame_branch(branch, {});
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

} // namespace

} // namespace harmonic_test
