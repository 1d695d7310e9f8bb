// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/route.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/flow/internal/cell_count.hpp>
#include <thalweg/flow/internal/each_downstream.hpp>
#include <thalweg/flow/internal/priority_flood.hpp>

namespace thalweg::flow {
namespace {

using Sinks = std::vector<std::int64_t>; ///< cells, ascending

bool contains(Sinks const& sinks, std::int64_t cell) {
    return std::binary_search(sinks.begin(), sinks.end(), cell);
}

/// Fills depressions to their spill level.
/// \return by cell: direction towards the cell from which the flood reached it
Raster<Direction> raise_to_spill(Raster<float>& level, Sinks const& sinks, Run const& run) {
    auto const is_sink = [&](std::int64_t i) { return contains(sinks, i); };
    return priority_flood(level, is_sink, "drain", run);
}

/// Directs cells with a lower neighbour to the steepest one. The other cells keep the flood's direction. There is no
/// cycle: each step leads lower, or level to a cell that the flood reached earlier.
void descend(Raster<float> const& level, Sinks const& sinks, Raster<Direction>& direction, Run const& run) {
    auto const offsets = d8_offsets(level.grid());
    parallel_ranges(run, level.cells(), cells_between_checks, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (std::isnan(level[i]) || contains(sinks, i)) {
                continue;
            }
            Descent const down = steepest_descent(level[i], [&](std::size_t k) { return level[i + offsets[k]]; });
            direction[i] = down.direction == Direction::leaves ? direction[i] : down.direction;
        }
    });
}

/// Directs each cell to its steepest lower neighbour, if all cells have one but those where water leaves: then a flood
/// would raise none and direct none otherwise.
std::optional<Raster<Direction>> all_downhill(Raster<float> const& dem, Sinks const& sinks, Run const& run) {
    constexpr std::int64_t rows_between_checks = 16;
    Grid const& grid = dem.grid();
    Raster<Direction> direction(grid, Direction::leaves);
    auto const offsets = d8_offsets(grid);
    std::atomic<bool> drains = true;
    auto const direct = [&](Cell at) {
        std::int64_t const i = grid.index(at);
        if (std::isnan(dem[i])) {
            direction[i] = Direction::no_data;
        } else if (contains(sinks, i)) {
            return true;
        } else if (grid.on_border(at)) {
            direction[i] = steepest_descent(dem, at).direction;
        } else {
            direction[i] = steepest_descent(dem[i], [&](std::size_t k) { return dem[i + offsets[k]]; }).direction;
            return direction[i] != Direction::leaves ||
                   std::any_of(offsets.begin(), offsets.end(),
                               [&](std::int64_t step) { return std::isnan(dem[i + step]); });
        }
        return true;
    };
    parallel_ranges(run, grid.height, rows_between_checks, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end && drains.load(std::memory_order_relaxed); ++row) {
            run.check();
            for (std::int64_t col = 0; col < grid.width; ++col) {
                if (!direct({col, row})) {
                    drains.store(false, std::memory_order_relaxed);
                    break;
                }
            }
        }
    });
    return drains ? std::optional(std::move(direction)) : std::nullopt;
}

void accumulate(FlowField& drainage, Run const& run) {
    drainage.area_cells = Raster<CellCount>(drainage.grid());
    for (std::int64_t i = 0; i < drainage.area_cells.cells(); ++i) {
        drainage.area_cells[i] = drainage.direction[i] == Direction::no_data ? 0 : 1;
    }
    each_downstream(drainage.direction, run, [&](std::int64_t cell, std::int64_t receiver) {
        drainage.area_cells[receiver] += drainage.area_cells[cell];
    });
}

/// Lists the depressions of a DEM from its water levels, which it consumes.
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

/// The sinks, ascending.
Sinks sinks_of(Raster<float> const& dem, std::vector<std::int64_t> sinks) {
    for (std::int64_t const sink : sinks) {
        refuse_if<BadInput>(sink < 0 || sink >= dem.cells() || std::isnan(dem[sink]), "flow.route",
                            "the sink in cell {} has no height; give cells of the DEM", sink);
    }
    std::sort(sinks.begin(), sinks.end());
    return sinks;
}

/// Converts indices of cells to the framed DEM, in which they have the same order.
Sinks framed_sinks(Grid const& grid, Grid const& framed, Sinks const& sinks) {
    Sinks cells;
    for (std::int64_t const sink : sinks) {
        Cell const c = grid.at(sink);
        cells.push_back(framed.index({c.col + 1, c.row + 1}));
    }
    return cells;
}

