// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/routing/route.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <thalweg/core/cells/d8.hpp>
#include <thalweg/core/numbers/compensated_sum.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/flow/internal/flood_queue.hpp>

namespace thalweg::flow {

namespace {

constexpr std::int8_t unreached = -3;

using Sinks = std::vector<std::int64_t>; ///< cells, ascending

bool contains(Sinks const& sinks, std::int64_t cell) {
    return std::binary_search(sinks.begin(), sinks.end(), cell);
}

/// Raises depressions to the level at which they spill. Gives: the way back to where the flood came from.
Raster<std::int8_t> flood(Raster<float>& level, Sinks const& sinks, Run const& run) {
    Raster<std::int8_t> direction(level.grid(), unreached);
    auto const offsets = d8_offsets(level.grid());
    FloodQueue queue;
    for (std::int64_t i = 0; i < level.cells(); ++i) {
        if (std::isnan(level[i])) {
            direction[i] = d8_no_data;
        } else if (contains(sinks, i) || std::any_of(offsets.begin(), offsets.end(),
                                                     [&](std::int64_t step) { return std::isnan(level[i + step]); })) {
            direction[i] = d8_leaves;
            queue.push(level[i], i);
        }
    }
    std::int64_t popped = 0;
    for (std::int64_t i = queue.pop(); i >= 0; i = queue.pop()) {
        if (++popped % cells_between_checks == 0) {
            run.at(static_cast<double>(popped) / static_cast<double>(level.cells()), "drain");
        }
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            std::int64_t const n = i + offsets[k];
            if (direction[n] == unreached) {
                direction[n] = static_cast<std::int8_t>((k + 4) % 8);
                level[n] = std::max(level[n], level[i]);
                queue.push(level[n], n);
            }
        }
    }
    return direction;
}

/// Turns cells that have a lower neighbour towards the one down the steepest slope. With the flood's way for the others
/// there is no cycle: each step leads lower, or level to a cell that the flood reached earlier.
void descend(Raster<float> const& level, Sinks const& sinks, Raster<std::int8_t>& direction, Run const& run) {
    auto const offsets = d8_offsets(level.grid());
    parallel_ranges(run, level.cells(), cells_between_checks, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (std::isnan(level[i]) || contains(sinks, i)) {
                continue;
            }
            double steepest = 0.0;
            for (std::size_t k = 0; k < offsets.size(); ++k) {
                double const drop = static_cast<double>(level[i]) - level[i + offsets[k]];
                double const slope = drop * d8_per_length[k];
                if (slope > steepest) { // never towards NaN
                    steepest = slope;
                    direction[i] = static_cast<std::int8_t>(k);
                }
            }
        }
    });
}

void accumulate(FlowField& drainage, Run const& run) {
    Raster<std::int8_t> const& direction = drainage.direction;
    Raster<std::int64_t>& area = drainage.area_cells;
    auto const offsets = d8_offsets(direction.grid());
    auto const below = [&](std::int64_t i) { return i + offsets[static_cast<std::size_t>(direction[i])]; };
    constexpr std::int8_t done = -1;
    Raster<std::int8_t> awaited(direction.grid()); // neighbours whose water has not arrived yet
    for (std::int64_t i = 0; i < direction.cells(); ++i) {
        area[i] = direction[i] == d8_no_data ? 0 : 1;
        if (direction[i] >= 0) {
            ++awaited[below(i)];
        }
    }
    for (std::int64_t i = 0; i < direction.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        std::int64_t at = i;
        while (awaited[at] == 0) {
            awaited[at] = done;
            if (direction[at] < 0) {
                break;
            }
            std::int64_t const next = below(at);
            area[next] += area[at];
            --awaited[next];
            at = next;
        }
    }
}

