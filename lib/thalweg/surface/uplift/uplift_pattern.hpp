// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

// Idea: Mountains differ over tens of kilometres because uplift does. Four patterns, as shares of
// the range from the least to the greatest uplift: a plane across the strike (tilt), random domes
// on a jittered lattice, blocks between faults that each tilt one way, and cosine folds. Faults and
// folds bend by smooth noise along the strike. The share becomes a factor of uplift from 1 /
// sqrt(contrast) to sqrt(contrast).
// Source: ours (docs/equilibrium.md, surface.uplift_pattern).
// Cost: O(cells), each cell alone. Rows run on all cores.
// Not for: tectonics: nothing moves sideways, faults do not slip. Measured uplift is a raster of
// its own (EquilibriumFields::uplift).
// Example:
//     EquilibriumFields fields;
//     fields.uplift = uplift_pattern(grid, {.pattern = UpliftPattern::blocks, .contrast = 3.0});

namespace thalweg::surface {

/// How uplift varies over tens of kilometres.
enum class UpliftPattern : std::uint8_t {
    tilt,   ///< it grows across the strike, from one side of the grid to the other
    domes,  ///< domes at random positions
    blocks, ///< blocks between faults along the strike, each tilted across it
    folds,  ///< anticlines and synclines along the strike
    seed    ///< domes, blocks or folds, by the seed
};

/// Options of uplift_pattern().
struct UpliftPatternParams {
    UpliftPattern pattern = UpliftPattern::tilt;
    double contrast = 4.0;    ///< [1, 100] largest over least uplift
    double wave_m = 12'000.0; ///< [m] > 0, distance of domes, width of blocks or wavelength of folds
    double strike_deg = 0.0;  ///< [degrees] clockwise from north; domes have none
    std::uint64_t seed = 7;
};

/// The random strike of a seed, used if none is given.
/// \param seed random seed
/// \return [degrees] (-90, 90] clockwise from north
double random_strike_deg(std::uint64_t seed);

/// The pattern that a seed chooses.
/// \param seed random seed
/// \return domes, blocks or folds, each as likely
UpliftPattern uplift_pattern_of_seed(std::uint64_t seed);

/// Draws uplift that varies over long distances.
/// \param grid cells
/// \return [1 / sqrt(contrast), sqrt(contrast)] by cell, relative to the mean uplift. The same bytes for any number of
/// threads; depends on positions in metres from the grid's centre.
/// \throws BadParameter when a parameter is outside its range
Raster<float> uplift_pattern(Grid const& grid, UpliftPatternParams const& params, Run const& run = {});

} // namespace thalweg::surface
