// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/tin.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/internal/about.hpp>

namespace thalweg::io {

/// The triangles of a GLB.
struct GlbTriangles {
    Tin tin;                   ///< all triangles of the scene, Y up: x, y upwards, z
    Vec3 origin = {};          ///< [m] east, north, height of its frame, by thalweg's export; else 0
    double exaggeration = 1.0; ///< of heights, by thalweg's export
    std::string crs;           ///< by thalweg's export; "": none
};

/// Reads the triangles of a GLB (glTF 2.0 in one file), with the places of its nodes. Lines and points are skipped.
/// \param bytes of the file
/// \param about whose errors they are
/// \throws BadInput for a damaged file, compressed or sparse geometry, or other files that it needs
///
/// Source: Khronos, glTF 2.0.
GlbTriangles read_glb(std::string const& bytes, About const& about);

} // namespace thalweg::io
