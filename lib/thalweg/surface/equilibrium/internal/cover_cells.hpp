// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Land of a level inside its frame, 1 where at least half of the cells it stands for are land; without cells: all.
Mask coarsened(Mask const& land);

/// Says what each cell of a level is, from its rivers, the land (inside the frame; without cells: all) and the edge.
/// With banks: cells beside rivers are banks.
enum class RiverBanks : std::uint8_t { none, kept };
void cover_cells(LandLevel& level, Mask const& land, Edge edge, RiverBanks banks);

} // namespace thalweg::surface
