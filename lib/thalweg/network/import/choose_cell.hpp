// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/river_lines.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::network {

/// Options of choose_cell().
struct ChooseCellParams {
    std::int64_t width = 0;             ///< [cells] of a grid into which the rivers must fit; 0: none is given
    std::int64_t height = 0;            ///< [cells] likewise
    std::int64_t usual_cells = 1500000; ///< [1, ...] at most in the grid
    std::int64_t most_cells = 2000000;  ///< [usual_cells, ...] at most where rivers lie closer together
};

/// A cell size with the numbers that it follows from.
struct ChosenCell {
    double cell_m = 0.0;
    std::int64_t lines = 0;
    double length_m = 0.0;      ///< of all rivers
    double spacing_m = 0.0;     ///< mean distance between rivers: area of the grid by length of the rivers
    double crowded_share = 0.0; ///< [0, 1] of the cells with rivers, those in or beside which another one runs, farther
                                ///< than 5 cells from where any meet
    double enough_m = 0.0;      ///< [m] where that is more than 0.2 %: the cell size at which it is not; 0: not known
};

/// Chooses the side of a grid's cells for rivers.
/// \param rivers lines in metres
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return a round number (1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 7.5 or 9 times a power of ten): the smallest with which
/// the rivers' box and 5 % around it have at most usual_cells, unless the lines are drawn more coarsely: not below a
/// tenth of the median distance of vertices, as long as the longer side has 1000 cells. Where crowded_share would be
/// more than 0.2 %, it is smaller, as far as most_cells allow. Of a given grid the smallest with which the rivers fit
/// into it.
/// \throws BadInput without lines or where all vertices lie at one place
/// \throws Cancelled
ChosenCell choose_cell(RiverLines const& rivers, ChooseCellParams const& params = {}, Run const& run = {});

} // namespace thalweg::network
