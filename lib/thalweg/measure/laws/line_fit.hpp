// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg::measure {

/// A least-squares line.
struct LineFit {
    double slope = 0.0;
    double intercept = 0.0; ///< y at x = 0
    /// share of y's variance explained; NaN: two points, or y is constant
    double r2 = std::numeric_limits<double>::quiet_NaN();
    double slope_error = std::numeric_limits<double>::quiet_NaN(); ///< standard error; NaN: two points
    std::int64_t points = 0;
};

/// Fits a line by least squares.
/// \param points x and y
/// \param weights > 0, one per point; empty: equal
/// \return nothing for fewer than two different x
std::optional<LineFit> fit_line(std::vector<Vec2> const& points, std::vector<double> const& weights = {});

} // namespace thalweg::measure
