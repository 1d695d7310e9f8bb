// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>
#include <thalweg/surface/equilibrium/internal/rock.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Whether the land goes on beyond the grid.
inline bool goes_on(Edge edge) {
    return edge == Edge::open || edge == Edge::mainland;
}

/// What the solver works on: the caller's grid with a margin around it, in which land may go on.
struct WidenedLand {
    Grid grid;           ///< without the frame
    std::int64_t margin; ///< [cells] on each side
    RiverCells rivers; ///< in the frame of that grid; those that leave by the border go straight on through the margin
    Mask land;         ///< without cells: all
    RockFields fields;
};
WidenedLand widened(Channels const& rivers, EquilibriumFields const& fields, EquilibriumParams const& params);

} // namespace thalweg::surface
