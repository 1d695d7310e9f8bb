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
    double error_m = 1.0; ///< [m] > 0: greatest vertical distance of a cell from the TIN
};

/// A DEM as a TIN.
struct SimplifiedDem {
    Tin tin;
    double error_m = 0.0;      ///< the greatest there is
    std::int64_t left_out = 0; ///< cells with data that lie in no triangle
};

/// The DEM's land as few triangles as greedy insertion finds, within a vertical error.
/// \param dem heights, NaN where there is no data; any size. The land is made of the squares between four neighbouring
/// centres with data, and of the halves of those with three: triangles are only there, the outline of every hole is
/// kept. A cell with no such square (a lone one, one in a line) lies in no triangle and is counted
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return vertices are centres of cells with their heights, row by row; at every other cell's centre the triangle's
/// plane, computed in double, lies within error_m of the cell. Always the worst cell goes in next (of equals that of
/// the lowest index), beginning with the corners of the outline.
/// \throws BadParameter when error_m is not > 0
/// \throws BadInput when a height is infinite, a side has more than 2^20 cells, or no three neighbouring cells have
/// data
/// \throws Cancelled
///
/// Source: \cite garland1995, Fast polygonal approximation of terrains and height fields, algorithm III.
SimplifiedDem tin_of_dem(Raster<float> const& dem, TinOfDemParams const& params = {}, Run const& run = {});

} // namespace thalweg::geometry
