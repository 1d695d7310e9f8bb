// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/make/internal/ground.hpp>

namespace thalweg::make {

/// Throws, before any work, when the statistics of a recipe cannot be reached on a grid.
/// \return warnings of lengths that only a fit can determine
std::vector<Finding> require_targets(recipe::Recipe const& recipe, Grid const& grid);

/// A surface with fractal detail, where the recipe asks for it: around rivers none in the valleys, all of it some
/// cells away; without rivers between the cells of the coarse surface. Without rivers it is then matched to the
/// statistics that are asked for, or loses heights where surface.source and surface.mask have none.
/// \param in of which the surface was made
Surface refined(Surface surface, GroundInput const& in, Run const& run);

} // namespace thalweg::make
