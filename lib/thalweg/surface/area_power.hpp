// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/elementary.hpp>

/// Private to this room.
namespace thalweg::surface {

/// area ^ exponent from a table: exact for whole numbers below 512, beyond for areas rounded down to nine binary
/// digits.
class AreaPower {
public:
    explicit AreaPower(double exponent) {
        for (std::size_t i = 0; i < table_.size(); ++i) {
            auto const bits = static_cast<std::uint32_t>((i + first) << dropped);
            table_[i] = static_cast<float>(exact::pow(static_cast<double>(std::bit_cast<float>(bits)), exponent));
        }
    }

    /// Takes: 1 <= area < 2^64.
    float operator()(float area) const { return table_[(std::bit_cast<std::uint32_t>(area) >> dropped) - first]; }

private:
    static constexpr std::uint32_t dropped = 15;
    static constexpr std::size_t first = std::size_t{127} << 8;
    std::vector<float> table_ = std::vector<float>(std::size_t{64} << 8);
};

} // namespace thalweg::surface
