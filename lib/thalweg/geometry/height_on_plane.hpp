// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// \pre finite coordinates; points that do not lie on one line in plan.
/// \param a [m] a point of the plane
/// \param b [m] a point of the plane
/// \param c [m] a point of the plane
/// \param p [m] a position
/// \return the height at p of the plane through three points, exact and rounded once: for slivers, where doubles lose
/// it.
///
/// Source: CGAL, exact constructions.
double height_on_plane(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec2 p);

} // namespace thalweg::geometry
