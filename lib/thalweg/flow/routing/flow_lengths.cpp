// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/routing/flow_lengths.hpp>

#include <algorithm>
#include <cmath>

#include <thalweg/flow/internal/each_downstream.hpp>

namespace thalweg::flow {

Raster<float> flow_lengths(FlowField const& drainage, Run const& run) {
    Grid const& grid = drainage.grid();
    auto const straight = static_cast<float>(grid.cell_m);
    auto const diagonal = static_cast<float>(grid.cell_m * std::sqrt(2.0));
    Raster<float> length(grid);
    each_downstream(drainage.direction, run, [&](std::int64_t cell, std::int64_t receiver) {
        float const step = is_diagonal(drainage.direction[cell]) ? diagonal : straight;
        length[receiver] = std::max(length[receiver], length[cell] + step);
    });
    return length;
}

} // namespace thalweg::flow
