// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::geometry {

/// Options of tin_of_dem().
struct TinOfDemParams {
    double error_m = 1.0; ///< [m] > 0, largest vertical distance of a cell from the TIN
};

/// A DEM as a TIN.
struct SimplifiedDem {
    Tin tin;
    double error_m = 0.0;      ///< [m] largest vertical distance reached
    std::int64_t left_out = 0; ///< cells with data in no triangle
};

/// Approximates a DEM by a TIN with few triangles, by greedy insertion of the worst cell (ties: lowest index) from the
/// corners of the outline on. The terrain is the squares between four neighbouring centres with data and the halves of
/// those with three; the outline of every hole is kept.
/// \param dem [m] by cell; NaN: no data
/// \return vertices are cell centres with their heights, in row order; at every other cell the TIN, computed in double,
/// is within error_m. Isolated cells and rows one cell wide lie in no triangle and are counted.
/// \throws BadParameter when error_m is not above 0
/// \throws BadInput when a height is infinite, a side has more than 2^20 cells, or no three neighbouring cells have
/// data
///
/// Source: \cite garland1995, Fast polygonal approximation of terrains and height fields, algorithm III.
SimplifiedDem tin_of_dem(Raster<float> const& dem, TinOfDemParams const& params = {}, Run const& run = {});

} // namespace thalweg::geometry
