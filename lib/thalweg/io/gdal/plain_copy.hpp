// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Copies what a source holds into a file that a recipe may name: layers into a GeoPackage, a raster into a GeoTIFF.
/// \pre any source that GDAL reads, a database or an address among them
/// \param source the file or DEM to take from
/// \param layer the only one to copy, "" for all
/// \param folder where the copy comes to lie
/// \param run progress, log, stop token and number of threads
/// \return its path.
/// \throws BadInput when GDAL cannot read the source
/// \throws IoError
std::string plain_copy(std::string const& source, std::string const& layer, std::string const& folder,
                       Run const& run = {});

} // namespace thalweg::io
