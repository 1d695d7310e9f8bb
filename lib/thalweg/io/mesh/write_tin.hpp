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
/// \param run progress, log, stop token and number of threads
/// \throws BadParameter when the format does not keep the unit
/// \throws BadInput naming the vertex or triangle when a coordinate is not finite, a vertex is not there or the format
/// cannot number so many
/// \throws IoError also when the file exists
/// \throws Cancelled
///
/// Source: Aquaveo, 2DM files; \cite turk1994, The PLY polygon file format; ASPRS LAS 1.2; LandXML-1.2.xsd.
void write_tin(Tin const& tin, std::string const& crs, std::string const& path, TinFormat format,
               HeightUnit unit = HeightUnit::metre, Run const& run = {});

} // namespace thalweg::io