/// The depressions of a DEM under its water, which is gone afterwards.
std::vector<Depression> take_depressions(Raster<float> const& dem, Raster<float>& level, Run const& run) {
    std::vector<Depression> found;
    Grid const& grid = dem.grid();
    auto const inner = [&](std::int64_t i) {
        Cell const c = level.grid().at(i);
        return Cell{c.col - 1, c.row - 1};
    };
    auto const offsets = d8_offsets(level.grid());
    std::vector<std::int64_t> open;
    for (std::int64_t row = 0; row < grid.height; ++row) {
        run.check();
        for (std::int64_t col = 0; col < grid.width; ++col) {
            std::int64_t const first = level.grid().index({col + 1, row + 1});
            if (!(level[first] > dem[Cell{col, row}])) {
                continue;
            }
            Depression depression{{col, row}};
            CompensatedSum depth_m;
            auto const take = [&](std::int64_t i, Cell c) {
                double const depth = static_cast<double>(level[i]) - static_cast<double>(dem[c]);
                if (dem[c] < dem[depression.lowest] ||
                    (dem[c] == dem[depression.lowest] && grid.index(c) < grid.index(depression.lowest))) {
                    depression.lowest = c;
                }
                ++depression.cells;
                depression.max_depth_m = std::max(depression.max_depth_m, depth);
                depth_m.add(depth);
                level[i] = dem[c];
                open.push_back(i);
            };
            take(first, {col, row});
            while (!open.empty()) {
                std::int64_t const i = open.back();
                open.pop_back();
                for (std::int64_t const step : offsets) {
                    std::int64_t const n = i + step;
                    if (std::isnan(level[n])) {
                        continue;
                    }
                    if (Cell const c = inner(n); level[n] > dem[c]) {
                        take(n, c);
                    }
                }
            }
            depression.volume_m3 = depth_m.value() * grid.cell_m * grid.cell_m;
            found.push_back(depression);
        }
    }
    return found;
}

/// In the framed DEM, ascending.
Sinks framed_sinks(Raster<float> const& dem, Grid const& framed, std::vector<std::int64_t> const& sinks) {
    Sinks cells;
    for (std::int64_t const sink : sinks) {
        if (sink < 0 || sink >= dem.cells() || std::isnan(dem[sink])) {
            throw BadInput(fmt::format("flow.route: the sink in cell {} has no height; give cells of the DEM", sink));
        }
        Cell const c = dem.grid().at(sink);
        cells.push_back(framed.index({c.col + 1, c.row + 1}));
    }
    std::sort(cells.begin(), cells.end());
    return cells;
}

} // namespace

FlowField route(Raster<float> const& dem, Run const& run) {
    return route(dem, {}, run);
}

FlowField route(Raster<float> const& dem, std::vector<std::int64_t> const& sinks, Run const& run) {
    Grid const& grid = dem.grid();
    if (grid.cells() == 0) {
        throw BadInput("flow.route: the DEM has no cells");
    }
    auto const values = dem.values();
    auto const infinite = std::find_if(values.begin(), values.end(), [](float z) { return std::isinf(z); });
    if (infinite != values.end()) {
        Cell const cell = grid.at(infinite - values.begin());
        throw BadInput(
            fmt::format("flow.route: the height at column {}, row {} is infinite; mark cells without data as NaN",
                        cell.col, cell.row));
    }
    FlowField result{Raster<std::int8_t>(grid), Raster<std::int64_t>(grid)};
    {
        Raster<float> level = framed(dem);
        Sinks const ends = framed_sinks(dem, level.grid(), sinks);
        Raster<std::int8_t> direction = flood(level, ends, run);
        descend(level, ends, direction, run);
        CompensatedSum raised_m;
        for (std::int64_t r = 0; r < grid.height; ++r) {
            auto const before = dem.row(r);
            auto const after = level.row(r + 1).subspan(1, before.size());
            for (std::size_t c = 0; c < before.size(); ++c) {
                if (after[c] > before[c]) {
                    ++result.pits;
                    raised_m.add(static_cast<double>(after[c]) - before[c]);
                }
            }
            auto const ways = direction.row(r + 1).subspan(1, before.size());
            std::copy(ways.begin(), ways.end(), result.direction.row(r).begin());
        }
        result.pit_volume_m3 = raised_m.value() * grid.cell_m * grid.cell_m;
        result.depressions = take_depressions(dem, level, run);
    }
    accumulate(result, run);
    return result;
}

} // namespace thalweg::flow
