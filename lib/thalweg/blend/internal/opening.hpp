// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::blend {

/// The piece of a target that a stage changes: the smallest box that holds it, with a ring of one cell around it.
/// Private to this module.
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

} // namespace thalweg::blend
