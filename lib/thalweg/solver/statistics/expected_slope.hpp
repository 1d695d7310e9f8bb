// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/solver/spectral/stable_covariance.hpp>

namespace thalweg::solver {

/// Computes the mean slope of Gaussian terrain with a covariance.
/// \param covariance correlation by distance
/// \param std [m] standard deviation of the heights
/// \return [rad] expectation of arctan |grad z| with z in metres, central differences and a spacing of one cell, to
/// about 0.001
double expected_slope(StableCovariance const& covariance, double std);

/// Adds fine forms to a covariance until its terrain has a given mean slope. Reference DEMs need it: they are far
/// steeper than a power law from lags 1 to 5 to the correlation length.
/// \param covariance without fine forms
/// \param std [m] standard deviation of the heights
/// \param slope_rad [rad] (0, pi/2) mean slope
/// \return with the same correlation lengths, and longer coarse forms; unchanged if already steep enough; at most half
/// of the variance is fine
StableCovariance with_slope(StableCovariance covariance, double std, double slope_rad);

} // namespace thalweg::solver
