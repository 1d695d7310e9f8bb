// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/equilibrium_law.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// One sweep of Gauss and Seidel over the land, receivers first: each cell to the height at which what is lifted equals
/// what water and creep take away.
/// Gives: each cell above its receiver by least_tangent at least and its cap at most (banks may have to stand higher:
/// above every river cell beside them).
void relax_land(LandLevel& level, EquilibriumLaw const& law);

} // namespace thalweg::surface
