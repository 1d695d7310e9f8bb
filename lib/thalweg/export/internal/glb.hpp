// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/lattice.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg::exports {

/// What a GLB shows.
struct GlbScene {
    LatticeMesh const& mesh;               ///< with places
    std::string const& texture;            ///< PNG, of these places
    std::vector<std::vector<Vec3>> rivers; ///< [m] in the frame of the mesh, at least 2 vertices each; empty: none
    std::string generator;                 ///< "thalweg 0.2.0"
    std::string facts;                     ///< one JSON object: the scene's "extras"
};

/// Makes a binary glTF 2.0: nodes terrain (triangles with normals and texture) and rivers (lines), Y up: x is the
/// mesh's x, y its z, z its -y.
/// \return the file's bytes
/// \throws BadInput beyond 2^32 - 1 bytes
///
/// Source: Khronos, glTF 2.0 Specification (ISO/IEC 12113:2022).
std::string glb(GlbScene const& scene, Run const& run = {});

} // namespace thalweg::exports
