// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/pipeline/plan/plan.hpp>

/// Which stages a plan asks for: make runs them by these questions, and the forecast names them by the same. Private to
/// this module.
namespace thalweg::pipeline {

/// Whether coastlines of the rivers' file bound the land.
bool has_coastlines(Plan const& plan);

/// Whether rivers are grown for a land in equilibrium: these run as in nature, which bends them.
bool grown_for_land(Plan const& plan);

/// Whether rivers go through the stage that bends them.
bool bends_rivers(Plan const& plan);

/// Whether rivers have no heights until the land gives them theirs.
bool follows_land(Recipe const& recipe);

/// Whether random points lie between the rivers, or in the land.
bool scatters(Recipe const& recipe);

/// Whether ridges are drawn between the rivers.
bool has_ridges(Recipe const& recipe);

/// Whether rivers, ridges and points are triangulated.
bool needs_tin(Recipe const& recipe);

/// Whether the land is made to drain.
bool conditions(Recipe const& recipe);

/// Whether the land's own side valleys become arcs.
bool fills_space(Recipe const& recipe);

} // namespace thalweg::pipeline
