// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Calls visit(cell) for the sixteen cells two columns or rows away from one, unless it is too near the frame.
template <class Visit> void each_of_second_ring(LandLevel const& level, std::uint32_t cell, Visit visit) {
    std::int64_t const col = cell % level.width;
    std::int64_t const row = cell / level.width;
    if (col < 2 || row < 2 || col + 2 >= level.width || row + 2 >= level.height) {
        return;
    }
    for (std::int64_t d = -2; d <= 2; ++d) {
        visit(moved(cell, -2 * level.width + d));
        visit(moved(cell, 2 * level.width + d));
        if (d != -2 && d != 2) {
            visit(moved(cell, d * level.width - 2));
            visit(moved(cell, d * level.width + 2));
        }
    }
}

} // namespace thalweg::surface
