// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <thalweg/core/numbers/elementary.hpp>

/// Private to this module.
namespace thalweg::surface {

/// factor area ^ exponent from a table: exact for whole numbers below 512, beyond for areas rounded down to nine binary
/// digits. bend_area: area below which the power hardly falls any more, to that of the bend; 0: none.
class AreaPower {
public:
    explicit AreaPower(double exponent, double bend_area = 0.0, double factor = 1.0) {
        double const least = bend_area > 0.0 ? portable::pow(bend_area, sharpness * exponent) : 0.0;
        for (std::size_t i = 0; i < table_.size(); ++i) {
            auto const bits = static_cast<std::uint32_t>((i + first) << dropped);
            auto const area = static_cast<double>(std::bit_cast<float>(bits));
            table_[i] = static_cast<float>(
                factor * (least > 0.0
                              ? portable::pow(portable::pow(area, sharpness * exponent) + least, 1.0 / sharpness)
                              : portable::pow(area, exponent)));
        }
    }

    /// Takes: 1 <= area < 2^64.
    float operator()(float area) const { return table_[(std::bit_cast<std::uint32_t>(area) >> dropped) - first]; }

private:
    static constexpr double sharpness = 2.0; // of the bend
    static constexpr std::uint32_t dropped = 15;
    static constexpr std::size_t first = std::size_t{127} << 8;
    std::vector<float> table_ = std::vector<float>(std::size_t{64} << 8);
};

} // namespace thalweg::surface
