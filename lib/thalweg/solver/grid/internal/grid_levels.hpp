// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/solver/grid/internal/two_colours.hpp>

namespace thalweg::solver {

/// A coarser grid: each cell stands for 2 x 2 of the one before, its equations are the sums of theirs (Galerkin).
struct CoarseLevel {
    Board board;
    TwoColours<float> r;       ///< right-hand side
    TwoColours<float> e;       ///< sought
    TwoColours<float> inverse; ///< 1 / diagonal; 0 where no free cell is
    /// Weights of the edges from each red cell; those between black cells' neighbours are the same edges.
    Plane<float> above, left, right, below;
};

/// The grid itself.
struct TopLevel {
    Board board;
    TwoColours<std::uint8_t> degree; ///< of free cells: neighbours that are not outside; 0: not free
};

/// Takes: a CellKind a cell.
TopLevel top_level(Raster<std::uint8_t> const& kind, Run const& run);

/// Multigrid's levels above the grid, the finest first, the last of one cell. Takes: at least two cells.
std::vector<CoarseLevel> coarse_levels(Raster<std::uint8_t> const& kind, Run const& run);

} // namespace thalweg::solver
