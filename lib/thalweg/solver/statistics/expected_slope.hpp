// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/solver/spectral/stable_covariance.hpp>

namespace thalweg::solver {

/// Mean slope of the normal lands with a covariance.
/// \pre std [m] of the heights.
/// \param covariance the covariance
/// \param std [m] standard deviation of the heights
/// \return [rad] the expectation of arctan |grad z| with z in metres, central differences and a spacing of one cell, to
/// about 0.001.
double expected_slope(StableCovariance const& covariance, double std);

/// The covariance with so much of fine forms that its lands are as steep as asked for.
/// \pre a covariance without fine forms; std [m]; slope_rad in (0, pi/2).
/// \param covariance the covariance
/// \param std [m] standard deviation of the heights
/// \param slope_rad [rad] (0, pi/2) mean slope
/// \return one with the same correlation lengths, whose coarse forms are longer for that; as it was when its lands are
/// steep enough already; at most half of the variance is fine. Reference DEMs need it: their ridges and valleys are far
/// steeper than a power law between the lags 1 to 5 and the correlation length tells.
StableCovariance with_slope(StableCovariance covariance, double std, double slope_rad);

} // namespace thalweg::solver
