// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/internal/edge_heights.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>
#include <thalweg/surface/equilibrium/internal/nearest_river.hpp>

/// Private to this module.
namespace thalweg::surface {

/// First heights of the coarsest level: a gentle rise away from where water leaves, and chance.
void start_from_nothing(LandLevel& level, NearestRiver const& near, std::uint64_t seed, Run const& run);

/// First heights of a level: between those of the coarser one, and chance.
void start_from(LandLevel& level, LandLevel const& coarse, std::uint64_t seed, Run const& run);

/// Sets the heights that are not free: sea, what is outside, and rivers that rise from their ends by little. end_z: by
/// river cell, of those that end; empty: 0.
void start_rivers(LandLevel& level, std::vector<float> const& end_z = {});

} // namespace thalweg::surface
