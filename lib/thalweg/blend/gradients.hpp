// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <thalweg/core/tin.hpp>
#include <thalweg/geometry/cotangents.hpp>

namespace thalweg::blend {

/// Gradients of a mesh's three coordinates within one triangle of a parameter mesh.
struct CoordinateGradients {
    Vec3 x;
    Vec3 y;
    Vec3 z;
};

/// A linear map of space, row by row.
using LinearMap = std::array<Vec3, 3>;

/// Turns counterclockwise about an axis through the origin, seen against it, and scales.
/// \pre an axis of any length above 0; |angle_deg| <= 1e6.
/// \param axis the axis, seen against it
/// \param angle_deg [degrees] angle
/// \param scale > 0, factor
/// \return the linear map
/// \throws BadParameter
LinearMap rotation(Vec3 axis, double angle_deg, double scale = 1.0);

/// \param map the linear map
/// \param gradients the gradients
/// \return the gradients of a triangle turned and scaled about any point, its centre for one: gradients do not feel
/// where.
CoordinateGradients mapped(LinearMap const& map, CoordinateGradients const& gradients);

/// \pre a triangle with area where it is measured.
/// \param a [m] corner 0
/// \param b [m] corner 1
/// \param c [m] corner 2
/// \param measured in plan or in space
/// \return the gradients of the three hat functions of a triangle, times its area; hat k is 1 at corner k.
std::array<Vec3, 3> hat_gradients_by_area(Vec3 const& a, Vec3 const& b, Vec3 const& c, geometry::Measured measured);

/// How the coordinates of a mesh change within the triangles of a parameter mesh.
/// \pre a parameter mesh whose triangles have area; a place for each of its vertices.
/// \param parameter the parameter mesh
/// \param places the places
/// \param measured in plan or in space
/// \return for each triangle the gradients of the functions linear in it.
/// \throws BadInput
///
/// Source: \cite nenu2015, eqs 14 and 15; \cite yu2004.
std::vector<CoordinateGradients> gradients_of(Tin const& parameter, std::vector<Vec3> const& places,
                                              geometry::Measured measured = geometry::Measured::in_plan);

} // namespace thalweg::blend
