// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/feature_points.hpp>
#include <thalweg/pipeline/make/drawn_terrain.hpp>
#include <thalweg/pipeline/make/rivers.hpp>
#include <thalweg/pipeline/plan/internal/diary.hpp>

/// The land around rivers. Private to this room.
namespace thalweg::pipeline {

/// Draws the land that the rivers' recipe asks for through their cells, which keep their heights, and through the
/// points.
DrawnTerrain draw_around_rivers(Rivers const& rivers, FeaturePoints const& points, Diary& diary, Run const& run);

/// Rivers without land around them.
DrawnTerrain without_land(Rivers const& rivers);

} // namespace thalweg::pipeline
