// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/feature_points.hpp>
#include <thalweg/pipeline/make/internal/diary.hpp>
#include <thalweg/pipeline/make/terrain.hpp>

/// The land around rivers. Private to this room.
namespace thalweg::pipeline {

/// Draws the land the recipe asks for through the rivers' cells, which keep their heights, and through the points.
void draw_around_rivers(Terrain& terrain, FeaturePoints const& points, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
