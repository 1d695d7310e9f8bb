// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::blend {

/// The piece of a target that a stage changes: the smallest box that holds it, with a ring of one cell around it.
struct Opening {
    Cell corner;                 ///< of the target: cell (0, 0) of the rasters below
    Raster<std::uint8_t> kind;   ///< solver::CellKind
    Raster<double> target;       ///< [m] heights, NaN where there is no data
    std::int64_t cells = 0;      ///< that change
    std::int64_t neighbours = 0; ///< cells beside them that keep their height
};

/// Opens a target for cells to be changed.
/// Takes: which cells change; more cells whose height is given beside their neighbours, or an empty mask; the name of
/// the stage, for messages. Gives: changing cells are free; those 4-neighbours of theirs that have a height are fixed,
/// the others outside, as is what lies beyond the target's edge: nothing flows there. Cells that are given are fixed.
/// Throws: BadInput when no cell changes, when one that stays is infinite, or when no cell of a part of what changes
/// has a neighbour that is fixed: it names a cell of that part and where it lies; Cancelled.
Opening open_target(Raster<float> const& target, Mask const& changes, Mask const& given, std::string const& stage,
                    Run const& run);

/// How much higher a cell's neighbour shall be.
struct Guidance {
    Raster<double> east;  ///< [m] of the neighbour in the east; read between cells that are not outside
    Raster<double> south; ///< [m] of the neighbour in the south
};

/// Heights whose differences follow a guidance g as nearly as fixed cells let them: lap f = div g.
/// Takes: what each cell is (solver::CellKind); the heights of fixed cells; a carrier, some land finite in every cell
/// that is not outside; the guidance, or an empty one for the differences of the carrier itself.
/// Gives: f in free and fixed cells; of any two carriers the same f to the tolerance. Where the guidance is empty, f is
/// the carrier and the harmonic extension of what the fixed cells differ from it by; equal by any constant, they give
/// f the carrier and that constant. Throws: as solver::solve_poisson.
/// Source: paper 003, eqs 14 to 16 on a grid: any diagonal of its cells has the weight 0.
solver::GridSolution follow(Raster<std::uint8_t> const& kind, Raster<double> const& fixed,
                            Raster<double> const& carrier, Guidance const& guidance,
                            solver::PoissonParams const& params = {}, Run const& run = {});

/// How far it is out of a mask.
/// Gives: [cells] from each centre to the nearest centre of a cell that is not in the mask, 0 for those; infinity where
/// every cell is. Exact up to the square root's rounding, in time that does not depend on the distance.
/// Throws: Cancelled. Source: Felzenszwalb and Huttenlocher 2012, Distance transforms of sampled functions.
Raster<float> distance_within(Mask const& mask, Run const& run = {});

} // namespace thalweg::blend
