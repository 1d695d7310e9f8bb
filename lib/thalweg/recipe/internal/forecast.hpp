// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// The cells of a grid, or an estimate where it depends on a cluster that must be grown first.
std::int64_t cells_of(Recipe const& recipe, std::optional<Grid> const& grid);

/// What the stages that run are expected to take on one core of 2020, and last their files: "write".
/// \param recipe with its defaults
/// \param lines of the rivers' file
Timings expected_times(Recipe const& recipe, RiverLines const& lines, std::int64_t cells);

/// Requires that the memory which a terrain is expected to take is free.
/// \param recipe with its defaults
/// \param lines of the rivers' file
/// \throws BadInput when it is not
void require_memory(Recipe const& recipe, RiverLines const& lines, Grid const& grid);

} // namespace thalweg::recipe
