// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/grid.hpp>
#include <thalweg/core/river_lines.hpp>

namespace thalweg::network {

/// Cuts lines at the edge of a grid.
/// \param lines the polylines
/// \param grid the grid
/// \return the parts inside, in their order; a line that leaves and returns becomes several with the same feature.
/// Vertices inside are kept bit for bit; those on the edge lie on it exactly, with Z interpolated.
RiverLines clip_lines(RiverLines const& lines, Grid const& grid);

} // namespace thalweg::network
