// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// The recipe with the CRS of its grid, which a region may give.
Recipe on_crs_of_region(Recipe recipe);

/// The land of a recipe with its CRS: the region's polygons, an island, or all of the grid; and its outlets.
ForestLand forest_land(Recipe const& recipe, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
