// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/raster.hpp>

namespace thalweg::flow {

/// Where the water of a cell goes (D8): to one of its eight neighbours, numbered as d8_steps, or to none.
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
    leaves = 255   ///< water leaves the grid, enters no data or ends in a sink, in this cell
};

/// \param d the direction
/// \return whether water goes on to a neighbour.
constexpr bool goes_on(Direction d) {
    return d <= Direction::north_east;
}

/// \param d a direction in which water goes on
/// \return place in d8_steps.
constexpr std::size_t index_of(Direction d) {
    return static_cast<std::size_t>(d);
}

/// \param k [0, 7] place in d8_steps
/// \return the direction with this place in d8_steps.
constexpr Direction direction_of(std::size_t k) {
    return static_cast<Direction>(k);
}

constexpr Direction opposite(Direction d) {
    return direction_of((index_of(d) + d8_steps.size() / 2) % d8_steps.size());
}

constexpr bool is_diagonal(Direction d) {
    return index_of(d) % 2 != 0;
}

/// \pre directions that stay on the grid.
/// \param direction a direction
/// \param cell index of the cell
/// \return the cell to which the water of a cell goes, -1 where it goes to none.
inline std::int64_t receiver(Raster<Direction> const& direction, std::int64_t cell) {
    Direction const d = direction[cell];
    if (!goes_on(d)) {
        return -1;
    }
    Cell const step = d8_steps[index_of(d)];
    return cell + step.row * direction.width() + step.col;
}

} // namespace thalweg::flow
