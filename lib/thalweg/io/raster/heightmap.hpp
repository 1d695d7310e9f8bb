// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Formats of heights without coordinates. Samples go row by row from the north-west.
enum class HeightmapFormat : std::uint8_t {
    png16, ///< PNG, one channel of 16 bits
    r16,   ///< 16-bit unsigned integers, little-endian, without a header
    r32,   ///< 32-bit floating point [m], little-endian, without a header
    exr    ///< OpenEXR, one channel (Y) of 32-bit floating point [m]
};

/// Heights of a heightmap's samples.
struct HeightmapScale {
    double min_m = 0.0;  ///< of the lowest sample, 0 in 16 bits
    double max_m = 0.0;  ///< of the highest sample, 65535 in 16 bits
    double step_m = 0.0; ///< between two numbers of 16 bits: a sample is min_m + number x step_m within half of it
};

/// Writes heights as a new heightmap.
/// \param heights [m] all are numbers
/// \param path of the file
/// \param format of the file
/// \return the scale; with 32 bits step_m is 0 and heights are exact. PNG and OpenEXR have the same samples everywhere,
/// and the same bytes on one machine
/// \throws BadParameter for exr in a build without OpenEXR
/// \throws BadInput naming a sample without height
/// \throws IoError also when the file exists
HeightmapScale write_heightmap(Raster<float> const& heights, std::string const& path, HeightmapFormat format,
                               Run const& run = {});

} // namespace thalweg::io
