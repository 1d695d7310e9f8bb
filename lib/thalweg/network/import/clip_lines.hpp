// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>

namespace thalweg::network {

/// Clips lines to a grid.
/// \param lines polylines [m]
/// \param grid clips at its outer edge
/// \return the parts inside, in order; a line that leaves and returns becomes several with the same feature. Vertices
/// inside are kept bit for bit; new ones lie exactly on the edge, with interpolated heights. What lies beyond the edge
/// is added to `secondary`.
RiverLines clip_lines(RiverLines const& lines, Grid const& grid);

} // namespace thalweg::network
