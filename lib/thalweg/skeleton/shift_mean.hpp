// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg::skeleton {

/// Shifts a DEM vertically to a given mean.
/// \param dem [m] by cell; NaN: no data
/// \param mean [m] of the result
/// \return each height plus the same difference
/// \throws BadParameter when mean is not a number
///
/// Source: \cite zhang, equation 5.
Raster<float> shift_mean(Raster<float> dem, double mean);

} // namespace thalweg::skeleton
