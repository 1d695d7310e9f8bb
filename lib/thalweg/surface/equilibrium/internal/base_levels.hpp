// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/level.hpp>

// Rivers and valleys beside much lower ones. See docs/algorithms/equilibrium_levels.md.

namespace thalweg::surface {

/// Makes rivers less steep, from their ends up, that stand above what the land between them and the sea or another
/// river holds: that land is a wall otherwise. What has been too much returns little by little.
void ease_rivers(TerrainLevel& level, EquilibriumLaw const& law);

/// Copies the grade of the coarser level's rivers, before the first round.
void copy_grade(TerrainLevel& level, TerrainLevel const& coarser);

/// Makes rock softer below large valleys that no river of the level drains and that lie farther from rivers than these
/// from each other: neighbouring basins have rivers of their own, as low as boundary valleys there (Beyond::valleys).
void soften_valleys_beyond(TerrainLevel& level);

} // namespace thalweg::surface
