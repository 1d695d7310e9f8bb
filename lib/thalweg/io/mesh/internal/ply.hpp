// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/vec.hpp>

/// The parts of a binary PLY file that points and triangles share. Private to this module.
/// Source: Turk 1994, The PLY polygon file format.
namespace thalweg::io {

/// Appends the header. Takes: the CRS, a comment, "" for none; faces: how many, of vertices alone nothing; the unit of
/// heights, a comment, of metres none.
void put_ply_header(std::string& bytes, std::string const& crs, std::uint64_t vertices,
                    std::optional<std::uint64_t> faces = {}, HeightUnit unit = HeightUnit::metre);

/// Appends a vertex: three doubles.
void put_ply_vertex(std::string& bytes, Vec3 vertex);

} // namespace thalweg::io
