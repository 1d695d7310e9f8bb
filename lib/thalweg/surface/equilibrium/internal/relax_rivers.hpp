// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/equilibrium_law.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Sets rivers to their graded heights for the areas that drain into them: not steeper than a share of what hillslopes
/// may be, and not above the land two cells away, which would leave them perched. Lakes are level.
void relax_rivers(LandLevel& level, EquilibriumLaw const& law);

} // namespace thalweg::surface
