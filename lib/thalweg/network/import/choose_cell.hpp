// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// Options of choose_cell().
struct ChooseCellParams {
    std::int64_t width = 0;             ///< [cells] of a grid that the rivers must fit; 0: free
    std::int64_t height = 0;            ///< [cells] as width
    std::int64_t usual_cells = 1500000; ///< [1, ...] normal limit of cells in the grid
    std::int64_t most_cells = 2000000;  ///< [usual_cells, ...] limit where rivers lie closer together
};

/// A cell size and the measures it follows from.
struct ChosenCell {
    double cell_m = 0.0;
    std::int64_t lines = 0;
    double length_m = 0.0;  ///< [m] of all rivers
    double spacing_m = 0.0; ///< [m] mean distance between rivers: area of the grid / length of the rivers
    /// [0, 1] share of river cells in or beside which another river runs, more than 5 cells from a confluence
    double crowded_share = 0.0;
    double enough_m = 0.0; ///< [m] if that exceeds 0.2 %: the cell size at which it does not; 0: unknown
};

/// Chooses the cell size of a grid for rivers.
/// \param rivers lines [m]
/// \return a round number (1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 7.5 or 9 times a power of ten): the smallest at which the
/// rivers' box and a margin of 5 % have at most usual_cells, but, while the longer side has 1000 cells, not below a
/// tenth of the median distance of vertices; smaller, within most_cells, if crowded_share exceeds 0.2 %. With width and
/// height: the smallest with which the rivers fit.
/// \throws BadInput without lines or when all vertices coincide
ChosenCell choose_cell(RiverLines const& rivers, ChooseCellParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
