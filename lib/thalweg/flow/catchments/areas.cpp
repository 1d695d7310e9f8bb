// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/catchments/areas.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <thalweg/core/cells/cells_along.hpp>
#include <thalweg/core/indexed.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/catchments/catchments.hpp>
#include <thalweg/flow/catchments/reaches.hpp>

namespace thalweg::flow {

namespace {

/// By place in cells (ascending by index): how many cells of the grid are nearest to it by city-block distance, ties to
/// the lower place. A key holds the distance above the place, so that the lesser key is the better one; a step adds one
/// to the distance and keeps that order, which makes the sweeps along rows and columns exact.
std::vector<std::int64_t> count_nearest(std::vector<RiverCell> const& cells, Grid const& grid, Run const& run) {
    using Key = std::uint64_t;
    constexpr Key step = Key{1} << 32U;
    constexpr Key nothing = Key{1} << 62U;
    constexpr std::int64_t most = std::int64_t{1} << 30U; // of either half of a key
    if (grid.width + grid.height > most || static_cast<std::int64_t>(cells.size()) > most) {
        throw BadInput(fmt::format("flow.areas_nearest: {} x {} cells with {} river cells are beyond 2^30 of either",
                                   grid.width, grid.height, cells.size()));
    }
    auto const width = static_cast<std::size_t>(grid.width);
    Raster<Key> keys(grid, nothing);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        keys[cells[i].cell] = i;
    }
    for (std::int64_t r = 0; r < grid.height; ++r) {
        run.check();
        auto const row = keys.row(r);
        for (std::size_t c = 1; c < width; ++c) {
            row[c] = std::min(row[c], row[c - 1] + step);
        }
        for (std::size_t c = width - 1; c > 0; --c) {
            row[c - 1] = std::min(row[c - 1], row[c] + step);
        }
        for (std::size_t c = 0; r > 0 && c < width; ++c) {
            row[c] = std::min(row[c], keys.row(r - 1)[c] + step);
        }
    }
    std::vector<std::int64_t> count(cells.size(), 0);
    for (std::int64_t r = grid.height - 1; r >= 0; --r) {
        run.check();
        auto const row = keys.row(r);
        for (std::size_t c = 0; c < width; ++c) {
            if (r + 1 < grid.height) {
                row[c] = std::min(row[c], keys.row(r + 1)[c] + step);
            }
            ++count[row[c] % step];
        }
    }
    return count;
}

/// By place in cells: how many cells of the grid reach it by D8 before any other river cell.
std::vector<std::int64_t> count_draining(std::vector<RiverCell> const& cells, FlowField const& drainage,
                                         Run const& run) {
    Indexed<std::int32_t, std::int64_t> count(cells.size(), 0);
    Raster<std::int32_t> const met = first_met(cells, drainage, run);
    for (std::int32_t const place : met.values()) {
        if (place >= 0) {
            ++count[place];
        }
    }
    return count;
}

/// Adds up along the rivers what each of their cells gathers.
ContributingAreas accumulate(StreamNetwork const& network, std::vector<RiverCell> const& cells,
                             std::vector<std::int64_t> const& count, Grid const& grid, char const* source) {
    std::vector<double> const arcs(network.arc_count(), 0.0);
    ContributingAreas areas{arcs, arcs, std::vector<double>(network.node_count(), 0.0), source};
    std::vector<std::int64_t> at_start(network.arc_count(), 0); // the share of the arc's first cell
    std::vector<std::int64_t> beyond(network.arc_count(), 0);   // that of its other cells
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::size_t const a = cells[i].reach;
        Cell const start = cells_of_vertices({network.node(network.from(a)).at}, grid).front();
        (cells[i].cell == grid.index(start) ? at_start : beyond)[a] += count[i];
    }
    std::vector<std::int64_t> through(network.node_count(), 0); // by node, in cells
    double const cell_m2 = grid.cell_m * grid.cell_m;
    for (auto n = network.upstream_order().rbegin(); n != network.upstream_order().rend(); ++n) {
        if (network.out(*n) != no_arc) {
            auto const a = network.out(*n);
            through[*n] += at_start[a];
            std::int64_t const end = through[*n] + beyond[a];
            through[network.to(a)] += end;
            areas.us_area_m2[a] = static_cast<double>(through[*n]) * cell_m2;
            areas.ds_area_m2[a] = static_cast<double>(end) * cell_m2;
        }
        areas.node_m2[*n] = static_cast<double>(through[*n]) * cell_m2;
    }
    return areas;
}

} // namespace

ContributingAreas areas_nearest(StreamNetwork const& network, Grid const& grid, Run const& run) {
    auto const cells = river_cells(reaches_of(network), grid, run);
    auto const count = cells.empty() ? std::vector<std::int64_t>{} : count_nearest(cells, grid, run);
    return accumulate(network, cells, count, grid, "nearest");
}

ContributingAreas areas_d8(StreamNetwork const& network, FlowField const& drainage, Run const& run) {
    Grid const& grid = drainage.direction.grid();
    auto const cells = river_cells(reaches_of(network), grid, run);
    return accumulate(network, cells, count_draining(cells, drainage, run), grid, "d8");
}

} // namespace thalweg::flow
