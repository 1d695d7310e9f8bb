// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/measure/drainage.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>

#include <fmt/format.h>

#include <thalweg/core/error.hpp>
#include <thalweg/core/parallel.hpp>
#include <thalweg/measure/compensated_sum.hpp>

namespace thalweg::measure {

namespace {

constexpr std::int8_t unreached = -3;
constexpr std::int64_t cells_between_checks = 1 << 18;

/// Order of floats as unsigned numbers; both zeros are one.
std::uint32_t rank_of(float z) {
    auto const bits = std::bit_cast<std::uint32_t>(z + 0.0F);
    constexpr std::uint32_t sign = 0x80000000U;
    return (bits & sign) != 0 ? ~bits : bits | sign;
}

/// Cells by height, first in first out among equals. The flood never pushes below what it popped last: a radix heap.
class FloodQueue {
public:
    void push(float z, std::int64_t cell) { put({rank_of(z), cell}); }

    /// The lowest cell, or -1 when there is none.
    std::int64_t pop() {
        if (lowest_.empty() && !advance()) {
            return -1;
        }
        std::int64_t const cell = lowest_.front();
        lowest_.pop_front();
        return cell;
    }

private:
    struct Entry {
        std::uint32_t rank;
        std::int64_t cell;
    };

    void put(Entry entry) {
        if (entry.rank == last_) {
            lowest_.push_back(entry.cell);
        } else {
            above_[static_cast<std::size_t>(std::bit_width(entry.rank ^ last_)) - 1].push_back(entry);
        }
    }

    bool advance() {
        auto const bucket = std::find_if(above_.begin(), above_.end(), [](auto const& b) { return !b.empty(); });
        if (bucket == above_.end()) {
            return false;
        }
        std::vector<Entry> entries;
        entries.swap(*bucket);
        last_ =
            std::min_element(entries.begin(), entries.end(), [](Entry a, Entry b) { return a.rank < b.rank; })->rank;
        std::for_each(entries.begin(), entries.end(), [this](Entry e) { put(e); });
        return true;
    }

    std::uint32_t last_ = 0;
    std::deque<std::int64_t> lowest_;
    std::array<std::vector<Entry>, 32> above_; ///< by the highest bit in which a rank differs from last_
};

/// Calls visit(direction, neighbour index) for the neighbours of a cell that lie on the grid.
template <class Visit> void for_neighbours(Grid const& grid, std::int64_t cell, Visit const& visit) {
    Cell const at = grid.at(cell);
    bool const inside = !grid.on_border(at);
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        Cell const step = d8_steps[k];
        if (inside || grid.contains({at.col + step.col, at.row + step.row})) {
            visit(static_cast<std::int8_t>(k), cell + step.row * grid.width + step.col);
        }
    }
}

/// Raises depressions to the level at which they spill; direction becomes the way back to where the flood came from.
void flood(Raster<float>& filled, Raster<std::int8_t>& direction, Run const& run) {
    Grid const& grid = filled.grid();
    FloodQueue queue;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (std::isnan(filled[i])) {
            direction[i] = d8_no_data;
            continue;
        }
        bool seed = grid.on_border(grid.at(i));
        for_neighbours(grid, i, [&](std::int8_t, std::int64_t n) { seed = seed || std::isnan(filled[n]); });
        if (seed) {
            direction[i] = d8_leaves;
            queue.push(filled[i], i);
        }
    }
    std::int64_t popped = 0;
    for (std::int64_t i = queue.pop(); i >= 0; i = queue.pop()) {
        if (++popped % cells_between_checks == 0) {
            run.at(static_cast<double>(popped) / static_cast<double>(grid.cells()), "drain");
        }
        for_neighbours(grid, i, [&](std::int8_t k, std::int64_t n) {
            if (direction[n] == unreached) {
                direction[n] = static_cast<std::int8_t>((k + 4) % 8);
                filled[n] = std::max(filled[n], filled[i]);
                queue.push(filled[n], n);
            }
        });
    }
}

/// Turns cells that have a lower neighbour towards the one down the steepest slope. With the flood's way for the others
/// there is no cycle: each step leads lower, or level to a cell that the flood reached earlier.
void descend(Raster<float> const& filled, Raster<std::int8_t>& direction, Run const& run) {
    constexpr double diagonal = 0.70710678118654752440;
    Grid const& grid = filled.grid();
    parallel_ranges(run, grid.cells(), cells_between_checks, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            double steepest = 0.0;
            for_neighbours(grid, i, [&](std::int8_t k, std::int64_t n) {
                double const drop = static_cast<double>(filled[i]) - filled[n];
                double const slope = k % 2 == 0 ? drop : drop * diagonal;
                if (slope > steepest) { // never beside NaN
                    steepest = slope;
                    direction[i] = k;
                }
            });
        }
    });
}

void accumulate(Drainage& drainage, Run const& run) {
    Raster<std::int8_t> const& direction = drainage.direction;
    Raster<std::int64_t>& area = drainage.area_cells;
    Grid const& grid = direction.grid();
    auto const below = [&](std::int64_t i) {
        Cell const step = d8_steps[static_cast<std::size_t>(direction[i])];
        return i + step.row * grid.width + step.col;
    };
    constexpr std::int8_t done = -1;
    Raster<std::int8_t> awaited(grid); // neighbours whose water has not arrived yet
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        area[i] = direction[i] == d8_no_data ? 0 : 1;
        if (direction[i] >= 0) {
            ++awaited[below(i)];
        }
    }
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
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

} // namespace

Drainage drain(Raster<float> const& dem, Run const& run) {
    Grid const& grid = dem.grid();
    if (grid.cells() == 0) {
        throw BadInput("measure.drain: the DEM has no cells");
    }
    auto const values = dem.values();
    auto const infinite = std::find_if(values.begin(), values.end(), [](float z) { return std::isinf(z); });
    if (infinite != values.end()) {
        Cell const cell = grid.at(infinite - values.begin());
        throw BadInput(
            fmt::format("measure.drain: the height at column {}, row {} is infinite; mark cells without data as NaN",
                        cell.col, cell.row));
    }
    Drainage result{Raster<std::int8_t>(grid, unreached), Raster<std::int64_t>(grid), 0, 0.0};
    {
        Raster<float> filled = dem;
        flood(filled, result.direction, run);
        CompensatedSum raised_m;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (filled[i] > dem[i]) {
                ++result.pits;
                raised_m.add(static_cast<double>(filled[i]) - dem[i]);
            }
        }
        result.pit_volume_m3 = raised_m.value() * grid.cell_m * grid.cell_m;
        descend(filled, result.direction, run);
    }
    accumulate(result, run);
    return result;
}

} // namespace thalweg::measure
