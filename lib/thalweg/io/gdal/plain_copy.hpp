// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Copies what a source holds into a file that a recipe may name: layers into a GeoPackage, a raster into a GeoTIFF.
/// Takes: any source that GDAL reads, a database or an address among them; layer: the only one to copy, "" for all;
/// folder: where the copy comes to lie. Gives: its path. Throws: BadInput when GDAL cannot read the source; IoError.
std::string plain_copy(std::string const& source, std::string const& layer, std::string const& folder,
                       Run const& run = {});

} // namespace thalweg::io
