// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/equilibrium_law.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Makes rock firmer along the flow paths from beside rivers whose heights the land there lacks, so that the land comes
/// up to them and they need no walls: the divide between a long river and a short one lies beside the long one's head.
void firm_rock(LandLevel& level, EquilibriumLaw const& law);

/// Rock as firm as on the coarser level, before the first round.
void take_firmness(LandLevel& level, LandLevel const& coarser);

} // namespace thalweg::surface
