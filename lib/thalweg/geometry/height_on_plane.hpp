// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/vec.hpp>

namespace thalweg::geometry {

/// Computes the height of the plane through three points, exact and rounded once, also for slivers.
/// \param a,b,c [m] not collinear in plan
/// \param p [m] a position
/// \return [m] height at p
///
/// Source: CGAL, exact constructions.
double height_on_plane(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec2 p);

} // namespace thalweg::geometry
