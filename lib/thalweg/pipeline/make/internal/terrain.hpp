// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

namespace thalweg::pipeline {

// Land from numbers and from points (paper 001).

/// The check points_missing: random points that found no room, with a warning.
Check points_missing(std::int64_t missing, std::int64_t wanted, Run const& run);

/// Land without rivers: a random one or that of points, with fractal detail, brought to the statistics.
Terrain make_land(Plan const& plan, Diary& diary, Run const& run);

// Fractal detail.

/// Land with fractal detail, and how that was made.
struct Detailed {
    DetailStory story;
    Raster<float> land;
};

/// Relief of this fractal detail alone, on ground that is flat.
Detailed detail_alone(Plan const& plan, Grid const& grid, Run const& run);

// Land in equilibrium with its rivers.

/// Draws the land around the planned rivers, takes tips off these that would stand perched, and gives them and their
/// cells the land's heights. Takes: a network in plan; its heights too, where they are asked for; those that are taken
/// because the lines have them give way where they would need walls.
Terrain draw_in_equilibrium(Plan const& plan, Terrain terrain, Diary& diary, Run const& run);

/// Makes arcs of the side valleys the land has grown, where the plan wants them.
Terrain with_side_valleys(Plan const& plan, Terrain terrain, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
