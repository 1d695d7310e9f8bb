// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/gdal/access.hpp>

namespace thalweg::io {

/// The content of a file, to choose its reader.
struct FileContent {
    enum class Kind : std::uint8_t { raster, points, lines };
    Kind kind = Kind::raster;
    std::string path;  ///< of the file itself if a folder was named
    std::string layer; ///< of lines: "arcs" in thalweg's own files, else ""
};

/// Looks into a file: a raster, text, a cloud or a layer of points, or lines; where there are both, lines. A folder
/// stands for its network.gpkg.
/// \param source the file
/// \return what it holds
/// \throws BadInput when there is none, GDAL cannot read it or it holds neither; for E57, with what to do
/// \throws IoError when features cannot be read
FileContent content_of(Source const& source);

/// \param source the file
/// \param layer name of the layer
/// \return false also if the file does not exist
/// \throws BadInput when GDAL cannot read it
bool has_layer(Source const& source, std::string const& layer);

/// \internal
/// A GeoPackage that is open elsewhere has its NAME-wal too, where changes stand. A database has none.
/// \param source the file
/// \return every file a vector or raster source consists of, as GDAL knows them (.shp with its .dbf, .prj, ...),
/// sorted.
/// \throws BadInput when it is none
std::vector<std::string> dataset_files(Source const& source);

/// \internal
/// Text, and a file that GDAL does not read, change in nothing.
/// \param source the file
/// \param layer "" for the one with rivers, or the first
/// \param crs "EPSG:n" or WKT; "": none
/// \param source_crs of a layer that has no CRS; "": none
/// \return what of a file changes when it is read into a grid's CRS in metres, each as a sentence: coordinates of
/// another CRS are reprojected; heights of lines and points in another unit are converted, those of a CRS in feet that
/// have no unit of their own count as metres.
std::vector<std::string> conversions_of(Source const& source, std::string const& layer, std::string const& crs,
                                        std::string const& source_crs = {});

/// \internal
/// Copies a source into a file that a recipe may name: layers into a GeoPackage, a raster into a GeoTIFF.
/// \param source any source that GDAL reads, databases and addresses included
/// \param layer the only one to copy; "": all
/// \param folder of the copy
/// \return its path
/// \throws BadInput when GDAL cannot read the source
std::string plain_copy(std::string const& source, std::string const& layer, std::string const& folder,
                       Run const& run = {});

} // namespace thalweg::io
