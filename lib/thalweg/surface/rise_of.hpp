// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run.hpp>
#include <thalweg/surface/equilibrium.hpp>

/// Private to this room.
namespace thalweg::surface {

struct Rise {
    double factor;
    double mean_tangent; ///< of the mean slope of the land that is raised by it
};

/// The factor by which a land in units of its cells must be raised to have the relief or the mean slope that is asked.
/// Takes: heights in cells, NaN for none. Gives: 1 where no factor does, as for a level land.
Rise rise_of(Raster<float> const& land, EquilibriumParams const& params);

} // namespace thalweg::surface
