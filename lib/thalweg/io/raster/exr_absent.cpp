// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled instead of exr.cpp where OpenEXR is not installed.
#include <thalweg/core/run/error.hpp>
#include <thalweg/io/raster/internal/exr.hpp>

namespace thalweg::io {

std::string exr(Raster<float> const&, Run const&) {
    throw BadParameter("io.write_heightmap",
                       "the format exr needs OpenEXR, and this thalweg was built without it; install "
                       "libopenexr-dev and build again, or use r32, which has the same heights");
}

Raster<float> heights_of_exr(std::string const&, About const& about) {
    throw BadParameter(about.where,
                       about.name +
                           " is an OpenEXR, and this thalweg was built without it; install libopenexr-dev and build "
                           "again, or convert the file to TIFF (oiiotool FILE.exr -o FILE.tif)");
}

} // namespace thalweg::io
