// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/direction.hpp>
#include <thalweg/flow/internal/flood_queue.hpp>

/// Private to this module.
namespace thalweg::flow {

/// Raises a framed DEM (framed.hpp) to the level at which its water spills.
/// Takes: is_outlet(cell), where water leaves besides the border and cells beside no data; rise(level), the least level
/// of a cell that the flood reaches from one at this level. Gives: by cell, the way back to where the flood came from.
/// Throws: Cancelled. Source: Barnes, Lehman and Mulla 2014.
template <class IsOutlet, class Rise>
Raster<Direction> priority_flood(Raster<float>& level, IsOutlet is_outlet, Rise rise, char const* stage,
                                 Run const& run) {
    constexpr auto unreached = static_cast<Direction>(253);
    Raster<Direction> direction(level.grid(), unreached);
    auto const offsets = d8_offsets(level.grid());
    FloodQueue queue;
    for (std::int64_t i = 0; i < level.cells(); ++i) {
        if (std::isnan(level[i])) {
            direction[i] = Direction::no_data;
        } else if (is_outlet(i) || std::any_of(offsets.begin(), offsets.end(),
                                               [&](std::int64_t step) { return std::isnan(level[i + step]); })) {
            direction[i] = Direction::leaves;
            queue.push(level[i], i);
        }
    }
    std::int64_t popped = 0;
    for (std::int64_t i = queue.pop(); i >= 0; i = queue.pop()) {
        if (++popped % cells_between_checks == 0) {
            run.at(static_cast<double>(popped) / static_cast<double>(level.cells()), stage);
        }
        float const least = rise(level[i]);
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            std::int64_t const n = i + offsets[k];
            if (direction[n] == unreached) {
                direction[n] = opposite(direction_of(k));
                level[n] = std::max(level[n], least);
                queue.push(level[n], n);
            }
        }
    }
    return direction;
}

} // namespace thalweg::flow
