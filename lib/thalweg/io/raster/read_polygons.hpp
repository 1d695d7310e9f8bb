// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/polygons.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// \param path path of the file
/// \return whether a file is one that OGR reads and has a layer of polygons.
/// \throws BadInput when there is none or GDAL cannot read it
bool holds_polygons(std::string const& path);

/// \param path path of the file
/// \return the CRS in metres in which a file's polygons are read where none is set: the file's own when it is projected
/// in metres, else the UTM zone of the middle of its box.
/// \throws BadInput as read_polygons, and for a file without CRS
std::string crs_for_polygons(std::string const& path);

/// What a file's polygons are in.
struct PolygonsCrs {
    std::string crs;        ///< "EPSG:n" or WKT; "": none
    bool in_metres = false; ///< projected, in metres
};

/// \param path path of the file
/// \return the CRS of the file's layer of polygons
/// \throws BadInput as read_polygons
PolygonsCrs crs_of_polygons(std::string const& path);

/// Reads the polygons of any OGR source, multi-part ones part by part, curves as OGR linearises them.
/// \pre the CRS of the result as in Grid, "" for none.
/// \param path path of the file
/// \param crs "EPSG:n" or WKT; "": none
/// \param run progress, log, stop token and number of threads
/// \return vertices reprojected and rounded to 1e-6 of a unit.
/// \throws BadInput naming file, layer and feature: missing file, no or several layers of polygons, no features,
/// something that is not a polygon, coordinates that are not finite or cannot be reprojected, a CRS on one side only
/// (naming both)
/// \throws IoError when the file cannot be read to its end
/// \throws Cancelled
Polygons read_polygons(std::string const& path, std::string const& crs, Run const& run = {});

/// \param path path of the file
/// \param crs "EPSG:n" or WKT; "": none
/// \param field name of a numeric field
/// \param run progress, log, stop token and number of threads
/// \return the same, each with the value of a numeric field.
/// \throws Error also BadInput when the layer has no such field, or a feature no finite value in it
Polygons read_polygons(std::string const& path, std::string const& crs, std::string const& field, Run const& run = {});

} // namespace thalweg::io
