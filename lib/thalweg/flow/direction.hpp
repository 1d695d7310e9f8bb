// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/raster.hpp>

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

} // namespace thalweg::flow
