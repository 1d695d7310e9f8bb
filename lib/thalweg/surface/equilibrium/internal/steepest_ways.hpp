// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/surface/equilibrium/internal/jitter.hpp>
#include <thalweg/surface/equilibrium/internal/land_level.hpp>

/// Private to this module.
namespace thalweg::surface {

/// Turns land cells to their steepest neighbour, by the distances of jittered nodes, banks to their steepest river
/// cell. A cell without a lower neighbour keeps its way: since no cell lies below its receiver, ways never close to a
/// circle.
void steepest_ways(LandLevel& level, JitteredPerLength const& per_length, Run const& run);

} // namespace thalweg::surface
