// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/land_level.hpp>

/// Private to this room.
namespace thalweg::surface {

/// Lowers the cap on slopes beside rivers, so that floors form that widen downstream: half as wide as floor_width times
/// area ^ 0.4, both in cells, and a foot of the same width that rises ever more steeply. The order of cells is lost: its
/// memory is wanted.
void valley_floors(LandLevel& level, double floor_width);

} // namespace thalweg::surface
