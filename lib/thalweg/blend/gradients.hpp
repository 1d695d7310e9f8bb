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
/// Takes: an axis of any length above 0; |angle_deg| <= 1e6. Throws: BadParameter.
LinearMap rotation(Vec3 axis, double angle_deg, double scale = 1.0);

/// The gradients of a triangle turned and scaled about any point, its centre for one: gradients do not feel where.
CoordinateGradients mapped(LinearMap const& map, CoordinateGradients const& gradients);

/// The gradients of the three hat functions of a triangle, times its area; hat k is 1 at corner k.
/// Takes: a triangle with area where it is measured.
std::array<Vec3, 3> hat_gradients_by_area(Vec3 const& a, Vec3 const& b, Vec3 const& c, geometry::Measured measured);

/// How the coordinates of a mesh change within the triangles of a parameter mesh.
/// Takes: a parameter mesh whose triangles have area; a place for each of its vertices.
/// Gives: for each triangle the gradients of the functions linear in it. Throws: BadInput.
/// Source: paper 003, eqs 14 and 15; Yu et al. 2004.
std::vector<CoordinateGradients> gradients_of(Tin const& parameter, std::vector<Vec3> const& places,
                                              geometry::Measured measured = geometry::Measured::in_plan);

} // namespace thalweg::blend
