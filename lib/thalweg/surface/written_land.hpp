// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/channels.hpp>
#include <thalweg/surface/equilibrium.hpp>
#include <thalweg/surface/land_level.hpp>

/// Private to this room.
namespace thalweg::surface {

/// The caller's grid out of a solved finest level, in metres, with the ways of its water. Tips that are still perched
/// are given up besides those that are shortened already.
EquilibriumLand written_land(LandLevel level, Channels const& rivers, Mask const& land, EquilibriumParams const& params,
                             std::int64_t margin, std::vector<std::int64_t> shortened, Run const& run);

} // namespace thalweg::surface
