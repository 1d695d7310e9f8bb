// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/direction.hpp>

/// Private to this module.
namespace thalweg::flow {

/// Calls visit(cell, receiver) for every cell whose water goes on, after all cells that drain into it: from each cell
/// without donors, water is followed as far as all donors have arrived.
/// Takes: directions that stay on the grid and close no circle. Throws: Cancelled. Source: Braun and Willett 2013.
template <class Visit> void each_downstream(Raster<Direction> const& direction, Run const& run, Visit visit) {
    constexpr std::int8_t done = -1;
    Raster<std::int8_t> awaited(direction.grid()); // donors whose water has not arrived yet
    for (std::int64_t i = 0; i < direction.cells(); ++i) {
        if (std::int64_t const next = receiver(direction, i); next >= 0) {
            ++awaited[next];
        }
    }
    for (std::int64_t i = 0; i < direction.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        for (std::int64_t at = i; awaited[at] == 0;) {
            awaited[at] = done;
            std::int64_t const next = receiver(direction, at);
            if (next < 0) {
                break;
            }
            visit(at, next);
            --awaited[next];
            at = next;
        }
    }
}

} // namespace thalweg::flow
