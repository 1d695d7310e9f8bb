// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>

namespace thalweg::skeleton {

/// How the pull falls off from 1 at the centre: continuous to 0 at the radius, literal to 1/e, as printed, with a step
/// there.
enum class Falloff { continuous, literal };

/// A height that the terrain around a cell is pulled to.
struct Attraction {
    Cell centre;
    double z = 0.0;            ///< [m] the highest or lowest height wanted
    double radius_cells = 1.0; ///< [cells] > 0
    Falloff falloff = Falloff::continuous;
};

/// Pulls the land around a cell towards a highest or lowest height.
/// \param dem [m] heights by cell; NaN: no data
/// \param attraction place, height and radius
/// \return within the radius R of the centre h + w (z - h), w = exp(-d^2/R^2) (literal) or (exp(-d^2/R^2) - 1/e)/(1 -
/// 1/e); the centre becomes z. It does not see to it that no other cell lies beyond z. Holes stay holes.
/// \throws BadParameter when the centre is off the grid or the radius not positive
///
/// Source: \cite zhang, equation 4.
Raster<float> attract(Raster<float> dem, Attraction const& attraction);

} // namespace thalweg::skeleton
