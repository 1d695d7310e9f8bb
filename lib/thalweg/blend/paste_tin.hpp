// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/blend/gradients.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::blend {

/// A vertex whose place is given.
struct FixedVertex {
    std::uint32_t vertex = 0;
    Vec3 at; ///< [m]
};

/// A mesh put together again.
struct PastedTin {
    Tin tin;
    double residual = 0.0; ///< relative, the greatest of the systems solved
};

/// Finds the mesh whose triangles follow guidance fields as nearly as fixed vertices let them.
/// \pre a parameter mesh; for each of its triangles the wanted gradients of the coordinates; fixed vertices, at least
/// one in every connected part.
/// \param parameter the parameter mesh
/// \param guidance by triangle, the gradients to follow
/// \param fixed what keeps its place or height
/// \param measured in plan or in space
/// \param run progress, log, stop token and number of threads
/// \return the parameter mesh's triangles over vertices x with Div(grad x) = Div w at those that are not fixed; the
/// same for y and z by one factorisation. Measured in plan only z is sought and x and y stay: a land stays a land. With
/// the gradients of the parameter mesh itself and vertices fixed where they are, that mesh bit for bit; with all
/// gradients turned by one rotation and one vertex fixed, the mesh turned about that vertex. Vertices in no triangle
/// stay.
/// \throws BadInput naming triangle or vertex when sizes do not match, a triangle has no area, a number is not finite,
/// a vertex is fixed at two places or a part has no fixed vertex
/// \throws NotConverged
/// \throws Cancelled
///
/// Source: \cite nenu2015, eqs 14 to 16; \cite yu2004, Mesh editing with Poisson-based gradient field manipulation.
PastedTin paste_tin(Tin const& parameter, std::vector<CoordinateGradients> const& guidance,
                    std::vector<FixedVertex> const& fixed, geometry::Measured measured = geometry::Measured::in_plan,
                    Run const& run = {});

} // namespace thalweg::blend
