// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/flow/route.hpp>

namespace thalweg::measure {

/// Cells where rivers leave the DEM, in descending order of contributing area.
/// \param drainage flow field of the DEM
/// \param support_cells [1, ...] least contributing area
/// \return indices
inline std::vector<std::int64_t> mouths(flow::FlowField const& drainage, std::int64_t support_cells) {
    std::vector<std::int64_t> all;
    for (std::int64_t i = 0; i < drainage.direction.cells(); ++i) {
        if (drainage.direction[i] == flow::Direction::leaves && drainage.area_cells[i] >= support_cells) {
            all.push_back(i);
        }
    }
    std::sort(all.begin(), all.end(), [&](std::int64_t a, std::int64_t b) {
        return drainage.area_cells[a] != drainage.area_cells[b] ? drainage.area_cells[a] > drainage.area_cells[b]
                                                                : a < b;
    });
    return all;
}

/// Finds the donor of a cell with the largest contributing area.
/// \param drainage flow field of the DEM
/// \return its D8 direction from the cell; -1: none
inline int main_donor(flow::FlowField const& drainage, Cell cell) {
    int best = -1;
    std::int64_t most = 0;
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        Cell const from{cell.col + d8_steps[k].col, cell.row + d8_steps[k].row};
        if (!drainage.direction.grid().contains(from) || drainage.direction[from] != opposite(flow::direction_of(k))) {
            continue;
        }
        if (drainage.area_cells[from] > most) {
            most = drainage.area_cells[from];
            best = static_cast<int>(k);
        }
    }
    return best;
}

/// Walks up a main stem, along the largest area.
/// \param drainage flow field of the DEM
/// \param support_cells [1, ...] least contributing area of a cell
/// \param visit called as visit(Cell, std::size_t) with each cell above the mouth and the D8 direction to it
template <class Visit>
void each_cell_above(flow::FlowField const& drainage, std::int64_t mouth, std::int64_t support_cells,
                     Visit const& visit) {
    Cell at = drainage.grid().at(mouth);
    for (int k = main_donor(drainage, at); k >= 0; k = main_donor(drainage, at)) {
        auto const way = static_cast<std::size_t>(k);
        at = {at.col + d8_steps[way].col, at.row + d8_steps[way].row};
        if (drainage.area_cells[at] < support_cells) {
            return;
        }
        visit(at, way);
    }
}

} // namespace thalweg::measure
