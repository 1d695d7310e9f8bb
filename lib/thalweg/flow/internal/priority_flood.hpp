// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/direction.hpp>

namespace thalweg::flow {

/// A queue of cells by height, first in first out among equals (both zeros are equal). A cell must not be below the one
/// popped last, as in a flood. `Index` holds any cell. Source: radix heap of \cite ahuja1990.
template <class Index> class FloodQueue {
public:
    void push(float z, std::int64_t cell) { put({rank_of(z), static_cast<Index>(cell)}); }

    /// \return the lowest cell; -1: empty.
    std::int64_t pop() {
        if (next_ == lowest_.size() && !advance()) {
            return -1;
        }
        return static_cast<std::int64_t>(lowest_[next_++].cell);
    }

private:
    struct Entry {
        std::uint32_t rank = 0;
        Index cell = 0;
    };

    /// Maps floats to unsigned numbers in the same order.
    static std::uint32_t rank_of(float z) {
        auto const bits = std::bit_cast<std::uint32_t>(z + 0.0F);
        constexpr std::uint32_t sign = 0x80000000U;
        return (bits & sign) != 0 ? ~bits : bits | sign;
    }

    void put(Entry entry) {
        if (entry.rank == last_) {
            lowest_.push_back(entry);
        } else {
            auto const bucket = static_cast<std::uint32_t>(std::bit_width(entry.rank ^ last_)) - 1;
            above_[bucket].push_back(entry);
            filled_ |= 1U << bucket;
        }
    }

    bool advance() {
        lowest_.clear();
        next_ = 0;
        if (filled_ == 0) {
            return false;
        }
        auto const bucket = static_cast<std::uint32_t>(std::countr_zero(filled_));
        filled_ ^= 1U << bucket;
        if (bucket == 0) { // all of one rank
            lowest_.swap(above_[0]);
            last_ = lowest_.front().rank;
            return true;
        }
        moving_.swap(above_[bucket]);
        last_ =
            std::min_element(moving_.begin(), moving_.end(), [](Entry a, Entry b) { return a.rank < b.rank; })->rank;
        std::for_each(moving_.begin(), moving_.end(), [this](Entry e) { put(e); });
        moving_.clear();
        return true;
    }

    std::uint32_t last_ = 0;
    std::vector<Entry> lowest_;                ///< of rank last_
    std::size_t next_ = 0;                     ///< in lowest_
    std::vector<Entry> moving_;                ///< keeps its memory between calls
    std::uint32_t filled_ = 0;                 ///< bit by bucket: not empty
    std::array<std::vector<Entry>, 32> above_; ///< by the highest bit in which a rank differs from last_
};

/// Calls flood with an empty queue that holds the cells of a grid.
template <class Flood> auto with_queue(Grid const& grid, Flood flood) {
    if (std::cmp_less_equal(grid.cells(), std::numeric_limits<std::uint32_t>::max())) {
        return flood(FloodQueue<std::uint32_t>());
    }
    return flood(FloodQueue<std::int64_t>());
}

/// Fills a framed DEM to its spill levels.
/// \param is_outlet called with a cell; true: water leaves there, besides at the border and beside no data
/// \return by cell: direction towards the cell from which the flood reached it
///
/// Source: \cite barnes2014.
template <class Queue, class IsOutlet>
Raster<Direction> priority_flood(Queue queue, Raster<float>& level, IsOutlet is_outlet, char const* stage,
                                 Run const& run) {
    constexpr auto unreached = static_cast<Direction>(253);
    Raster<Direction> direction(level.grid(), unreached);
    auto const offsets = d8_offsets(level.grid());
    for (std::int64_t i = 0; i < level.cells(); ++i) {
        if (std::isnan(level[i])) {
            direction[i] = Direction::no_data;
        } else if (is_outlet(i) || std::any_of(offsets.begin(), offsets.end(),
                                               [&](std::int64_t step) { return std::isnan(level[i + step]); })) {
            direction[i] = Direction::leaves;
            queue.push(level[i], i);
        }
    }
    std::int64_t popped = 0;
    for (std::int64_t i = queue.pop(); i >= 0; i = queue.pop()) {
        if (++popped % cells_between_checks == 0) {
            run.at(static_cast<double>(popped) / static_cast<double>(level.cells()), stage);
        }
        float const least = level[i];
        for (std::size_t k = 0; k < offsets.size(); ++k) {
            std::int64_t const n = i + offsets[k];
            if (direction[n] == unreached) {
                direction[n] = opposite(direction_of(k));
                level[n] = std::max(level[n], least);
                queue.push(level[n], n);
            }
        }
    }
    return direction;
}

template <class IsOutlet>
Raster<Direction> priority_flood(Raster<float>& level, IsOutlet is_outlet, char const* stage, Run const& run) {
    return with_queue(level.grid(),
                      [&](auto queue) { return priority_flood(std::move(queue), level, is_outlet, stage, run); });
}

} // namespace thalweg::flow
