// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace thalweg::io {

/// Where the rivers are that somebody's path names.
struct RiverSource {
    std::string path;
    std::string layer; ///< "arcs" of a network that thalweg wrote, else ""
};

/// Looks for rivers.
/// \param path a file that OGR reads, a zip archive of one, a folder of shapefiles, the folder that `make` or `convert`
/// wrote (its network.gpkg, else its only NAME_arcs file or its only GeoPackage), or a database ("PG:...")
/// \return where the rivers are
/// \throws BadInput that says what is there instead: nothing, an empty file or folder, a raster, no layer with lines, a
/// file that GDAL cannot read
/// \throws IoError
RiverSource find_rivers(std::string const& path);

} // namespace thalweg::io
