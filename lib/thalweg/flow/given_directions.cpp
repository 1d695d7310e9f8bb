// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/given_directions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/flow/internal/cell_count.hpp>
#include <thalweg/flow/internal/each_downstream.hpp>

namespace thalweg::flow {
namespace {

constexpr std::int32_t no_code = std::numeric_limits<std::int32_t>::min();

/// The numbers of a program.
struct Codes {
    std::array<std::int32_t, 8> to; ///< by direction: E, SE, S, SW, W, NW, N, NE
    std::int32_t ends;              ///< water ends or leaves; no_code: it has none
    std::array<std::int32_t, 2> no_data;
    bool has_signs = false; ///< below 0: water leaves the map in that direction
};

Codes const& codes_of(DirectionCodes of) {
    static constexpr std::array<Codes, 7> all{{
        {{0, 1, 2, 3, 4, 5, 6, 7}, 255, {254, no_code}},
        {{1, 2, 4, 8, 16, 32, 64, 128}, 0, {255, 247}},
        {{8, 7, 6, 5, 4, 3, 2, 1}, 0, {no_code, no_code}, true},
        {{6, 3, 2, 1, 4, 7, 8, 9}, 5, {255, 0}},
        {{2, 3, 4, 5, 6, 7, 0, 1}, no_code, {-1, no_code}},
        {{1, 8, 7, 6, 5, 4, 3, 2}, no_code, {-32768, 0}},
        {{2, 4, 8, 16, 32, 64, 128, 1}, 0, {-32768, no_code}},
    }};
    return all[static_cast<std::size_t>(of)];
}

/// Calls visit(i, cell) for every cell, row by row.
template <class Visit> void each_cell(Grid const& grid, Run const& run, Visit visit) {
    std::int64_t i = 0;
    for (std::int64_t row = 0; row < grid.height; ++row) {
        run.check();
        for (std::int64_t col = 0; col < grid.width; ++col) {
            visit(i++, Cell{col, row});
        }
    }
}

/// Whether water of a cell runs to another cell with data.
bool reaches_data(Raster<Direction> const& direction, std::int64_t i, Cell here) {
    Cell const step = d8_steps[index_of(direction[i])];
    Cell const next{here.col + step.col, here.row + step.row};
    return direction.grid().contains(next) && direction[next] != Direction::no_data;
}

/// The index of the cell that a position lies in.
std::int64_t cell_at(FlowField const& drainage, Vec2 at, char const* where) {
    Grid const& grid = drainage.grid();
    Cell const cell = is_finite(at) ? grid.cell_of(at) : Cell{-1, -1};
    refuse_if<BadInput>(!grid.contains(cell), where,
                        "the point ({:.10g}, {:.10g}) is outside the grid, x {:.10g} to {:.10g}, y {:.10g} to {:.10g}",
                        at.x, at.y, grid.west, grid.east(), grid.south(), grid.north);
    refuse_if<BadInput>(drainage.direction[cell] == Direction::no_data, where,
                        "the DEM has no data at the point ({:.10g}, {:.10g})", at.x, at.y);
    return grid.index(cell);
}

/// The cell with the greatest area around a cell.
std::int64_t snapped(FlowField const& drainage, std::int64_t cell, Vec2 at, double most_m) {
    Grid const& grid = drainage.grid();
    Cell const here = grid.at(cell);
    auto const cells = static_cast<std::int64_t>(
        std::min(std::ceil(most_m / grid.cell_m), static_cast<double>(std::max(grid.width, grid.height))));
    std::int64_t best = cell;
    for (std::int64_t row = std::max<std::int64_t>(here.row - cells, 0);
         row <= std::min(here.row + cells, grid.height - 1); ++row) {
        for (std::int64_t col = std::max<std::int64_t>(here.col - cells, 0);
             col <= std::min(here.col + cells, grid.width - 1); ++col) {
            std::int64_t const i = grid.index({col, row});
            if (drainage.area_cells[i] > drainage.area_cells[best] && distance(grid.centre({col, row}), at) <= most_m) {
                best = i;
            }
        }
    }
    return best;
}

} // namespace

Raster<Direction> directions_of(Raster<std::int32_t> const& codes, DirectionCodes of, Run const& run) {
    Codes const& known = codes_of(of);
    Grid const& grid = codes.grid();
    Raster<Direction> direction(grid, Direction::no_data);
    each_cell(grid, run, [&](std::int64_t i, Cell cell) {
        std::int32_t const code = codes[i];
        if (code == no_code || std::ranges::find(known.no_data, code) != known.no_data.end()) {
            return;
        }
        if (code == known.ends) {
            direction[i] = Direction::leaves;
            return;
        }
        bool const is_signed = known.has_signs && code < 0;
        auto const found = std::ranges::find(known.to, is_signed ? -code : code);
        if (found == known.to.end()) {
            throw BadInput(
                "flow.directions_of",
                fmt::format("{} at column {}, row {} is no direction; the codes are {}, from the east clockwise{}",
                            code, cell.col, cell.row, fmt::join(known.to, ", "),
                            known.ends == no_code ? std::string()
                                                  : fmt::format(", and {} where water ends", known.ends)));
        }
        direction[i] = is_signed ? Direction::leaves : direction_of(static_cast<std::size_t>(found - known.to.begin()));
    });
    each_cell(grid, run, [&](std::int64_t i, Cell cell) {
        if (goes_on(direction[i]) && !reaches_data(direction, i, cell)) {
            direction[i] = Direction::leaves;
        }
    });
    return direction;
}

Raster<std::int32_t> codes_of(Raster<Direction> const& direction, DirectionCodes of, Run const& run) {
    Codes const& known = codes_of(of);
    Raster<std::int32_t> codes(direction.grid(), known.no_data.front());
    for (std::int64_t i = 0; i < direction.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        if (goes_on(direction[i])) {
            codes[i] = known.to[index_of(direction[i])];
        } else if (direction[i] == Direction::leaves && known.ends != no_code) {
            codes[i] = known.ends;
        }
    }
    return codes;
}

FlowField follow(Raster<Direction> const& direction, Run const& run) {
    Grid const& grid = direction.grid();
    refuse_if<BadInput>(grid.cells() == 0, "flow.follow", "the directions have no cells");
    require_countable(grid, "flow.follow");
    FlowField drainage{direction, Raster<CellCount>(grid)};
    std::int64_t left = 0; // cells whose water has not run on
    each_cell(grid, run, [&](std::int64_t i, Cell cell) {
        Direction const way = direction[i];
        if (goes_on(way) ? !reaches_data(direction, i, cell) : way != Direction::no_data && way != Direction::leaves) {
            throw BadInput("flow.follow", fmt::format("the direction {} at column {}, row {} leads off the grid, into "
                                                      "no data or nowhere; directions_of marks such cells",
                                                      static_cast<int>(way), cell.col, cell.row));
        }
        drainage.area_cells[i] = way == Direction::no_data ? 0 : 1;
        left += goes_on(way) ? 1 : 0;
    });
    each_downstream_in_order(direction, run, [&](std::int64_t cell, std::int64_t receiver) {
        drainage.area_cells[receiver] += drainage.area_cells[cell];
        --left;
    });
    refuse_if<BadInput>(left > 0, "flow.follow", "water of {} cells runs in a circle", left);
    return drainage;
}

Raster<double> accumulate(FlowField const& drainage, Raster<double> const& amounts, Run const& run) {
    Grid const& grid = drainage.grid();
    require_same_grid(amounts.grid(), grid, "flow.accumulate", "the amounts and the drainage",
                      "give amounts on the cells of the DEM");
    Raster<double> sum(grid, std::numeric_limits<double>::quiet_NaN());
    each_cell(grid, run, [&](std::int64_t i, Cell cell) {
        if (drainage.direction[i] == Direction::no_data) {
            return;
        }
        if (!std::isfinite(amounts[i])) {
            throw BadInput("flow.accumulate",
                           fmt::format("the amount at column {}, row {} is {}, where the DEM has data; give 0 for none",
                                       cell.col, cell.row, amounts[i]));
        }
        sum[i] = amounts[i];
    });
    each_downstream_in_order(drainage.direction, run,
                             [&](std::int64_t cell, std::int64_t receiver) { sum[receiver] += sum[cell]; });
    return sum;
}

Mask catchment(FlowField const& drainage, Vec2 outlet, CatchmentParams const& params, Run const& run) {
    require_in("flow.catchment", "snap_m", params.snap_m, Range::at_least(0.0));
    std::int64_t const mouth = snapped(drainage, cell_at(drainage, outlet, "flow.catchment"), outlet, params.snap_m);
    enum : std::uint8_t { outside, inside, unknown };
    Mask mask(drainage.grid(), unknown);
    mask[mouth] = inside;
    std::vector<std::int64_t> way;
    for (std::int64_t i = 0; i < mask.cells(); ++i) {
        if (i % cells_between_checks == 0) {
            run.check();
        }
        way.clear();
        std::int64_t at = i;
        for (; at >= 0 && mask[at] == unknown; at = drainage.receiver(at)) {
            way.push_back(at);
            mask[at] = outside;
        }
        if (at >= 0 && mask[at] == inside) {
            for (std::int64_t const cell : way) {
                mask[cell] = inside;
            }
        }
    }
    return mask;
}

std::vector<std::int64_t> path_down(FlowField const& drainage, Vec2 from, Run const& run) {
    std::vector<std::int64_t> path;
    for (std::int64_t at = cell_at(drainage, from, "flow.path_down"); at >= 0; at = drainage.receiver(at)) {
        refuse_if<BadInput>(std::ssize(path) > drainage.direction.cells(), "flow.path_down", "water runs in a circle");
        if (std::ssize(path) % cells_between_checks == 0) {
            run.check();
        }
        path.push_back(at);
    }
    return path;
}

} // namespace thalweg::flow
