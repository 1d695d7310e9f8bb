// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/direction.hpp>

namespace thalweg::flow {

/// Calls visit(cell, receiver) for every cell with a receiver, after all its donors: follows water from each cell
/// without donors as long as all donors have arrived.
/// \param direction on the grid, without cycles
/// \param visit called as visit(std::int64_t, std::int64_t)
///
/// Source: \cite braun2013.
template <class Visit> void each_downstream(Raster<Direction> const& direction, Run const& run, Visit visit) {
    constexpr std::uint8_t done = 255;
    auto const offsets = d8_offsets(direction.grid());
    Raster<std::uint8_t> awaited_by(direction.grid()); // donors whose water has not arrived yet
    std::uint8_t* const awaited = awaited_by.values().data();
    Direction const* const way = direction.values().data();
    for (std::int64_t i = 0; i < direction.cells(); ++i) {
        if (goes_on(way[i])) {
            ++awaited[i + offsets[index_of(way[i])]];
        }
    }
    for (std::int64_t i = 0; i < direction.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        for (std::int64_t at = i; awaited[at] == 0;) {
            awaited[at] = done;
            if (!goes_on(way[at])) {
                break;
            }
            std::int64_t const next = at + offsets[index_of(way[at])];
            visit(at, next);
            --awaited[next];
            at = next;
        }
    }
}

} // namespace thalweg::flow
