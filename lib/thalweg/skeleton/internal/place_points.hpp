// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/grid.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

/// Places at random, no two nearer than a given distance. Private to this module.
namespace thalweg::skeleton {

struct PlacePointsParams {
    std::uint64_t seed = 7;
    std::int64_t count = 0;          ///< >= 0, those that stand already included
    double spacing_cells = 0.0;      ///< [cells] >= 0
    std::vector<Vec2> standing = {}; ///< [m] places that stand already, at least the spacing apart
};

struct PlacedPoints {
    std::vector<Vec2> places; ///< [m] without those that stood
    std::int64_t missing = 0; ///< of the wanted count: no more room was found
    double density = 0.0;     ///< count spacing^2 / area; 0.6965 is where darts jam, 1.1547 the densest packing
};

/// Takes: free: cells that points may lie in, by number other than 0; without cells: all of the grid.
/// Gives: distances >= spacing exactly; count points or how many are missing. Throws: BadParameter, with the density,
/// when no packing on the whole grid could hold the points; Cancelled.
/// Source: Zhang, Liu and Li, equations 6, 7 and 11; darts, above a density of 0.62 on a whole grid Bridson 2007
/// (denser).
PlacedPoints place_points(Grid const& grid, Mask const& free, PlacePointsParams const& params, Run const& run);

} // namespace thalweg::skeleton
