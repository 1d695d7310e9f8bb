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

/// The area within a ring, relative to its first vertex, so that large coordinates lose no digits.
/// \param ring [m] the first vertex may be repeated at the end
/// \return [m2] positive where it runs counterclockwise
double signed_area(std::vector<Vec2> const& ring);

/// Whether a position lies inside a ring.
/// \param ring [m] likewise
/// \param p [m]
/// \return by the even-odd rule; on the ring itself either answer is possible
bool contains(std::vector<Vec2> const& ring, Vec2 p);

} // namespace thalweg::geometry
