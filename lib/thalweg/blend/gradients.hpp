// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include <thalweg/core/tin.hpp>
#include <thalweg/geometry/cotangents.hpp>

namespace thalweg::blend {

/// Gradients of the three coordinates of a mesh in a triangle of a parameter mesh.
struct CoordinateGradients {
    Vec3 x;
    Vec3 y;
    Vec3 z;
};

/// A linear map of space, by rows.
using LinearMap = std::array<Vec3, 3>;

/// Makes a rotation about an axis through the origin, with a scale.
/// \param axis of any length above 0; the rotation is counterclockwise seen against it
/// \param angle_deg [deg] |angle_deg| <= 1e6
/// \param scale > 0
/// \return the linear map
/// \throws BadParameter when a parameter is outside its range
LinearMap rotation(Vec3 axis, double angle_deg, double scale = 1.0);

/// Maps gradients as if their triangle were rotated and scaled; its position does not matter.
/// \param map linear map
/// \param gradients of one triangle
/// \return the mapped gradients
CoordinateGradients mapped(LinearMap const& map, CoordinateGradients const& gradients);

/// Computes the gradients of the hat functions of a triangle, times its area.
/// \param a,b,c corners [m]; area above 0 as measured
/// \param measured in plan or in space
/// \return by corner: of the function that is 1 there and 0 at the others
std::array<Vec3, 3> hat_gradients_by_area(Vec3 const& a, Vec3 const& b, Vec3 const& c, geometry::Measured measured);

/// Computes the gradients of a mesh's coordinates in the triangles of a parameter mesh.
/// \param parameter triangles with area above 0
/// \param places by vertex of the parameter mesh: position in the mesh
/// \param measured in plan or in space
/// \return by triangle
/// \throws BadInput when sizes differ, or naming a triangle without area
///
/// Source: \cite nenu2015, eqs 14 and 15; \cite yu2004.
std::vector<CoordinateGradients> gradients_of(Tin const& parameter, std::vector<Vec3> const& places,
                                              geometry::Measured measured = geometry::Measured::in_plan);

} // namespace thalweg::blend
