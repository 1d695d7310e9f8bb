// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Encodes heights as an OpenEXR of scan lines with one channel, Y, of 32-bit floating point, compressed by ZIP.
/// \param heights [m] at least one cell
/// \return the bytes of the file, the same for any number of threads
/// \throws BadParameter in a build without OpenEXR
std::string exr(Raster<float> const& heights, Run const& run);

} // namespace thalweg::io
