// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg::io {

enum class Light { north_west, multidirectional };

/// \param dem [m] heights by cell; NaN: no data
/// \param z_factor > 0, vertical exaggeration
/// \param light where the light comes from
/// \return GDAL's hillshade, 1..255; 0 where there is no data. z_factor: [> 0] exaggeration.
/// \throws BadParameter
/// \throws BadInput an empty raster, an infinite height
Raster<std::uint8_t> hillshade(Raster<float> const& dem, double z_factor = 1.0, Light light = Light::north_west);

} // namespace thalweg::io
