// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>

/// Land in equilibrium with its rivers. Private to this module.
namespace thalweg::pipeline {

/// Draws the land around the planned rivers, takes tips off these that would stand perched, and gives them and their
/// cells the land's heights. Takes: a network in plan; its heights too, where they are asked for; those that are taken
/// because the lines have them give way where they would need walls.
Terrain draw_in_equilibrium(Plan const& plan, Terrain terrain, Diary& diary, Run const& run);

/// Makes arcs of the side valleys the land has grown, where the plan wants them.
Terrain with_side_valleys(Plan const& plan, Terrain terrain, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
