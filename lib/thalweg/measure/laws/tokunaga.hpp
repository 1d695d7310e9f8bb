// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg::measure {

/// T_k = a c^(k-1): side branches, of k orders less, of a stream.
struct TokunagaLaw {
    double a = 0.0;
    double c = 0.0;
    double r2 = 0.0;          ///< of the line through the logarithms of T_k; NaN of two, or where all are one
    double log_c_error = 0.0; ///< standard error of ln c; NaN of two T_k
    std::int64_t terms = 0;   ///< T_k that were fitted
};

/// Tokunaga's law of drawn rivers.
/// \param side_branches T_1, T_2, ..., means over the streams of all orders
/// \return the line of least squares through ln T_k over k - 1; a T_k of 0 has no logarithm and is left out, with fewer
/// than two others there is no law.
///
/// Source: \cite tokunaga1978; \cite peckham1995; the regression: \cite zanardo2013.
std::optional<TokunagaLaw> tokunaga(std::vector<double> const& side_branches);

} // namespace thalweg::measure
