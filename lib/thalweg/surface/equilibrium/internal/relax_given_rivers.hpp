// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/equilibrium_law.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Sets rivers to the heights that are asked; between them they are graded, as steep as it takes; above the highest as
/// the rest of the land. Fixed: kept, but for the least rise that a float knows. Soft: lowered where the land beside is
/// lower, or where it takes that for water to run.
void relax_given_rivers(LandLevel& level, EquilibriumLaw const& law, RiverHeights heights);

} // namespace thalweg::surface
