// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>

namespace thalweg::io {

/// A mesh read from a file: its triangles may overhang.
struct TinFile {
    Tin tin;
    std::string crs;        ///< from the comment of write_tin; "" for none
    std::int64_t split = 0; ///< faces that were split into triangles
    std::vector<Finding> findings = {};
};

/// \internal
/// Tells whether a file name has the extension of a mesh that read_tin reads: .2dm, .obj, .off or .glb.
/// \param path of the file
/// \return true: a mesh
bool holds_tin(std::string const& path);

/// Reads a mesh: 2DM (E3T, E4Q, ND), Wavefront OBJ (v, f; numbers from the last vertex; lines continued by a backslash)
/// OFF (also with colours, normals, places in pictures, which are skipped) or GLB (triangles at the places of their
/// nodes; no compressed ones); other words of 2DM and OBJ are skipped.
/// An OBJ with a comment "Y up" and a GLB are turned (mesh_turned), and those of export moved to their origin, without
/// exaggeration. Vertices of OBJ, OFF
/// and GLB within 1e-8 of the extent become one (welded). Faces with more than three corners are split into triangles,
/// quadrilaterals along the shorter diagonal (split_faces).
/// \param path of the file
/// \return vertices and triangles in the file's order; restores a TIN written by write_tin in these formats
/// \throws BadInput naming file and line: an invalid number, a face without three corners or with a vertex that does
/// not exist, heights that are not in metres, more than 2^30 bytes, no triangle; an OBJ that is folded in plan, and not
/// with Y up, and says nothing of its axes
///
/// Source: Aquaveo, 2DM files; Wavefront OBJ; Geomview OFF; Khronos, glTF 2.0.
TinFile read_tin(std::string const& path, Run const& run = {});

/// Formats of a TIN, or of its vertices alone.
enum class TinFormat : std::uint8_t {
    mesh_2dm,   ///< SMS 2DM, as QGIS (MDAL) reads it
    ply,        ///< PLY, binary, coordinates as doubles
    geopackage, ///< layer faces (PolygonZ): face_id, v1, v2, v3, area [m²], slope [m/m]
    obj,        ///< Wavefront OBJ
    off,        ///< OFF
    landxml,    ///< LandXML 1.2, Surface of type TIN; points are northing, easting, elevation
    las,        ///< the vertices as LAS 1.2, point format 0, class 2 (ground)
    ply_points, ///< the vertices as PLY
    xyz,        ///< the vertices as text, one per line
};

/// The name of a TIN format.
struct TinFormatName {
    TinFormat format;
    char const* name;   ///< "2dm", "ply-points"
    char const* ending; ///< ".2dm"; "" if another format has that ending
};
std::vector<TinFormatName> const& tin_formats();

/// Finds a format.
/// \param name its name; "": by the path's extension, ignoring case
/// \param path of the file
/// \return the format
/// \throws BadParameter that lists the names
TinFormat tin_format(std::string const& name, std::string const& path);

/// Writes a TIN as a new file. Coordinates read back bit for bit, in LAS within half a millimetre (of extents beyond
/// 4000 km: half the least power of ten that fits). Vertex i of the TIN has number i in the file, from 1 in 2dm, obj,
/// landxml and the fields of geopackage, from 0 in ply and off. The same bytes for the same TIN, on any day.
/// \param tin any
/// \param crs as in Grid, "": none; kept by ply, obj, off (comment), geopackage, landxml and las (EPSG code)
/// \param path of the file
/// \param format of the file
/// \param unit of heights; kept by 2dm (name of the mesh), ply, obj and off (comment); other formats hold metres
/// \throws BadParameter when the format does not keep the unit
/// \throws BadInput naming the vertex or triangle when a coordinate is not finite, a vertex does not exist or there are
/// too many for the format
/// \throws IoError also when the file exists
///
/// Source: Aquaveo, 2DM files; \cite turk1994, The PLY polygon file format; ASPRS LAS 1.2; LandXML-1.2.xsd.
void write_tin(Tin const& tin, std::string const& crs, std::string const& path, TinFormat format,
               HeightUnit unit = HeightUnit::metre, Run const& run = {});

} // namespace thalweg::io
