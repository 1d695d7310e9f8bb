// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <limits>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/flow/direction.hpp>

namespace thalweg::flow {

/// The steepest descent from a cell.
struct Descent {
    Direction direction = Direction::leaves; ///< leaves: no neighbour is lower
    double slope = 0.0;                      ///< [unit of heights] fall per cell size
};

/// Finds the steepest descent to a neighbour.
/// \param here height of the cell
/// \param height_of called with k in [0, 7]: height of the neighbour d8_steps[k], NaN: none
/// \return ties: the lowest direction
///
/// Source: \cite ocallaghan1984.
template <class HeightOf> Descent steepest_descent(float here, HeightOf height_of) {
    Descent best;
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        double const slope = (static_cast<double>(here) - static_cast<double>(height_of(k))) * d8_per_length[k];
        if (slope > best.slope) { // never towards NaN
            best = {direction_of(k), slope};
        }
    }
    return best;
}

/// Finds the steepest descent from a cell to its neighbours on the grid.
/// \param dem [m] by cell; NaN: no data
/// \param c a cell of the grid
/// \return ties: the lowest direction
inline Descent steepest_descent(Raster<float> const& dem, Cell c) {
    return steepest_descent(dem[c], [&](std::size_t k) {
        Cell const n{c.col + d8_steps[k].col, c.row + d8_steps[k].row};
        return dem.grid().contains(n) ? dem[n] : std::numeric_limits<float>::quiet_NaN();
    });
}

} // namespace thalweg::flow
