// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/match_statistics.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace fine_forms_test {

using namespace thalweg;

namespace {

Raster<float> rough(Grid const& grid, std::uint64_t seed) {
    Raster<float> land(grid);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] = static_cast<float>(100.0 * unit(random_word(seed, static_cast<std::uint64_t>(i))));
    }
    return land;
}

} // namespace

TEST(FineForms, RefuseWhatDoesNotFit) {
    Raster<float> const land(Grid{4, 3, 1.0, 0, 0, ""}, 1.0F);
    EXPECT_THROW(fractal::with_fine_forms(land, land, 0.0), BadParameter);
    EXPECT_THROW(fractal::with_fine_forms(land, Raster<float>(Grid{3, 4, 1.0, 0, 0, ""}), 1.0), BadInput);
    Raster<float> holed = land;
    holed[2] = NAN;
    EXPECT_THROW(fractal::with_fine_forms(land, holed, 1.0), BadInput);
}

TEST(FineForms, OfTheSameLandAreTheSameLand) {
    Raster<float> const land = rough({37, 5, 1.0, 0, 0, ""}, 1);
    Raster<float> const same = fractal::with_fine_forms(land, land, 3.0);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        EXPECT_NEAR(static_cast<double>(same[i]), static_cast<double>(land[i]), 1e-4);
    }
}

TEST(FineForms, MeansComeFromTheOneAndTheRestFromTheOther) {
    Grid const grid{40, 30, 1.0, 0, 0, ""};
    Raster<float> slope = test::raster_of(grid, [&](Cell c) { return 5 * c.col; });
    Raster<float> const other = rough(grid, 2);
    Raster<float> const mixed = fractal::with_fine_forms(slope, other, 2.0);
    // By the definition, one cell at a time, away from the border.
    for (Cell const c : {Cell{15, 12}, Cell{20, 17}}) {
        double sum = 0.0;
        double mean = 0.0;
        for (std::int64_t dr = -6; dr <= 6; ++dr) {
            for (std::int64_t dc = -6; dc <= 6; ++dc) {
                double const weight = std::exp(-0.125 * static_cast<double>(dr * dr + dc * dc));
                sum += weight;
                mean += weight * (static_cast<double>(slope[Cell{c.col + dc, c.row + dr}]) -
                                  static_cast<double>(other[Cell{c.col + dc, c.row + dr}]));
            }
        }
        EXPECT_NEAR(static_cast<double>(mixed[c]), mean / sum + static_cast<double>(other[c]), 1e-4);
    }
    // One cell is its own surroundings.
    Raster<float> const one(Grid{1, 1, 1.0, 0, 0, ""}, 7.0F);
    EXPECT_EQ(fractal::with_fine_forms(one, Raster<float>(one.grid(), 90.0F), 5.0)[0], 7.0F);
}

} // namespace fine_forms_test
