// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

namespace thalweg::make {

inline constexpr double default_length_cells = 20.0;
inline constexpr double default_dimension = 2.4;
inline constexpr double default_std_m = 100.0;

/// The targets of [statistics]; empty: there are none.
recipe::StatisticsRecipe const& asked(recipe::Recipe const& recipe);

/// The target mean, or the middle between the extremes.
double mean_of(recipe::StatisticsRecipe const& s);

/// The covariance of terrain with these statistics, on cells larger by a factor.
solver::StableCovariance covariance_of(recipe::StatisticsRecipe const& s, double step);

/// Random terrain with this prior, on cells that detail will halve this many times.
Raster<float> random_land(recipe::Recipe const& recipe, recipe::Prior prior, Grid const& coarse, int levels,
                          Run const& run);

} // namespace thalweg::make
