// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace thalweg::solver {

/// How heights at two places are correlated: exp(-((dx/lx)^2 + (dy/ly)^2)^(3 - dimension)), 1/e at a distance of lx
/// along rows and of ly along columns; a share of the variance may belong to fine forms, with fine_cells in the place
/// of both lengths. Source: \cite zhang, section 2; the exponent of Gneiting and Schlather 2004.
struct StableCovariance {
    double lx_cells = 20.0;   ///< [cells] > 0
    double ly_cells = 20.0;   ///< [cells] > 0
    double dimension = 2.4;   ///< fractal dimension in (2, 3)
    double fine_share = 0.0;  ///< [0, 1)
    double fine_cells = 12.0; ///< [cells] > 0

    double operator()(double dx_cells, double dy_cells) const;
};

/// \pre the name of the stage that asks, for the message.
/// \param covariance the covariance
/// \param stage name of the stage, for messages
/// \throws BadParameter when a length or the dimension is out of range
void check(StableCovariance const& covariance, char const* stage);

} // namespace thalweg::solver
