// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace thalweg::solver {

/// Differentiates heights along an axis: central, one-sided beside a hole (NaN), 0 between two holes.
/// \param before [m] height of the previous cell
/// \param here [m] height of the cell
/// \param after [m] height of the next cell
/// \return [m] per cell
inline double central_difference(float before, float here, float after) {
    double const z = here;
    if (std::isnan(before)) {
        return std::isnan(after) ? 0.0 : after - z;
    }
    return std::isnan(after) ? z - before : (static_cast<double>(after) - before) / 2.0;
}

} // namespace thalweg::solver
