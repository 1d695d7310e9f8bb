// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg::skeleton {

/// Decrease of an attraction from 1 at its centre: continuous to 0 at the radius; literal, as published, to 1/e with a
/// step.
enum class Falloff { continuous, literal };

/// An extreme height to which surrounding terrain is attracted.
struct Attraction {
    Cell centre;
    double z = 0.0;            ///< [m] target height
    double radius_cells = 1.0; ///< [cells] > 0
    Falloff falloff = Falloff::continuous;
};

/// Attracts the terrain around a cell to an extreme height. Other cells may still lie beyond it.
/// \param dem [m] by cell; NaN: no data
/// \param attraction centre, height and radius R
/// \return within R: h + w (z - h), w = exp(-d^2/R^2) (literal) or (exp(-d^2/R^2) - 1/e)/(1 - 1/e); the centre becomes
/// z, NaN stays
/// \throws BadParameter when the centre is off the grid or the radius not above 0
///
/// Source: \cite zhang, equation 4.
Raster<float> attract(Raster<float> dem, Attraction const& attraction);

} // namespace thalweg::skeleton
