// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <thalweg/core/numbers/random.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Calls visit(column, byte) with a byte at random for each of `count` columns of a row of a level: thirty-two of them
/// cost one block of chance.
template <class Visit>
void random_bytes(std::uint64_t seed, std::uint64_t stage, std::int64_t row, float side, std::int64_t count,
                  Visit visit) {
    for (std::int64_t first = 0; first < count; first += 32) {
        auto const words = random_block(seed, stage, static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(first),
                                        static_cast<std::uint64_t>(side));
        for (std::int64_t col = first; col < std::min(first + 32, count); ++col) {
            auto const k = static_cast<std::size_t>(col - first);
            visit(col, static_cast<std::uint8_t>(words[k / 8] >> (8 * (k % 8))));
        }
    }
}

} // namespace thalweg::surface
