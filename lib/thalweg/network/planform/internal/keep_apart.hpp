// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/network/planform/internal/meander.hpp>

/// A step of meander. Private to this module.
namespace thalweg::network {

/// Whether a point, or one that stems_of would set between it and the next of its river, lies in the sea. Takes: land
/// as too_near does.
bool leaves_land(Stems const& stems, std::vector<Vec2> const& at, std::size_t i, Mask const& land);

struct Gap {
    double gap_m = 0.0;
    double along_m = 0.0; ///< places of one river that are nearer to one another along it may come as near as they like
};

/// Points that came too near to a river's segment, and the upper points of these segments: both ascending.
/// Takes: land (1; sea 0), without cells where all is land; points as they were and as they are; a point is too near to
/// a segment of any river, its own included, when their distance is less than the gap and less than 0.6 of what it was;
/// or when it has left the grid or the land, or come nearer than a cell to the grid's edge.
std::vector<std::size_t> too_near(Stems const& stems, std::vector<Vec2> const& was, std::vector<Vec2> const& is,
                                  Grid const& grid, Mask const& land, Gap const& gap);

/// Where points go: by their share [0,1] of a shift; rivers that join others follow the place they end in.
std::vector<Vec2> shifted(Stems const& stems, std::vector<Vec2> const& at, std::vector<Vec2> const& shift,
                          std::vector<double> const& share, double cell_m);

/// Halves the shares of points, and by less those of their neighbours within a reach along the river; small ones
/// become 0. Gives: how many points.
std::int64_t ease(Stems const& stems, std::vector<std::size_t> const& points, double reach_m,
                  std::vector<double>& share);

} // namespace thalweg::network
