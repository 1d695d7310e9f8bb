// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

/// Private to this module.
namespace thalweg::flow {

/// Cells by height, first in first out among equals (both zeros are equal).
/// Takes: never a cell below the one popped last, as a flood has none. Source: radix heap of Ahuja, Mehlhorn, Orlin and
/// Tarjan 1990.
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

    /// Order of floats as unsigned numbers.
    static std::uint32_t rank_of(float z) {
        auto const bits = std::bit_cast<std::uint32_t>(z + 0.0F);
        constexpr std::uint32_t sign = 0x80000000U;
        return (bits & sign) != 0 ? ~bits : bits | sign;
    }

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
        moving_.swap(*bucket);
        last_ =
            std::min_element(moving_.begin(), moving_.end(), [](Entry a, Entry b) { return a.rank < b.rank; })->rank;
        std::for_each(moving_.begin(), moving_.end(), [this](Entry e) { put(e); });
        moving_.clear();
        return true;
    }

    std::uint32_t last_ = 0;
    std::deque<std::int64_t> lowest_;
    std::vector<Entry> moving_;                ///< kept for its memory
    std::array<std::vector<Entry>, 32> above_; ///< by the highest bit in which a rank differs from last_
};

} // namespace thalweg::flow