/// Fills the DEM for the directions of a flow field and its depressions.
FlowField through_depressions(Raster<float> const& dem, Sinks const& sinks, Run const& run) {
    Raster<float> level = framed(dem);
    Sinks const ends = framed_sinks(dem.grid(), level.grid(), sinks);
    FlowField result;
    {
        Raster<Direction> direction = raise_to_spill(level, ends, run);
        descend(level, ends, direction, run);
        result.direction = unframed(direction, dem.grid());
    }
    CompensatedSum raised_m;
    for (std::int64_t r = 0; r < dem.height(); ++r) {
        auto const before = dem.row(r);
        auto const after = level.row(r + 1).subspan(1, before.size());
        for (std::size_t c = 0; c < before.size(); ++c) {
            if (after[c] > before[c]) {
                ++result.pits;
                raised_m.add(static_cast<double>(after[c]) - before[c]);
            }
        }
    }
    result.pit_volume_m3 = raised_m.value() * dem.grid().cell_m * dem.grid().cell_m;
    result.depressions = take_depressions(dem, level, run);
    return result;
}

/// Lengths of steps [m].
class StepLengths {
public:
    explicit StepLengths(Grid const& grid)
        : straight_(static_cast<float>(grid.cell_m)), diagonal_(static_cast<float>(grid.cell_m * std::sqrt(2.0))) {}

    float of(Direction direction) const { return is_diagonal(direction) ? diagonal_ : straight_; }

private:
    float straight_;
    float diagonal_;
};

/// The longest flow paths to some cells. Each is summed downstream as flow_lengths does it.
class PathsFromDivides {
public:
    explicit PathsFromDivides(Raster<Direction> const& direction) : direction_(direction), step_m_(direction.grid()) {}

    /// \return [m]
    float longest_to(Cell cell) {
        visits_.assign(1, {cell});
        while (true) {
            Visit& visit = visits_.back();
            if (to_next_donor(visit)) {
                Cell const step = d8_steps[visit.way];
                visits_.push_back({{visit.cell.col + step.col, visit.cell.row + step.row}});
                continue;
            }
            float const longest = visit.longest;
            visits_.pop_back();
            if (visits_.empty()) {
                return longest;
            }
            Visit& below = visits_.back();
            below.longest = std::max(below.longest, longest + step_m_.of(direction_of(below.way)));
            ++below.way;
        }
    }

private:
    struct Visit {
        Cell cell;
        std::size_t way = 0; ///< the neighbour whose donors are visited
        float longest = 0.0F;
    };

    /// Moves on to the next neighbour whose water comes here; false: there is none.
    bool to_next_donor(Visit& visit) const {
        for (; visit.way < d8_steps.size(); ++visit.way) {
            Cell const step = d8_steps[visit.way];
            Cell const there{visit.cell.col + step.col, visit.cell.row + step.row};
            if (direction_.grid().contains(there) && direction_[there] == opposite(direction_of(visit.way))) {
                return true;
            }
        }
        return false;
    }

    Raster<Direction> const& direction_;
    StepLengths step_m_;
    std::vector<Visit> visits_; ///< down to the cell asked for
};

} // namespace

void require_countable(Grid const& grid, char const* where) {
    refuse_if<BadInput>(std::cmp_greater(grid.cells(), std::numeric_limits<CellCount>::max()), where,
                        "{} x {} cells are 2^32 or more; take larger cells, or parts of the grid", grid.width,
                        grid.height);
}

FlowField route(Raster<float> const& dem, Run const& run) {
    return route(dem, {}, run);
}

FlowField route(Raster<float> const& dem, std::vector<std::int64_t> const& sinks, Run const& run) {
    Grid const& grid = dem.grid();
    refuse_if<BadInput>(grid.cells() == 0, "flow.route", "the DEM has no cells");
    require_countable(grid, "flow.route");
    auto const values = dem.values();
    auto const infinite = std::find_if(values.begin(), values.end(), [](float z) { return std::isinf(z); });
    if (infinite != values.end()) {
        Cell const cell = grid.at(infinite - values.begin());
        throw BadInput("flow.route",
                       fmt::format("the height at column {}, row {} is infinite; mark cells without data as NaN",
                                   cell.col, cell.row));
    }
    Sinks const ends = sinks_of(dem, sinks);
    auto downhill = all_downhill(dem, ends, run);
    FlowField result = downhill ? FlowField{*std::move(downhill), {}} : through_depressions(dem, ends, run);
    accumulate(result, run);
    return result;
}

Raster<float> flow_lengths(FlowField const& drainage, Run const& run) {
    StepLengths const step_m(drainage.grid());
    Raster<float> length(drainage.grid());
    each_downstream(drainage.direction, run, [&](std::int64_t cell, std::int64_t receiver) {
        length[receiver] = std::max(length[receiver], length[cell] + step_m.of(drainage.direction[cell]));
    });
    return length;
}

std::vector<float> flow_lengths_to(std::vector<std::int64_t> const& cells, FlowField const& drainage, Run const& run) {
    constexpr std::int64_t together = 64;
    std::vector<float> lengths(cells.size());
    parallel_ranges(run, static_cast<std::int64_t>(cells.size()), together, [&](std::int64_t begin, std::int64_t end) {
        PathsFromDivides paths(drainage.direction);
        for (std::int64_t i = begin; i < end; ++i) {
            run.check();
            lengths[i] = paths.longest_to(drainage.grid().at(cells[i]));
        }
    });
    return lengths;
}

} // namespace thalweg::flow
