// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace thalweg::io {

/// What of a file changes when it is read into a grid's CRS in metres, each as a sentence: coordinates of another CRS
/// are reprojected, heights in another unit are converted, heights of a CRS in feet that have no unit of their own are
/// taken for metres. Text, and a file that GDAL does not read, change in nothing. Takes: layer: "" for the one with
/// rivers, or the first.
std::vector<std::string> conversions_of(std::string const& path, std::string const& layer, std::string const& crs);

} // namespace thalweg::io
