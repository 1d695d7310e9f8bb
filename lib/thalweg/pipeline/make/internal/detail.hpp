// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/plan.hpp>

/// Fractal detail. Private to this module.
namespace thalweg::pipeline {

/// Land with fractal detail, and how that was made.
struct Detailed {
    DetailStory story;
    Raster<float> land;
};

/// Adds the detail that the plan wants to coarse land.
Detailed with_detail(Plan const& plan, Raster<float> const& coarse, Grid const& grid, Run const& run);

/// Relief of this fractal detail alone, on ground that is flat.
Detailed detail_alone(Plan const& plan, Grid const& grid, Run const& run);

} // namespace thalweg::pipeline
