// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Lowers land that stands far steeper above any of its neighbours than its cap allows: cliffs that a river leaves
/// where it is given up, which would else come down by one row of cells a round. Banks and rivers stay.
/// Gives: the greatest heights that fulfil this; every cell that had a lower neighbour has one.
void slide_land(LandLevel& level);

} // namespace thalweg::surface
