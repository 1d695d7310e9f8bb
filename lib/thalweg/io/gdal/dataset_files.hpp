// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace thalweg::io {

/// A GeoPackage that is open elsewhere has its NAME-wal too, where changes stand. A database has none.
/// \param path path of the file
/// \return every file a vector or raster source consists of, as GDAL knows them (.shp with its .dbf, .prj, ...),
/// sorted.
/// \throws BadInput when it is none
std::vector<std::string> dataset_files(std::string const& path);

} // namespace thalweg::io
