// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/poisson.hpp>

namespace thalweg::blend {

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

} // namespace thalweg::blend
