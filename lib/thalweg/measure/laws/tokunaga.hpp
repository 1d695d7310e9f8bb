// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg::measure {

/// Tokunaga's law T_k = a c^(k-1), the mean number of side branches k orders below their stream.
struct TokunagaLaw {
    double a = 0.0;
    double c = 0.0;
    double r2 = 0.0;          ///< of the regression of ln T_k; NaN: two terms, or all equal
    double log_c_error = 0.0; ///< standard error of ln c; NaN: two terms
    std::int64_t terms = 0;   ///< number of T_k in the regression
};

/// Fits Tokunaga's law by least squares of ln T_k over k - 1.
/// \param side_branches T_1, T_2, ..., means over the streams of all orders; a T_k of 0 is left out
/// \return nothing with fewer than two terms
///
/// Source: \cite tokunaga1978; \cite peckham1995; the regression: \cite zanardo2013.
std::optional<TokunagaLaw> tokunaga(std::vector<double> const& side_branches);

} // namespace thalweg::measure
