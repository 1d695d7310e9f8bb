// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/land_level.hpp>
#include <thalweg/surface/equilibrium/internal/rock_noise.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Fields inside the frame of the finest level, each divided by its mean over the land; without cells for none.
struct RockFields {
    Raster<float> uplift;
    Raster<float> erodibility;
    std::int64_t margin = 0; ///< [cells] by which they go beyond the caller's grid on each side
};

struct RockParams {
    double roughness = 0.0; ///< standard deviation of log erodibility
    RockNoise noise;        ///< in finest cells
};

/// Sets erodibility, the cap on slopes and uplift of a level's cells: the given fields' means over each cell, and noise
/// on land (rivers go their even way). The less erodible, the steeper rock may stand.
void set_rock(LandLevel& level, RockFields const& fields, RockParams const& params, Run const& run);

} // namespace thalweg::surface
