// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// Finds the side of the line from a to b on which p lies.
/// \param a,b,p [m] finite
/// \return 1 left, -1 right, 0 on the line: the sign of the exact determinant
///
/// Source: \cite shewchuk1997, Adaptive precision floating-point arithmetic; what its filter leaves open, CGAL decides.
int side_of_line(Vec2 a, Vec2 b, Vec2 p);

} // namespace thalweg::geometry
