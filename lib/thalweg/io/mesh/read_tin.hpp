// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::io {

/// A mesh of a file: its triangles may also overhang.
struct TinFile {
    Tin tin;
    std::string crs;        ///< of the comment that write_tin leaves; "" for none
    std::int64_t split = 0; ///< faces that were cut into triangles
};

/// \param path path of the file
/// \return whether a file's name ends in that of a mesh that read_tin reads: .2dm, .obj or .off.
bool holds_tin(std::string const& path);

/// Reads a mesh: 2DM (E3T, E4Q, ND), Wavefront OBJ (v, f) or OFF; other words of 2DM and OBJ are skipped. Faces with
/// more than three corners are cut into triangles, quadrilaterals along the shorter diagonal; the log says how many.
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \return vertices and triangles in the file's order; of what write_tin writes in these formats the same TIN.
/// \throws BadInput naming file and line: a number that is none, a face without three corners or that names a vertex
/// that is not there, heights that are not in metres, more than 2^30 bytes, no triangle
/// \throws IoError
/// \throws Cancelled
///
/// Source: Aquaveo, 2DM files; Wavefront OBJ; Geomview OFF.
TinFile read_tin(std::string const& path, Run const& run = {});

} // namespace thalweg::io
