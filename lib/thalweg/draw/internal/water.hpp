// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/draw/internal/canvas.hpp>
#include <thalweg/draw/internal/map.hpp>

namespace thalweg::draw {

// Sea and lakes of a map.

/// Traces the shores of water. A shore is smoothed by a cell; water goes on beyond the grid as on its border.
/// \param water its cells
/// \return [m] in plan; beyond the grid they close far off it
Shores shores(Mask const& water);

/// The cells without a height.
Mask holes_of(Raster<float> const& dem);

inline constexpr Colour shallow_sea{0.84, 0.92, 0.96};
inline constexpr Colour deep_sea{0.66, 0.81, 0.90};
inline constexpr Colour lake_colour{0.74, 0.87, 0.94};

/// Colours the sea: pale at the shore, deeper blue with the distance from it.
/// \param sea its cells
/// \return a coarse image, opaque everywhere
Relief sea_depths(Mask const& sea);

/// Draws water up to its shores, with a fine shoreline.
/// \param depths null: of one colour
void draw_water(Cairo* canvas, Shores const& on_sheet, Relief const* depths, Box where, double px_per_cell,
                double unit);

} // namespace thalweg::draw
