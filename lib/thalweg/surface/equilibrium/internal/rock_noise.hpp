// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

struct RockNoise {
    double longest_wave = 256.0; ///< [finest cells]
    double margin = 0.0;         ///< [finest cells] from the frame's inner side to the caller's grid
    std::uint64_t seed = 0;
};

/// Smooth noise of mean 0 and variance about 1: value noise on lattices from the longest wave down to two cells, each
/// half as wide as the one before and turned against it, all of one strength; without the waves that a level's cells
/// cannot show. Gives: a number a cell, by place and seed alone.
Cells<float> rock_noise(LandLevel const& level, RockNoise const& params, Run const& run);

} // namespace thalweg::surface
