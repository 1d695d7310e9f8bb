// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/paths.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/flow/internal/each_downstream.hpp>

namespace thalweg::flow {

Raster<double> lengths_to_outlet(FlowField const& drainage, Run const& run) {
    Grid const& grid = drainage.grid();
    Raster<double> length(grid, std::numeric_limits<double>::quiet_NaN());
    std::vector<std::int64_t> way;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (drainage.direction[i] == Direction::no_data) {
            continue;
        }
        way.clear();
        std::int64_t at = i;
        while (std::isnan(length[at]) && drainage.receiver(at) >= 0) {
            way.push_back(at);
            at = drainage.receiver(at);
        }
        length[at] = std::isnan(length[at]) ? 0.0 : length[at];
        double below = length[at];
        for (auto cell = way.rbegin(); cell != way.rend(); ++cell) {
            below += is_diagonal(drainage.direction[*cell]) ? grid.cell_m * std::sqrt(2.0) : grid.cell_m;
            length[*cell] = below;
        }
    }
    return length;
}

Raster<float> heights_above_rivers(Raster<float> const& dem, std::vector<RiverCell> const& rivers,
                                   FlowField const& drainage, Run const& run) {
    require_same_grid(dem.grid(), drainage.grid(), "flow.heights_above_rivers", "the DEM and its drainage",
                      "drain this DEM");
    Raster<std::int32_t> const met = first_met(rivers, drainage, run);
    Raster<float> heights(dem.grid(), std::numeric_limits<float>::quiet_NaN());
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (met[i] >= 0) {
            heights[i] = dem[i] - dem[rivers[static_cast<std::size_t>(met[i])].cell];
        }
    }
    return heights;
}

std::vector<RiverCell> cells_with_area(FlowField const& drainage, std::int64_t support_cells, Run const& run) {
    require_in("flow.cells_with_area", "support_cells", support_cells, Range::at_least(1));
    std::vector<RiverCell> cells;
    for (std::int64_t i = 0; i < drainage.area_cells.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (drainage.area_cells[i] >= support_cells) {
            cells.push_back({i, cells.size()});
        }
    }
    return cells;
}

StreamOrders stream_orders(FlowField const& drainage, std::int64_t support_cells, Run const& run) {
    require_in("flow.stream_orders", "support_cells", support_cells, Range::at_least(1));
    Grid const& grid = drainage.grid();
    StreamOrders orders{Raster<std::uint8_t>(grid), Raster<std::int64_t>(grid)};
    for (std::int64_t i = 0; i < grid.cells(); ++i) { // until streams arrive: sources
        bool const is_stream = drainage.area_cells[i] >= support_cells;
        orders.strahler[i] = is_stream ? 1 : 0;
        orders.shreve[i] = is_stream ? 1 : 0;
    }
    Raster<std::uint8_t> highest(grid); // of the streams that have arrived
    each_downstream(drainage.direction, run, [&](std::int64_t cell, std::int64_t receiver) {
        std::uint8_t const order = orders.strahler[cell];
        if (order == 0) {
            return;
        }
        bool const is_first = highest[receiver] == 0;
        orders.shreve[receiver] = orders.shreve[cell] + (is_first ? 0 : orders.shreve[receiver]);
        if (order > highest[receiver]) {
            highest[receiver] = order;
            orders.strahler[receiver] = order;
        } else if (order == highest[receiver]) {
            orders.strahler[receiver] = static_cast<std::uint8_t>(order + 1);
        }
    });
    return orders;
}

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
