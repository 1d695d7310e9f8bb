// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/pipeline/make/rivers.hpp>
#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>

/// The land around rivers. Private to this module.
namespace thalweg::pipeline {

/// Draws the land that the plan asks for through the rivers' cells, which keep their heights, and through the points.
Terrain draw_around_rivers(Plan const& plan, Rivers const& rivers, Diary& diary, Run const& run);

/// Rivers without land around them.
Terrain without_land(Rivers const& rivers);

} // namespace thalweg::pipeline
