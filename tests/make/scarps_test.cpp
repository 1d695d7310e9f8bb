// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scarps at ridges, a fault of the first paper's dilation, on its own network, and what the harmonic base leaves.
#include <thalweg/make/make.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

namespace scarps_test {

using namespace thalweg;
using namespace thalweg::recipe;
using namespace thalweg::make;

namespace {

/// The network of samples/dla.toml in the first paper's units: cells of 1, valleys as steep as in the paper, increments
/// of 0.1 a dilation.
MakeResult on(Base base, double slope) {
    std::ifstream file(THALWEG_SOURCE_DIR "/samples/dla.toml");
    Recipe recipe = read_recipe(std::string(std::istreambuf_iterator<char>(file), {}), "dla.toml");
    recipe.grid.cell_m = 1.0;
    recipe.network->slope = slope;
    recipe.surface->base = base;
    recipe.surface->dilate.increment.increment = "uniform";
    recipe.surface->dilate.metric = surface::Metric::cityblock;
    recipe.surface->dilate.relief_m = 0.0;
    return make::make(recipe);
}

struct Scarps {
    double share = 0.0;    ///< of cells whose greatest step to a 4-neighbour is more than five increments
    double greatest = 0.0; ///< step
};

Scarps scarps_of(Raster<float> const& z) {
    constexpr double increment = 0.1;
    Scarps scarps;
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < z.cells(); ++i) {
        Cell const c = z.grid().at(i);
        double step = 0.0;
        for (Cell const n : {Cell{c.col - 1, c.row}, {c.col + 1, c.row}, {c.col, c.row - 1}, {c.col, c.row + 1}}) {
            step = z.grid().contains(n) ? std::max(step, static_cast<double>(std::fabs(z[n] - z[i]))) : step;
        }
        count += step > 5.0 * increment ? 1 : 0;
        scarps.greatest = std::max(scarps.greatest, step);
    }
    scarps.share = static_cast<double>(count) / static_cast<double>(z.cells());
    return scarps;
}

TEST(Scarps, TheHarmonicBaseLeavesNone) {
    constexpr double papers_slope = 0.087;
    MakeResult const before = on(Base::paper, papers_slope);
    MakeResult const after = on(Base::harmonic, papers_slope);
    ASSERT_EQ(after.terrain.grid.width, 1024);
    ASSERT_EQ(after.terrain.grid.height, 1024);
    ValleyCells const& valley = after.terrain.bed.valley;
    for (std::size_t i = 0; i < valley.cell.size(); ++i) {
        ASSERT_EQ(valley.z[i], after.terrain.ground.dem[valley.cell[i]]);
        ASSERT_EQ(valley.z[i], before.terrain.ground.dem[valley.cell[i]]);
    }
    Scarps const paper = scarps_of(before.terrain.ground.dem);
    Scarps const harmonic = scarps_of(after.terrain.ground.dem);
    EXPECT_GT(paper.share, 0.01);
    EXPECT_LE(harmonic.share, 0.0002);
    EXPECT_LE(harmonic.greatest, 0.15 * paper.greatest);
}

} // namespace

} // namespace scarps_test
