// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace thalweg::io {

/// What a file holds, to choose who reads it.
struct FileContent {
    enum class Kind : std::uint8_t { raster, points, lines };
    Kind kind = Kind::raster;
    std::string path;  ///< of the file itself where a folder was named
    std::string layer; ///< of lines: "arcs" in a file of thalweg's own, else ""
};

/// Looks into a file: a raster, text or a layer of points, or lines; where there are both, lines. A folder stands for
/// its network.gpkg.
/// \param path path of the file
/// \return what it holds
/// \throws BadInput when there is none, GDAL cannot read it or it holds neither
/// \throws IoError when features cannot be read
FileContent content_of(std::string const& path);

} // namespace thalweg::io
