// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/geometry/triangles.hpp>

// Idea: Poisson editing of meshes. In each triangle a coordinate is linear and has one gradient.
// The mesh whose gradients are closest to wanted ones (those of another mesh, or rotated and
// scaled) is the solution of a sparse linear system, the cotangent Laplacian, with some vertices
// fixed. The matrix depends on the parameter mesh alone, so it is factored once for all three
// coordinates; in plan only z is solved for, and terrain remains terrain. fuse_tin cuts the target
// along the patch's outline, splits the patch's edges there, and bends the patch to the target's
// heights on it.
// Source: Yu et al. 2004; Northeast Normal University 2015, equations 14 to 16 and algorithm 1.
// Cost: one sparse Cholesky factorisation (solver/linear/linear.hpp) for the vertices of the patch,
// besides an overlay of both meshes with exact crossings. One thread.
// Not for: rasters (paste.hpp); patches with holes or several outlines; large rotations of surfaces
// that fold: a gradient knows only its triangle.
// Example:
//     FusedTin const fused = fuse_tin(tin, patch_tin);
//     std::vector<CoordinateGradients> const own = gradients_of(tin, tin.vertices);
//     PastedTin const same = paste_tin(tin, own, {{0, tin.vertices[0]}});
// More: docs/decisions/0012-blending.md.

namespace thalweg::blend {

/// Gradients of the three coordinates of a mesh in a triangle of a parameter mesh.
struct CoordinateGradients {
    Vec3 x; ///< [-]
    Vec3 y; ///< [-]
    Vec3 z; ///< [-]
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

/// A vertex with a prescribed position.
struct FixedVertex {
    std::uint32_t vertex = 0;
    Vec3 at; ///< [m]
};

/// A mesh reconstructed from gradients.
struct PastedTin {
    Tin tin;
    double residual = 0.0; ///< relative, the largest of the systems solved
};

/// Reconstructs the mesh whose triangles follow guidance gradients as closely as fixed vertices allow: Div(grad x) =
/// Div w at the other vertices, likewise for y and z, with one factorisation. Measured in plan, only z is solved for:
/// terrain remains terrain.
/// \param parameter parameter mesh
/// \param guidance by triangle: gradients to follow
/// \param fixed at least one in each connected part
/// \param measured in plan or in space
/// \return the parameter mesh's triangles over new vertices; vertices in no triangle stay. With the mesh's own
/// gradients and unmoved vertices the mesh bit for bit; with all gradients rotated and one vertex fixed, the mesh
/// rotated about it.
/// \throws BadInput naming triangle or vertex when sizes do not match, a triangle has no area, a number is not finite,
/// a vertex is fixed at two positions or a part has no fixed vertex
/// \throws NotConverged when the solver does not reach its tolerance
///
/// Source: \cite nenu2015, eqs 14 to 16; \cite yu2004, Mesh editing with Poisson-based gradient field manipulation.
PastedTin paste_tin(Tin const& parameter, std::vector<CoordinateGradients> const& guidance,
                    std::vector<FixedVertex> const& fixed, geometry::Measured measured = geometry::Measured::in_plan,
                    Run const& run = {});

/// Two meshes fused into one.
struct FusedTin {
    Tin tin;
    std::int64_t removed = 0; ///< vertices of the target inside the patch's outline
    std::int64_t inner = 0;   ///< vertices of the patch inside its outline
    std::int64_t added = 0;   ///< vertices on the outline that are not the target's
    double lift_max_m = 0.0;  ///< [m] largest vertical shift of a vertex on the patch's edge
    double residual = 0.0;    ///< as in PastedTin
};

/// Pastes a TIN into another without a seam: inside the patch's outline are the patch's triangles and gradients, on the
/// outline the target's heights.
/// \param target one height per position; any number of parts
/// \param patch one height per position, one boundary; in the target's coordinates
/// \return the target's vertices outside bit for bit; around the outline its triangles, cut along the outline; inside
/// the patch's triangles, cut where target edges cross the outline, with vertices in their order. Heights inside are
/// those of paste_tin with the patch's gradients as guidance and a fixed outline. A patch cut from the target gives the
/// target's heights, to rounding.
/// \throws BadInput as facing_up, outline_of and cut_tin, also when vertices of the two meshes are too close
/// \throws NotConverged when the solver does not reach its tolerance
///
/// Source: \cite nenu2015, algorithm 1 and equations 14 to 16; \cite yu2004 (merging).
FusedTin fuse_tin(Tin const& target, Tin const& patch, Run const& run = {});

} // namespace thalweg::blend
