// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/pipeline/recipe/internal/key_rows.hpp>

/// The keys of each section and of its parts, in the order of recipe files. Private to this module.
namespace thalweg::pipeline {

Rows<Recipe> seed_keys();
Rows<GridRecipe> grid_keys();
Rows<NetworkRecipe> network_keys();
Rows<NetworkRecipe> dla_keys();
Rows<TokunagaRecipe> tokunaga_keys();
Rows<ForestRecipe> forest_keys();
Rows<LinesRecipe> lines_keys();
Rows<SkeletonRecipe> skeleton_keys();
Rows<SurfaceRecipe> surface_keys();
Rows<surface::DilateParams> dilation_keys();
Rows<EquilibriumRecipe> equilibrium_keys();
Rows<surface::DiffuseParams> diffusion_keys();
Rows<skeleton::RegressParams> regression_keys();
Rows<StatisticsRecipe> statistics_keys();
Rows<DetailRecipe> detail_keys();
Rows<PatchRecipe> patch_keys();
Rows<OutputRecipe> output_keys();

} // namespace thalweg::pipeline
