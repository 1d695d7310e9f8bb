// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/valley.hpp>

/// Private to this module.
namespace thalweg::flow {

enum class Lakes : std::uint8_t { level, slope };

/// Raises a framed DEM (framed.hpp) to the water of its lakes, level or sloping by small steps towards their outlets.
/// Water leaves at the border, into no data and into river cells (those with a height in the framed valley).
void flood(Raster<float>& land, Raster<float> const& rivers, Lakes lakes, Run const& run);

/// Throws: BadInput: different frames, no cells, an infinite height, a river cell without land.
void check_drainable(Raster<float> const& dem, Valley const& valley);

} // namespace thalweg::flow
