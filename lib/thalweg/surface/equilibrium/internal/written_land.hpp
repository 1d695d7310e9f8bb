// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/channels.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// The caller's grid within the finest level.
struct Window {
    Grid const& grid;
    Mask const& land;    ///< without cells: all
    std::int64_t margin; ///< [cells] without the frame
};

/// From the solver's heights to metres: base_m + metres * z.
struct Raise {
    double metres;
    double base_m;
    double mean_tangent; ///< of the mean slope of the land in metres
};

/// What gives the land in a window the relief or the mean slope that is asked, the lowest river end at 0.
Raise raise_for(LandLevel const& level, Channels const& rivers, Window const& window, EquilibriumParams const& params);

/// What the land in a window has of the relief or the mean slope that is asked, with heights of so many metres.
double share_of_target(LandLevel const& level, Window const& window, double metres, EquilibriumParams const& params);

/// The caller's grid out of a solved finest level, in metres, with the ways of its water. Tips that are still perched
/// are given up besides those that are shortened already, unless heads are kept.
EquilibriumTerrain written_land(LandLevel level, Channels const& rivers, Window const& window, Raise const& raise,
                                std::vector<std::int64_t> shortened, Heads heads, Run const& run);

/// The same with rivers at the heights that are given, or below them; tells which stand on walls and what was lowered.
EquilibriumTerrain written_given_land(LandLevel level, Channels const& rivers, Window const& window, Raise const& raise,
                                      RiverHeights heights, Run const& run);

} // namespace thalweg::surface
