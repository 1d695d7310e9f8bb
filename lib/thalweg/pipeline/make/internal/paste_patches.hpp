// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>

/// Real relief in the land. Private to this module.
namespace thalweg::pipeline {

/// Pastes the recipe's patches into the land, in their order; rivers keep their cells' heights unless a patch says so.
Terrain with_patches(Plan const& plan, Terrain drawn, Diary& diary, Run const& run);

} // namespace thalweg::pipeline
