// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Lowers the cap on slopes beside rivers, so that floors form that widen downstream: a flat core and concave foot
/// slopes, half as steep as other land at about floor_width times area ^ 0.4 from the river, both in cells. The order
/// of cells is lost: its memory is wanted.
void valley_floors(LandLevel& level, double floor_width, std::uint64_t seed);

} // namespace thalweg::surface
