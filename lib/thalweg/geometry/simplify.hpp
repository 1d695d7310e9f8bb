// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// Leaves out vertices of a polyline.
/// \param line [m] finite
/// \param tolerance_m [m] >= 0
/// \return some of its vertices, both ends among them; no other is farther than that from the straight lines between
/// them
///
/// Source: Douglas and Peucker, by Boost.Geometry.
std::vector<Vec2> simplify(std::vector<Vec2> const& line, double tolerance_m);

} // namespace thalweg::geometry
