// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/internal/extract_terrain.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>
#include <thalweg/surface/strata/strata.hpp>

// A stack of layers as a level's cells meet it. See docs/algorithms/equilibrium_layers.md.

namespace thalweg::surface {

/// The layers of a level in the solver's units.
/// \param grid the caller's
/// \param most [m] greatest height of land
LevelLayers level_layers(TerrainLevel const& level, Strata const& strata, Grid const& grid,
                         HeightConversion const& conversion, double most, Run const& run);

} // namespace thalweg::surface
