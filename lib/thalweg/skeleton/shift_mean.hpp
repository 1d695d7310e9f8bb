// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg::skeleton {

/// Raises or lowers a land as a whole so that its mean is the one wanted.
/// \pre a DEM, NaN where there is none; mean [m].
/// \param dem [m] heights by cell; NaN: no data
/// \param mean [m] mean height
/// \return every height plus mean less the mean it had; extremes move along.
/// \throws BadParameter when mean is not a number
///
/// Source: \cite zhang, equation 5.
Raster<float> shift_mean(Raster<float> dem, double mean);

} // namespace thalweg::skeleton
