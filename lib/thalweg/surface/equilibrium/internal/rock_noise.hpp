// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

struct RockNoise {
    double longest_wave = 360.0; ///< [finest cells]
    double stretch = 1.0;        ///< along the strike over across it
    double strike = 0.0;         ///< [radians] anticlockwise from east
    std::uint64_t seed = 0;
};

/// Smooth noise of mean 0: value noise on lattices from the longest wave down to two cells, each half as wide as the
/// one before, a little stronger and turned against it, all stretched along the strike; without the waves that a
/// level's cells cannot show. The variance of the first eight lattices is about 1. Gives: a number a cell, by place and
/// seed alone.
Cells<float> rock_noise(LandLevel const& level, RockNoise const& params, Run const& run);

} // namespace thalweg::surface
