// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/drainage.hpp>

#include <algorithm>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include <thalweg/core/cells_along.hpp>
#include <thalweg/core/error.hpp>

namespace thalweg::measure {

namespace {

/// A cell of the network and the arc that covers it.
struct Covered {
    std::int64_t cell = 0;
    std::int64_t arcs_to_outlet = 0;
    std::size_t arc = 0;
};

/// By arc: 1 for those that end in an outlet, growing upstream.
std::vector<std::int64_t> arcs_to_outlet(StreamNetwork const& network, NetworkIndex const& index) {
    for (NodeId n = 0; n < boost::num_vertices(network); ++n) {
        if (boost::out_degree(n, network) > 1) {
            throw BadInput(fmt::format("measure.areas: {} arcs leave node {} at ({}, {}); a river must not part",
                                       boost::out_degree(n, network), n + 1, network[n].at.x, network[n].at.y));
        }
    }
    std::vector<std::int64_t> depth(index.arcs.size(), 0);
    for (NodeId const n : index.upstream_order) {
        auto const out = index.out[n];
        for (auto const a : index.in[n]) {
            depth[static_cast<std::size_t>(a)] = out < 0 ? 1 : depth[static_cast<std::size_t>(out)] + 1;
        }
    }
    auto const lost = std::find(depth.begin(), depth.end(), 0);
    if (lost != depth.end()) {
        auto const a = static_cast<std::size_t>(lost - depth.begin());
        Vec2 const at = network[index.from[a]].at;
        throw BadInput(fmt::format("measure.areas: arc {} from ({}, {}) leads to no outlet: its rivers run in a "
                                   "circle",
                                   a + 1, at.x, at.y));
    }
    return depth;
}

/// The network's cells by index, each with the one arc that owns it.
std::vector<Covered> owned_cells(StreamNetwork const& network, NetworkIndex const& index, Grid const& grid,
                                 Run const& run) {
    auto const depth = arcs_to_outlet(network, index);
    std::vector<Covered> cells;
    for (std::size_t a = 0; a < index.arcs.size(); ++a) {
        run.check();
        for (Cell const c : cells_along(network[index.arcs[a]].line, grid, fmt::format("arc {}", a + 1))) {
            cells.push_back({grid.index(c), depth[a], a});
        }
    }
    std::sort(cells.begin(), cells.end(), [](Covered const& p, Covered const& q) {
        return std::tie(p.cell, p.arcs_to_outlet, p.arc) < std::tie(q.cell, q.arcs_to_outlet, q.arc);
    });
    cells.erase(
        std::unique(cells.begin(), cells.end(), [](Covered const& p, Covered const& q) { return p.cell == q.cell; }),
        cells.end());
    return cells;
}

/// By place in cells (ascending by index): how many cells of the grid are nearest to it by city-block distance, ties to
/// the lower place. A key holds the distance above the place, so that the lesser key is the better one; a step adds one
/// to the distance and keeps that order, which makes the sweeps along rows and columns exact.
std::vector<std::int64_t> count_nearest(std::vector<Covered> const& cells, Grid const& grid, Run const& run) {
    using Key = std::uint64_t;
    constexpr Key step = Key{1} << 32U;
    constexpr Key nothing = Key{1} << 62U;
    constexpr std::int64_t most = std::int64_t{1} << 30U; // of either half of a key
    if (grid.width + grid.height > most || static_cast<std::int64_t>(cells.size()) > most) {
        throw BadInput(fmt::format("measure.areas_nearest: {} x {} cells with {} river cells are beyond 2^30 of either",
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
            ++count[static_cast<std::size_t>(row[c] % step)];
        }
    }
    return count;
}

/// By place in cells: how many cells of the grid reach it by D8 before any other river cell.
std::vector<std::int64_t> count_draining(std::vector<Covered> const& cells, Drainage const& drainage, Run const& run) {
    constexpr std::int32_t unknown = -1;
    constexpr std::int32_t nowhere = -2;
    Grid const& grid = drainage.direction.grid();
    if (cells.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
        throw BadInput("measure.areas_d8: more than 2^31 river cells");
    }
    Raster<std::int32_t> to(grid, unknown); // the place each cell's water comes to
    for (std::size_t i = 0; i < cells.size(); ++i) {
        to[cells[i].cell] = static_cast<std::int32_t>(i);
    }
    std::vector<std::int64_t> count(cells.size(), 0);
    std::vector<std::int64_t> way;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (i % (1 << 20) == 0) {
            run.check();
        }
        way.clear();
        std::int64_t at = i;
        while (to[at] == unknown) {
            way.push_back(at);
            std::int8_t const direction = drainage.direction[at];
            if (direction < 0) {
                to[at] = nowhere;
                break;
            }
            Cell const step = d8_steps[static_cast<std::size_t>(direction)];
            at += step.row * grid.width + step.col;
        }
        std::int32_t const end = to[at];
        for (std::int64_t const cell : way) {
            to[cell] = end;
        }
        if (end >= 0) {
            ++count[static_cast<std::size_t>(end)];
        }
    }
    return count;
}

/// Adds up along the rivers what each of their cells gathers.
ContributingAreas accumulate(StreamNetwork const& network, NetworkIndex const& index, std::vector<Covered> const& cells,
                             std::vector<std::int64_t> const& count, Grid const& grid, char const* source) {
    std::vector<double> const arcs(index.arcs.size(), 0.0);
    ContributingAreas areas{arcs, arcs, std::vector<double>(index.out.size(), 0.0), source};
    std::vector<std::int64_t> at_start(index.arcs.size(), 0); // the share of the arc's first cell
    std::vector<std::int64_t> beyond(index.arcs.size(), 0);   // that of its other cells
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::size_t const a = cells[i].arc;
        Cell const start = cells_of_vertices({network[index.from[a]].at}, grid).front();
        (cells[i].cell == grid.index(start) ? at_start : beyond)[a] += count[i];
    }
    std::vector<std::int64_t> through(index.out.size(), 0); // by node, in cells
    double const cell_m2 = grid.cell_m * grid.cell_m;
    for (auto n = index.upstream_order.rbegin(); n != index.upstream_order.rend(); ++n) {
        if (index.out[*n] >= 0) {
            auto const a = static_cast<std::size_t>(index.out[*n]);
            through[*n] += at_start[a];
            std::int64_t const end = through[*n] + beyond[a];
            through[index.to[a]] += end;
            areas.us_area_m2[a] = static_cast<double>(through[*n]) * cell_m2;
            areas.ds_area_m2[a] = static_cast<double>(end) * cell_m2;
        }
        areas.node_m2[*n] = static_cast<double>(through[*n]) * cell_m2;
    }
    return areas;
}

} // namespace

ContributingAreas areas_nearest(StreamNetwork const& network, Grid const& grid, Run const& run) {
    NetworkIndex const index(network);
    auto const cells = owned_cells(network, index, grid, run);
    auto const count = cells.empty() ? std::vector<std::int64_t>{} : count_nearest(cells, grid, run);
    return accumulate(network, index, cells, count, grid, "nearest");
}

ContributingAreas areas_d8(StreamNetwork const& network, Drainage const& drainage, Run const& run) {
    Grid const& grid = drainage.direction.grid();
    NetworkIndex const index(network);
    auto const cells = owned_cells(network, index, grid, run);
    return accumulate(network, index, cells, count_draining(cells, drainage, run), grid, "d8");
}

} // namespace thalweg::measure
