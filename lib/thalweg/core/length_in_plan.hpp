// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// The length of a polyline in plan.
/// \param line vertices [m]; heights are not read
/// \return [m]
inline double length_in_plan(std::vector<Vec3> const& line) {
    double sum = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum += distance(plan(line[i - 1]), plan(line[i]));
    }
    return sum;
}

} // namespace thalweg
