// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Finds every cell a receiver, raising it where it must: banks to the river cell beside them down the steepest slope,
/// other land by a flood from where water leaves. Gives: each land cell above its receiver by least_tangent at least,
/// banks above all river cells beside them. Cells that no water can leave become outside. Source: Barnes 2014, with
/// buckets instead of a heap: heights in one bucket are taken in any order, which costs the order of cells, not the
/// law.
void flood_land(LandLevel& level);

} // namespace thalweg::surface
