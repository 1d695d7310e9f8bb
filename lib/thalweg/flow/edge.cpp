// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/edge.hpp>

#include <algorithm>
#include <cstdint>

#include <thalweg/core/cells.hpp>

namespace thalweg::flow {

Mask cut_by_edge(FlowField const& drainage) {
    Grid const& grid = drainage.grid();
    Mask cut(grid, 0);
    auto const has_data = [&](Cell c) { return grid.contains(c) && drainage.direction[c] != Direction::no_data; };
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        Cell const cell = grid.at(i);
        bool const at_edge = has_data(cell) && !std::ranges::all_of(d8_steps, [&](Cell step) {
                                 return has_data({cell.col + step.col, cell.row + step.row});
                             });
        for (std::int64_t c = i; at_edge && c >= 0 && cut[c] == 0; c = drainage.receiver(c)) {
            cut[c] = 1;
        }
    }
    return cut;
}

} // namespace thalweg::flow
