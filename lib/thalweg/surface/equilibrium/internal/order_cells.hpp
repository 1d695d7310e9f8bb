// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Orders the land cells so that each stands before its receiver, and counts the cells that drain through every cell.
/// Leaves are peeled off: from each cell without donors water is followed as far as all donors have arrived.
void order_cells(LandLevel& level);

} // namespace thalweg::surface
