// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Where rivers lie side by side, sets their heights so that the steepest descent of each cell leads to its receiver,
/// and that of a cell at which a river leaves the caller's grid to none in it: the cell is lowered or its neighbour is
/// raised. A few passes; what cannot be kept (a receiver's receiver beside the cell) stays.
/// Takes: the least tangent towards a receiver.
void keep_to_receivers(LandLevel& level, float least = least_tangent);

} // namespace thalweg::surface
