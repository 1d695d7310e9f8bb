// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/recipe/recipe.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

/// The steps of land without rivers. Private to this module.
namespace thalweg::pipeline {

inline constexpr double default_length_cells = 20.0;
inline constexpr double default_dimension = 2.4;
inline constexpr double default_std_m = 100.0;

/// What [statistics] asks for, nothing where there is none.
StatisticsRecipe const& asked(Recipe const& recipe);

/// The mean height asked for, or the middle between the extremes.
double mean_of(StatisticsRecipe const& s);

/// How heights go together in a land of these statistics, on cells so many times larger.
solver::StableCovariance covariance_of(StatisticsRecipe const& s, double step);

/// A random land by this prior, on cells that detail will halve so many times.
Raster<float> random_land(Recipe const& recipe, Prior prior, Grid const& coarse, int levels, Run const& run);

/// The points that the land goes through: those of the file, or drawn at random with the extremes among them.
skeleton::Scattered points_of(Recipe const& recipe, Grid const& grid, FeaturePoints const& given, Run const& run);

/// Land through points, and what it was made with.
struct LandOfPoints {
    Raster<float> land;
    std::optional<Tin> tin = {};
    std::optional<SolverStory> diffusion = {};
};

/// Takes: grid: that of the land, whose cells may be coarser than the recipe's, of cell_m.
LandOfPoints land_of_points(Recipe const& recipe, double cell_m, FeaturePoints const& points, Grid const& grid,
                            Run const& run);

/// Throws, before any work, where the statistics cannot be reached on this grid; says which lengths only a fit can
/// tell.
void require_targets(StatisticsRecipe const& wanted, Grid const& grid, Run const& run);

/// A land projected on the statistics.
struct Brought {
    fractal::MatchedDem projection;
    double fine_forms_cells = 0.0; ///< [cells] as Terrain
};

/// Projects a land on the statistics. One from which they cannot be reached, smoother or more jagged between neighbours
/// than they ask for, takes its fine forms from a Gaussian land: as few of them as will do. given: points whose heights
/// stay.
Brought brought_to_statistics(Recipe const& recipe, Raster<float> land, FeaturePoints const& given, Run const& run);

/// Whether the statistics came out as they were asked for.
std::vector<Check> residual_checks(fractal::MatchedDem const& projection);

} // namespace thalweg::pipeline
