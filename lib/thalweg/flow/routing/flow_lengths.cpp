// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/routing/flow_lengths.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg::flow {

Raster<float> flow_lengths(FlowField const& drainage, Run const& run) {
    constexpr std::int8_t done = -1;
    Raster<std::int8_t> const& direction = drainage.direction;
    Grid const& grid = direction.grid();
    auto const straight = static_cast<float>(grid.cell_m);
    auto const diagonal = static_cast<float>(grid.cell_m * std::sqrt(2.0));
    auto const below = [&](std::int64_t cell) {
        Cell const step = d8_steps[static_cast<std::size_t>(direction[cell])];
        return cell + step.row * grid.width + step.col;
    };
    Raster<float> length(grid);
    Raster<std::int8_t> awaited(grid); // neighbours whose water has not arrived yet
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (direction[i] >= 0) {
            ++awaited[below(i)];
        }
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        for (std::int64_t at = i; awaited[at] == 0;) {
            awaited[at] = done;
            if (direction[at] < 0) {
                break;
            }
            std::int64_t const next = below(at);
            length[next] = std::max(length[next], length[at] + (direction[at] % 2 == 0 ? straight : diagonal));
            --awaited[next];
            at = next;
        }
    }
    return length;
}

} // namespace thalweg::flow
