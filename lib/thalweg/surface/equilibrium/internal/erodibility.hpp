// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>

// Uplift and erodibility of a level's cells. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

struct ErodibilityNoise {
    double longest_wave = 360.0; ///< [finest cells]
    int octaves = 8;             ///< from the longest wave, whose variances add up to 1
    double stretch = 1.0;        ///< ratio of lengths along and across the strike
    double strike = 0.0;         ///< [radians] anticlockwise from east
    std::uint64_t seed = 0;
};

/// Fields on the caller's grid, each divided by its mean over land; without cells: none. Values at the border continue
/// beyond the grid.
struct ErodibilityFields {
    Raster<float> uplift;
    Raster<float> erodibility;
};

struct ErodibilityParams {
    double roughness = 0.0; ///< standard deviation of log erodibility
    ErodibilityNoise noise; ///< in finest cells
};

/// Sets erodibility, the cap on slopes and uplift of a level's cells: means of the given fields over each cell, and
/// noise on land (river cells get the mean). Slopes may be steeper at lower erodibility.
void set_erodibility(TerrainLevel& level, ErodibilityFields const& fields, ErodibilityParams const& params,
                     Run const& run);

/// Lowers erodibility along flow paths beside rivers whose heights the terrain there does not reach, so that the
/// terrain rises to them and they need no walls: the divide between a long and a short river lies close to the head of
/// the long one.
/// \param firmest [log] the largest decrease
void reduce_erodibility(TerrainLevel& level, EquilibriumLaw const& law, float firmest);

/// Makes the rock of a cell firmer by some [log], with steeper slopes; below 0 softer. A river's cell stays.
void add_firmness(TerrainLevel& level, std::size_t i, float more);

/// The same on the lower sides of crests; on the higher ones it increases.
void change_erodibility_at_crests(TerrainLevel& level, Run const& run);

/// Copies the reduced erodibility of the coarser level, before the first round.
void copy_firmness(TerrainLevel& level, TerrainLevel const& coarser);

} // namespace thalweg::surface
