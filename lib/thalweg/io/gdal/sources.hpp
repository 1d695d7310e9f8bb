// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// The content of a file, to choose its reader.
struct FileContent {
    enum class Kind : std::uint8_t { raster, points, lines };
    Kind kind = Kind::raster;
    std::string path;  ///< of the file itself if a folder was named
    std::string layer; ///< of lines: "arcs" in thalweg's own files, else ""
};

/// Detects the content of a file: a raster, text or a layer of points, or lines; lines if there are both. A folder
/// stands for its network.gpkg.
/// \param path of the file or folder
/// \return kind and layer
/// \throws BadInput when it does not exist, GDAL cannot read it or it has neither
/// \throws IoError when features cannot be read
FileContent content_of(std::string const& path);

/// Tells whether a file that OGR reads has a layer with a name.
/// \param path of the file
/// \param layer name of the layer
/// \return false also if the file does not exist
/// \throws BadInput when GDAL cannot read it
bool has_layer(std::string const& path, std::string const& layer);

/// Lists the files of a vector or raster source, as known to GDAL (.shp with its .dbf, .prj, ...). A GeoPackage that is
/// open elsewhere includes its NAME-wal with changes. A database has no files.
/// \param path of the source
/// \return sorted
/// \throws BadInput when it is not a source
std::vector<std::string> dataset_files(std::string const& path);

/// Describes the changes to a file's data when it is read into a grid's CRS in metres: reprojected coordinates,
/// converted heights, heights of a CRS in feet without their own unit, which count as metres. Text and files that GDAL
/// does not read are not changed.
/// \param path of the file
/// \param layer "": the one with rivers, or the first
/// \param crs "EPSG:n" or WKT; "": none
/// \param source_crs of a layer without a CRS; "": none
/// \return one sentence per change
std::vector<std::string> conversions_of(std::string const& path, std::string const& layer, std::string const& crs,
                                        std::string const& source_crs = {});

/// Copies a source into a file that a recipe may name: layers into a GeoPackage, a raster into a GeoTIFF.
/// \param source any source that GDAL reads, databases and addresses included
/// \param layer the only one to copy; "": all
/// \param folder of the copy
/// \return its path
/// \throws BadInput when GDAL cannot read the source
std::string plain_copy(std::string const& source, std::string const& layer, std::string const& folder,
                       Run const& run = {});

} // namespace thalweg::io
