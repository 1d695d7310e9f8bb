// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \cpponly

#include <vector>

namespace thalweg {

/// Computes a quantile of a sample: linear between its values in order, as R and NumPy do by default.
/// \param values in any order; NaN: unknown, left out
/// \param share [0, 1] of the sample below: 0.5 for the median
/// \return NaN: no value is known
double quantile(std::vector<double> values, double share);

/// Computes Spearman's rank correlation; equal values have their mean rank.
/// \param x,y of the same places; places with a NaN are left out
/// \return [-1, 1]; NaN: fewer than three places, or all values of x or y are equal
double rank_correlation(std::vector<double> const& x, std::vector<double> const& y);

} // namespace thalweg
