// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/height_unit.hpp>
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
/// \return vertices and triangles in the file's order; of what write_tin writes in these formats the same TIN.
/// \throws BadInput naming file and line: a number that is none, a face without three corners or that names a vertex
/// that is not there, heights that are not in metres, more than 2^30 bytes, no triangle
///
/// Source: Aquaveo, 2DM files; Wavefront OBJ; Geomview OFF.
TinFile read_tin(std::string const& path, Run const& run = {});

/// How a TIN, or its vertices alone, is written.
enum class TinFormat : std::uint8_t {
    mesh_2dm,   ///< SMS 2DM, as QGIS (MDAL) reads it
    ply,        ///< PLY, binary, coordinates as doubles
    geopackage, ///< layer faces (PolygonZ): face_id, v1, v2, v3, area [m²], slope [m/m]
    obj,        ///< Wavefront OBJ
    off,        ///< OFF
    landxml,    ///< LandXML 1.2, Surface of type TIN; points are northing, easting, elevation
    las,        ///< the vertices as LAS 1.2, point format 0, class 2 (ground)
    ply_points, ///< the vertices as PLY
    xyz,        ///< the vertices as text, one a line
};

/// A tin format name.
struct TinFormatName {
    TinFormat format;
    char const* name;   ///< "2dm", "ply-points"
    char const* ending; ///< ".2dm"; "" if another format has that ending
};
std::vector<TinFormatName> const& tin_formats();

/// \param name its name
/// \param path path of the file
/// \return the format of a name, or where it is "" of a path's ending, in any case of letters.
/// \throws BadParameter that lists the names there are
TinFormat tin_format(std::string const& name, std::string const& path);

/// Writes a TIN as a new file.
/// \post coordinates that read back bit for bit, in LAS within half a millimetre (of extents beyond 4000 km: half the
/// least power of ten that fits); vertex i of the TIN is number i of the file, from 1 in 2dm, obj, landxml and the
/// fields of geopackage, from 0 in ply and off. The same bytes for the same TIN, on any day.
/// \pre a TIN; crs as in Grid, kept by ply, obj, off (comment), geopackage, landxml and las (EPSG code), "" for none;
/// the unit of its heights, which 2dm (name of the mesh), ply, obj and off (comment) keep: other formats hold metres.
/// \param tin the TIN
/// \param crs "EPSG:n" or WKT; "": none
/// \param path path of the file
/// \param format the format
/// \param unit the unit
/// \throws BadParameter when the format does not keep the unit
/// \throws BadInput naming the vertex or triangle when a coordinate is not finite, a vertex is not there or the format
/// cannot number so many
/// \throws IoError also when the file exists
///
/// Source: Aquaveo, 2DM files; \cite turk1994, The PLY polygon file format; ASPRS LAS 1.2; LandXML-1.2.xsd.
void write_tin(Tin const& tin, std::string const& crs, std::string const& path, TinFormat format,
               HeightUnit unit = HeightUnit::metre, Run const& run = {});

} // namespace thalweg::io
