// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>

namespace thalweg::measure {

/// Finds the distance to the nearest higher land.
/// \param dem [m] by cell; NaN: no data
/// \param cell index of a peak's cell
/// \return [m] from centre to centre; NaN: no cell is higher
/// \throws BadInput when the DEM has no such cell
///
/// Source: \cite argudo2019.
double isolation(Raster<float> const& dem, std::int64_t cell);

} // namespace thalweg::measure
