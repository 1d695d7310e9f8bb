// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/land_level.hpp>
#include <thalweg/surface/equilibrium/internal/rock_noise.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Fields on the caller's grid, each divided by its mean over the land; without cells for none. Beyond the grid they
/// are as at its border.
struct RockFields {
    Raster<float> uplift;
    Raster<float> erodibility;
};

struct RockParams {
    double roughness = 0.0; ///< standard deviation of log erodibility
    RockNoise noise;        ///< in finest cells
};

/// Sets erodibility, the cap on slopes and uplift of a level's cells: the given fields' means over each cell, and noise
/// on land (rivers go their even way). The less erodible, the steeper rock may stand.
void set_rock(LandLevel& level, RockFields const& fields, RockParams const& params, Run const& run);

} // namespace thalweg::surface
