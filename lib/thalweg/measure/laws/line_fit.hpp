// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg::measure {

/// A straight line through points, and how well it goes through them.
struct LineFit {
    double slope = 0.0;
    double intercept = 0.0;                               ///< y at x = 0
    double r2 = std::numeric_limits<double>::quiet_NaN(); ///< share of y's variance explained; NaN of two points, or
                                                          ///< where y is constant
    double slope_error = std::numeric_limits<double>::quiet_NaN(); ///< standard error; NaN of two points
    std::int64_t points = 0;
};

/// \pre weights, one a point and above 0; or none: every point counts once.
/// \param points the points
/// \param weights the weights
/// \return the straight line of least squares; none through fewer than two different x.
std::optional<LineFit> fit_line(std::vector<Vec2> const& points, std::vector<double> const& weights = {});

} // namespace thalweg::measure
