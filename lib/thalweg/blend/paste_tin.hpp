// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/blend/gradients.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::blend {

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
/// \param run progress, log, stop token and number of threads
/// \return the parameter mesh's triangles over new vertices; vertices in no triangle stay. With the mesh's own
/// gradients and unmoved vertices the mesh bit for bit; with all gradients rotated and one vertex fixed, the mesh
/// rotated about it.
/// \throws BadInput naming triangle or vertex when sizes do not match, a triangle has no area, a number is not finite,
/// a vertex is fixed at two positions or a part has no fixed vertex
/// \throws NotConverged when the solver does not reach its tolerance
/// \throws Cancelled
///
/// Source: \cite nenu2015, eqs 14 to 16; \cite yu2004, Mesh editing with Poisson-based gradient field manipulation.
PastedTin paste_tin(Tin const& parameter, std::vector<CoordinateGradients> const& guidance,
                    std::vector<FixedVertex> const& fixed, geometry::Measured measured = geometry::Measured::in_plan,
                    Run const& run = {});

} // namespace thalweg::blend
