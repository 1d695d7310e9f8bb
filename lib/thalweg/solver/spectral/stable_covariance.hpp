// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace thalweg::solver {

/// The stable covariance exp(-((dx/lx)^2 + (dy/ly)^2)^(3 - dimension)): 1/e at the distances lx along rows and ly along
/// columns. A share of the variance may belong to fine forms, with fine_cells for both lengths. Source: \cite zhang,
/// section 2; the exponent of Gneiting and Schlather 2004.
struct StableCovariance {
    double lx_cells = 20.0;   ///< [cells] > 0
    double ly_cells = 20.0;   ///< [cells] > 0
    double dimension = 2.4;   ///< fractal dimension in (2, 3)
    double fine_share = 0.0;  ///< [0, 1)
    double fine_cells = 12.0; ///< [cells] > 0

    double operator()(double dx_cells, double dy_cells) const;
};

/// Checks a covariance.
/// \param covariance any values
/// \param stage name of the stage, for messages
/// \throws BadParameter when a length or the dimension is outside its range
void check(StableCovariance const& covariance, char const* stage);

} // namespace thalweg::solver
