// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/features.hpp>
#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/make/assess.hpp>
#include <thalweg/make/planform.hpp>
#include <thalweg/make/terrain.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::make {

/// A terrain, and what it is held against. It refers to values of a plan for the time of a call.
struct AssessInput {
    recipe::Recipe const& recipe;
    Planform const& planform;
    Terrain const& terrain;
    RiverLines const& lines;                    ///< of the rivers' file; this and what follows as Plan
    std::vector<Finding> const& found_in_lines; ///< Plan::findings
    FeaturePoints const& points;
    RiverLines const& ridges;
    Raster<float> const& against;
};

/// Measures and checks land and rivers.
Assessment assess(AssessInput const& in, Run const& run);

} // namespace thalweg::make
