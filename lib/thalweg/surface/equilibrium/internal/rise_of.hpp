// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

/// Private to this module.
namespace thalweg::surface {

struct Rise {
    double factor;
    double mean_tangent; ///< of the mean slope of the land that is raised by it
};

/// The factor by which a land in units of its cells must be raised to have the relief or the mean slope that is asked.
/// Takes: heights in cells, NaN for none. Gives: 1 for a level land. Throws: BadParameter naming the steepest mean
/// slope that can be reached, where too much of the land is level.
Rise rise_of(Raster<float> const& land, EquilibriumParams const& params);

/// What a land has of the relief or the mean slope that is asked, when heights in cells are multiplied: 1 is all of it.
double share_of_target(Raster<float> const& land, double factor, EquilibriumParams const& params);

} // namespace thalweg::surface
