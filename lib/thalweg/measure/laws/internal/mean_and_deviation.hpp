// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <span>

#include <thalweg/core/numbers/compensated_sum.hpp>

namespace thalweg::measure {

struct MeanAndDeviation {
    double mean = 0.0;
    double deviation = 0.0; ///< of all values, not of a sample
};

/// Takes: one value at least.
inline MeanAndDeviation mean_and_deviation(std::span<double const> values) {
    auto const n = static_cast<double>(values.size());
    CompensatedSum sum;
    for (double const v : values) {
        sum.add(v);
    }
    double const mean = sum.value() / n;
    CompensatedSum squares;
    for (double const v : values) {
        squares.add((v - mean) * (v - mean));
    }
    return {mean, std::sqrt(squares.value() / n)};
}

} // namespace thalweg::measure
