// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/io/files/internal/about.hpp>
#include <thalweg/io/gdal/internal/dataset.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::io {

// Heightmaps, as write_heightmap() writes them and terrain programs exchange them. GDAL reads none of these formats but
// PNG, and of a PNG only the numbers.

/// Tells whether a file is one: thalweg's own with its description beside it, OpenEXR by its first bytes, or numbers
/// without a header by the extension .r16, .r32 or .raw where GDAL has no driver for the file.
/// Needs a Driver that outlives it.
bool is_heightmap(Source const& source);

/// Tells whether GDAL reads the numbers of a heightmap: a PNG.
bool is_picture_of_heights(Source const& source);

/// The files of a heightmap: itself, and the description beside it.
std::vector<std::string> heightmap_files(Source const& source);

/// A heightmap as GDAL shows other rasters.
struct OpenedHeightmap {
    Dataset data; ///< heights [m], rows from the north
    Finding finding;
};

/// Opens a heightmap. Numbers become heights, and cells have their place, by FILE.json or the export.json of its
/// folder; else as the options say, where a file without a header is a square of 16-bit numbers (.r32: of heights).
/// \param picture the open file if is_picture_of_heights(), else null
/// \throws BadInput where the size of the file is not that of its samples, and for an OpenEXR without a channel of
/// heights
/// \throws BadParameter for OpenEXR in a build without it
OpenedHeightmap open_heightmap(Source const& source, ReadDemParams const& params, Dataset const& picture,
                               About const& about);

} // namespace thalweg::io
