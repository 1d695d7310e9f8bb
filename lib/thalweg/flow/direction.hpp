// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/raster.hpp>

// Idea: D8: all water of a cell goes to the neighbour to which it falls most steeply; a diagonal
// fall counts over a way of root 2. One direction a cell makes trees: areas, paths and catchments
// are then walks without choice. Ties go to the first direction clockwise from the east, so that
// every program run gives the same.
// Source: O'Callaghan and Mark 1984.
// Cost: eight comparisons a cell.
// Not for: divergent hillslopes, where D8 makes parallel lines along the eight directions:
// route_dinf (route.hpp) shares water. Pits and flats have no descent (Direction::leaves): route()
// leads water through them.
// Example:
//     Descent const down = steepest_descent(dem, {40, 30});
//     double const tangent = down.slope / grid.cell_m;
// More: docs/measures.md; docs/relief_measures.md, "Conventions beside other programs".

namespace thalweg::flow {

/// The D8 flow direction of a cell: a neighbour, numbered as in d8_steps, or none.
enum class Direction : std::uint8_t {
    east,
    south_east,
    south,
    south_west,
    west,
    north_west,
    north,
    north_east,
    no_data = 254, ///< the cell has no height
    leaves = 255   ///< water leaves the grid, enters no data or ends in a sink here
};

/// Tells whether water continues to a neighbour.
/// \param d any direction
/// \return false: leaves or no_data
constexpr bool goes_on(Direction d) {
    return d <= Direction::north_east;
}

/// The index of a direction.
/// \param d to a neighbour
/// \return [0, 7] index in d8_steps
constexpr std::size_t index_of(Direction d) {
    return static_cast<std::size_t>(d);
}

/// The direction with an index.
/// \param k [0, 7] index in d8_steps
/// \return to that neighbour
constexpr Direction direction_of(std::size_t k) {
    return static_cast<Direction>(k);
}

constexpr Direction opposite(Direction d) {
    return direction_of((index_of(d) + d8_steps.size() / 2) % d8_steps.size());
}

constexpr bool is_diagonal(Direction d) {
    return index_of(d) % 2 != 0;
}

/// Finds the D8 receiver of a cell.
/// \param direction by cell; no direction leads off the grid
/// \param cell index of the cell
/// \return index of the neighbour; -1: none
inline std::int64_t receiver(Raster<Direction> const& direction, std::int64_t cell) {
    Direction const d = direction[cell];
    if (!goes_on(d)) {
        return -1;
    }
    Cell const step = d8_steps[index_of(d)];
    return cell + step.row * direction.width() + step.col;
}

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
        bool const better = slope > best.slope; // never towards NaN; by selection, as nobody can foresee it
        best.direction = better ? direction_of(k) : best.direction;
        best.slope = better ? slope : best.slope;
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
