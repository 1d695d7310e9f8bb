// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/flow/flow_field.hpp>
#include <thalweg/flow/routing/route.hpp>
#include <thalweg/pipeline/make/drawn_terrain.hpp>
#include <thalweg/pipeline/plan/internal/diary.hpp>

/// Land in equilibrium with its rivers. Private to this room.
namespace thalweg::pipeline {

/// The usual mean slope [degrees] of land in cells of this size: the coarser, the gentler. Within 6 % of the mean
/// slopes of Big Tujunga averaged to cells of 75 to 1200 m.
double usual_slope_deg(double cell_m);

/// Draws the land around the planned rivers, takes tips off these that would stand perched, and gives them and their
/// cells the land's heights. Takes: a network in plan; its heights too, where they are asked for; heights_of_file:
/// these are taken because the lines have them, and give way where they would need walls.
DrawnTerrain draw_in_equilibrium(DrawnTerrain drawn, bool heights_of_file, Diary& diary, Run const& run);

/// Makes arcs of the side valleys the land has grown, where the recipe wants them.
DrawnTerrain with_side_valleys(DrawnTerrain drawn, flow::FlowField const& drainage, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
