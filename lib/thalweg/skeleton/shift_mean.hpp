// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg::skeleton {

/// Raises or lowers a land as a whole so that its mean is the one wanted.
/// Takes: a DEM, NaN where there is none; mean [m].
/// Gives: every height plus mean less the mean it had; extremes move along.
/// Throws: BadParameter when mean is not a number.
/// Source: paper 001, equation 5.
Raster<float> shift_mean(Raster<float> dem, double mean);

} // namespace thalweg::skeleton
