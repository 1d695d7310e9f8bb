// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/flow/route.hpp>

namespace thalweg::flow {

/// Programs whose numbers for D8 directions are known.
enum class DirectionCodes : std::uint8_t {
    thalweg,  ///< 0 to 7 clockwise from the east; 255 water ends, 254 no data
    esri,     ///< 1, 2, 4, ..., 128 clockwise from the east (ArcGIS, HydroSHEDS); 0 water ends, 247 and 255 no data
    grass,    ///< 1 to 8 counterclockwise from the north-east; below 0 water leaves the map, 0 it ends
    pcraster, ///< the digits of a keypad (ldd); 5 water ends, 0 and 255 no data
    saga,     ///< 0 to 7 clockwise from the north; -1 no data
    taudem,   ///< 1 to 8 counterclockwise from the east; 0 and -32768 no data
    whitebox  ///< 1, 2, 4, ..., 128 clockwise from the north-east; 0 water ends, -32768 no data
};

/// Reads the D8 directions of another program.
/// \param codes by cell; the least number of the type is no data, too
/// \param of whose codes these are
/// \return directions that lead off the grid or into no data become Direction::leaves
/// \throws BadInput naming the first cell with a number that is no code of the program
///
/// Source: the manuals of the programs.
Raster<Direction> directions_of(Raster<std::int32_t> const& codes, DirectionCodes of, Run const& run = {});

/// Writes D8 directions in the codes of another program.
/// \param direction by cell
/// \param of whose codes are wanted
/// \return by cell; where the program has no code for water that ends, its code for no data
Raster<std::int32_t> codes_of(Raster<Direction> const& direction, DirectionCodes of, Run const& run = {});

/// Makes the flow field of known D8 directions, of whatever program they are.
/// \param direction by cell
/// \return with their contributing areas; its depressions are unknown: none
/// \throws BadInput naming a cell whose direction leads off the grid or into no data, or where water runs in a circle;
/// for 2^32 cells or more
FlowField follow(Raster<Direction> const& direction, Run const& run = {});

/// Sums amounts along the D8 flow paths: rain [m3] gives runoff, ones give the number of cells.
/// \param drainage flow field of the DEM
/// \param amounts by cell, any unit; read where the DEM has data
/// \return in the same unit by cell: the sum over the cells that drain through it, itself included; NaN: no data
/// \throws BadInput when amounts and flow field differ in grid, or an amount is not finite in a cell with data
Raster<double> accumulate(FlowField const& drainage, Raster<double> const& amounts, Run const& run = {});

/// Options of catchment().
struct CatchmentParams {
    /// [m] >= 0: the outlet moves to the cell with the greatest contributing area within this distance (ties: the first
    /// by index)
    double snap_m = 0.0;
};

/// Delineates the catchment of a point.
/// \param drainage flow field of the DEM
/// \param outlet [m] position
/// \return by cell: 1 where water drains through the outlet's cell, itself included
/// \throws BadInput when the outlet is outside the grid or in a cell without data
/// \throws BadParameter when snap_m is below 0
Mask catchment(FlowField const& drainage, Vec2 outlet, CatchmentParams const& params = {}, Run const& run = {});

/// Follows water from a point.
/// \param drainage flow field of the DEM
/// \param from [m] position
/// \return indices of cells, downstream: from the point's cell to where water leaves or ends
/// \throws BadInput when the point is outside the grid or in a cell without data
std::vector<std::int64_t> path_down(FlowField const& drainage, Vec2 from, Run const& run = {});

} // namespace thalweg::flow
