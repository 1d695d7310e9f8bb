// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Keeps the law in the very floats that will be written: raises heights by the least that makes every cell stand a
/// step above its receiver and banks above the rivers beside them; lakes stand as high as their receivers.
/// Heights of rivers that are given are raised by the least a float knows, where they must.
void settle_land(LandLevel& level, float step, RiverHeights heights);

} // namespace thalweg::surface
