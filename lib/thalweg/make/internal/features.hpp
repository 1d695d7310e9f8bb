// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/recipe/plan.hpp>
#include <thalweg/surface/equilibrium/features.hpp>

namespace thalweg::make {

/// The cells that points and ridges of a plan lie in: the highest point of a cell, else its highest ridge.
std::vector<surface::FeatureCell> feature_cells(recipe::Plan const& plan, Grid const& grid);

/// The ridges of a plan with heights everywhere: those without rise from the nearest river by skeleton.ridge_gain.
RidgeLines ridges_with_heights(recipe::Plan const& plan, Valley const& valley, Run const& run);

/// Ridges as the points of a skeleton, one a cell.
FeaturePoints as_points(RidgeLines const& ridges, Grid const& grid);

/// The ridges of a plan with the heights that the terrain has there.
RidgeLines ridges_on(recipe::Plan const& plan, Raster<float> const& dem);

} // namespace thalweg::make
