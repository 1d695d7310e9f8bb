// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// On which side of the line from a to b the point p lies: 1 left, -1 right, 0 on it.
/// \pre finite coordinates.
/// \param a [m] where the line starts
/// \param b [m] where it ends
/// \param p [m] a position
/// \return the sign of the exact determinant of the coordinates as they stand.
///
/// Source: \cite shewchuk1997, Adaptive precision floating-point arithmetic; what its filter leaves open, CGAL decides.
int side_of_line(Vec2 a, Vec2 b, Vec2 p);

} // namespace thalweg::geometry
