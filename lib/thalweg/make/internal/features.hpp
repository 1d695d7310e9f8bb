// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/surface/equilibrium/features.hpp>

namespace thalweg::make {

/// The cells that points and ridges lie in: the highest point of a cell, else its highest ridge.
std::vector<surface::FeatureCell> feature_cells(FeaturePoints const& points, RiverLines const& ridges,
                                                Grid const& grid);

/// Given ridges with heights everywhere: those without rise from the nearest river by skeleton.ridge_gain.
RidgeLines ridges_with_heights(RiverLines const& lines, recipe::SkeletonRecipe const& wanted, Valley const& valley,
                               Run const& run);

/// Ridges as the points of a skeleton, one a cell.
FeaturePoints as_points(RidgeLines const& ridges, Grid const& grid);

/// Given ridges with the heights that the terrain has there.
RidgeLines ridges_on(RiverLines const& lines, Raster<float> const& dem);

} // namespace thalweg::make
