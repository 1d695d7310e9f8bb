// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::blend {

/// The part of a target that a stage changes: its smallest bounding box plus a ring of one cell.
struct EditRegion {
    Cell corner;                 ///< cell of the target that is cell (0, 0) of the rasters below
    Raster<std::uint8_t> kind;   ///< solver::CellKind
    Raster<double> target;       ///< [m] heights, NaN where there is no data
    std::int64_t cells = 0;      ///< number of cells that change
    std::int64_t neighbours = 0; ///< number of neighbours that keep their height
};

/// Extracts the part of a target that is to change.
/// \param changes cells that change
/// \param given more cells with fixed heights, or an empty mask
/// \param stage its name, for messages
/// \return changing cells are free; their 4-neighbours with heights and the given cells are fixed; all others are
/// outside, as is everything beyond the target's edge: no flux there
/// \throws BadInput when no cell changes, when a fixed one is infinite, or naming a cell and its position when a
/// changing part has no fixed neighbour
EditRegion edit_region_of(Raster<float> const& target, Mask const& changes, Mask const& given, std::string const& stage,
                          Run const& run);

/// Wanted differences of heights between neighbours.
struct Guidance {
    Raster<double> east;  ///< [m] to the eastern neighbour; read between cells that are not outside
    Raster<double> south; ///< [m] to the southern neighbour
};

/// Computes heights whose differences follow a guidance g as closely as fixed cells allow: lap f = div g.
/// \param kind solver::CellKind by cell
/// \param fixed heights of fixed cells
/// \param carrier terrain finite in every cell that is not outside
/// \param guidance wanted differences; empty: the carrier's own
/// \return f in free and fixed cells, the same for any carrier to the tolerance. With empty guidance f is the carrier
/// plus the harmonic extension of its differences to the fixed cells; if these are constant, f is the carrier plus that
/// constant.
/// \throws Error as solver::solve_poisson
///
/// Source: \cite nenu2015, eqs 14 to 16 on a grid: any diagonal of its cells has the weight 0.
solver::GridSolution solve_guided(Raster<std::uint8_t> const& kind, Raster<double> const& fixed,
                                  Raster<double> const& carrier, Guidance const& guidance,
                                  solver::PoissonParams const& params = {}, Run const& run = {});

/// Computes the distance to the outside of a mask, exact up to the rounding of sqrt, in time independent of the
/// distance.
/// \return [cells] from each centre to the nearest centre of a cell outside the mask; 0: outside; infinity: every cell
/// is inside
///
/// Source: Felzenszwalb and Huttenlocher 2012, Distance transforms of sampled functions.
Raster<float> distance_within(Mask const& mask, Run const& run = {});

} // namespace thalweg::blend
