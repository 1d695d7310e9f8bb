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

/// Writes a part of a terrain as a new heightmap, in the scale of the whole.
/// \param heights [m] all are numbers
/// \param path of the file
/// \param format of the file
/// \param scale of the whole terrain
/// \throws as write_heightmap
void write_heightmap(Raster<float> const& heights, std::string const& path, HeightmapFormat format,
                     HeightmapScale const& scale, Run const& run = {});

/// Finds the scale of heights in 16 bits.
/// \param heights [m] at least one, all are numbers
/// \return the scale
/// \throws BadInput naming a sample without height
HeightmapScale heightmap_scale(Raster<float> const& heights);

/// Tells whether a file is a heightmap that read_dem_file() reads and GDAL does not, or with other heights than GDAL:
/// one with its description beside it, OpenEXR, or numbers without a header.
/// \param path of the file
/// \return true: it is one
bool is_heightmap_file(std::string const& path);

/// Writes shares as a new grey PNG: 0 is black, 1 white.
/// \param shares [0, 1]
/// \param path of the file
/// \param bits 8 or 16, of a sample
/// \throws BadParameter for another number of bits
/// \throws IoError also when the file exists
void write_grey_png(Raster<float> const& shares, std::string const& path, int bits, Run const& run = {});

/// Writes colours as a new PNG.
/// \param colours 0xRRGGBB by pixel
/// \param path of the file
/// \throws IoError also when the file exists
void write_colour_png(Raster<std::uint32_t> const& colours, std::string const& path, Run const& run = {});

} // namespace thalweg::io
