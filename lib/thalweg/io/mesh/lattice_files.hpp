// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/lattice.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Writes a mesh as a new binary STL. Z is up; coordinates are those of the mesh as 32-bit floats; each facet has its
/// normal.
/// \param mesh at least one triangle
/// \param path of the file
/// \param unit of the mesh's coordinates, at most 50 bytes: the header says it, and no program reads it
/// \throws BadInput when a coordinate is not finite or there are more than 2^32 - 1 triangles
/// \throws IoError also when the file exists
///
/// Source: 3D Systems, StereoLithography Interface Specification (1989).
void write_stl(LatticeMesh const& mesh, std::string const& path, Run const& run = {},
               std::string const& unit = "metres");

/// The names that an OBJ says.
struct ObjNames {
    std::string crs;     ///< as in Grid, "": none; a comment
    std::string library; ///< file name of its materials (MTL)
    std::string material;
    double exaggeration = 1.0; ///< of the mesh's heights; a comment unless 1
};

/// Writes a mesh with texture coordinates as a new Wavefront OBJ. Y is up: x is the mesh's x, y its z, z its -y, as
/// most programs expect; lengths are metres. Comments say the origin in the CRS.
/// \param mesh with places
/// \param path of the file
/// \param names of its material
/// \throws BadInput when a coordinate is not finite or the mesh has no places
/// \throws IoError also when the file exists
///
/// Source: Alias Wavefront, Object Files (.obj).
void write_textured_obj(LatticeMesh const& mesh, std::string const& path, ObjNames const& names, Run const& run = {});

} // namespace thalweg::io
