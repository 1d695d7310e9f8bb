// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace thalweg::io {

/// Text, and a file that GDAL does not read, change in nothing.
/// \param path path of the file
/// \param layer "" for the one with rivers, or the first
/// \param crs "EPSG:n" or WKT; "": none
/// \param source_crs of a layer that has no CRS; "": none
/// \return what of a file changes when it is read into a grid's CRS in metres, each as a sentence: coordinates of
/// another CRS are reprojected, heights in another unit are converted, heights of a CRS in feet that have no unit of
/// their own count as metres.
std::vector<std::string> conversions_of(std::string const& path, std::string const& layer, std::string const& crs,
                                        std::string const& source_crs = {});

} // namespace thalweg::io
