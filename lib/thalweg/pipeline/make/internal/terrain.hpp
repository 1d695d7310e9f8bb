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

// Terrain from statistics and from points (Zhang, Liu and Li).

/// The check points_missing: random points that found no room, with a warning.
Check points_missing(std::int64_t missing, std::int64_t wanted, Run const& run);

/// Makes terrain without rivers: random or through points, with fractal detail, matched to the statistics.
Terrain make_land(Plan const& plan, Diary& diary, Run const& run);

// Fractal detail.

/// Terrain with fractal detail, and its parameters.
struct Detailed {
    DetailStory story;
    Raster<float> land;
};

/// Makes terrain of fractal detail alone, on level ground.
Detailed detail_alone(Plan const& plan, Grid const& grid, Run const& run);

// Terrain in equilibrium with its rivers.

/// Draws the terrain around the planned rivers, removes perched tips of rivers, and assigns the terrain's heights to
/// them and their cells. Prescribed heights are used; those taken only because the lines have them are relaxed where
/// they would need walls.
Terrain draw_in_equilibrium(Plan const& plan, Terrain terrain, Diary& diary, Run const& run);

/// Makes arcs of the side valleys grown by the terrain, if the plan requests it.
Terrain with_side_valleys(Plan const& plan, Terrain terrain, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
