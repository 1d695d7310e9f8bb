// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>

// Idea: What triangles need to be right. side_of_line is the sign of a determinant that floating
// point may get wrong: products are computed with their rounding errors, and what that leaves open
// is decided exactly. put_in_order follows a Morton curve, which interleaves the bits of x and y,
// so that neighbours in the plane are neighbours in memory. half_cotangents are the weights of the
// finite-element Laplacian: on a grid of halved squares they are the five-point stencil, so that
// meshes and rasters are blended by one equation.
// Source: Shewchuk 1997; Pinkall and Polthier 1993; Northeast Normal University 2015, equation 16;
// CGAL for what filters leave open.
// Cost: constant a call; ordering O(n) (radix sort); cotangents O(triangles). One thread.
// Not for: a maximum principle on meshes with obtuse angles: cotangents become negative there.
// Example:
//     int const side = side_of_line({0.0, 0.0}, {1.0, 0.0}, {0.5, 1e-9}); // 1: left
//     std::vector<std::array<double, 3>> const weights = half_cotangents(tin);

namespace thalweg::geometry {

/// Finds the side of the line from a to b on which p lies.
/// \param a,b,p [m] finite
/// \return 1 left, -1 right, 0 on the line: the sign of the exact determinant
///
/// Source: \cite shewchuk1997, Adaptive precision floating-point arithmetic; what its filter leaves open, CGAL decides.
int side_of_line(Vec2 a, Vec2 b, Vec2 p);

/// Computes the height of the plane through three points, exact and rounded once, also for slivers.
/// \param a,b,c [m] not collinear in plan
/// \param p [m] a position
/// \return [m] height at p
///
/// Source: CGAL, exact constructions.
double height_on_plane(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec2 p);

/// Puts the triangles of a TIN into a canonical order: each begins with its lowest vertex, and they follow the Morton
/// curve of these vertices, so that neighbours are close in memory and in files. Orientations stay.
/// \param tin finite vertices
/// \cpponly
void put_in_order(Tin& tin);

/// Whether angles and lengths of a TIN are measured in plan or in space.
enum class Measured : std::uint8_t {
    in_plan,   ///< heights are ignored
    on_surface ///< in space, for any triangle mesh
};

/// Computes half the cotangents of the angles of every triangle, as weights of the Laplacian.
/// \param tin triangles in either orientation, with area as measured
/// \param measured in plan or in space
/// \return by triangle, by corner: the triangle's share in the weight of the opposite edge. For a grid of halved
/// squares the weights of sides are 1 and of diagonals exactly 0: the stiffness row of an inner vertex is 4, -1, -1,
/// -1, -1.
/// \throws BadInput naming the triangle or vertex when one has no area, does not exist or is not finite
///
/// Source: \cite nenu2015, eq. 16; \cite pinkall1993.
std::vector<std::array<double, 3>> half_cotangents(Tin const& tin, Measured measured = Measured::in_plan);

} // namespace thalweg::geometry
