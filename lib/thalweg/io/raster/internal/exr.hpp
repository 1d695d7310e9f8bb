// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/internal/about.hpp>

namespace thalweg::io {

/// Encodes heights as an OpenEXR of scan lines with one channel, Y, of 32-bit floating point, compressed by ZIP.
/// \param heights [m] at least one cell
/// \return the bytes of the file, the same for any number of threads
/// \throws BadParameter in a build without OpenEXR
std::string exr(Raster<float> const& heights, Run const& run);

/// Reads the heights of an OpenEXR file.
/// \param about whose errors they are
/// \return [m] of channel Y, or of the only channel; rows from the north, cells of 1
/// \throws BadInput for several channels without Y, and for a file that cannot be read
/// \throws BadParameter in a build without OpenEXR
Raster<float> heights_of_exr(std::string const& path, About const& about);

} // namespace thalweg::io
