// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/make/terrain.hpp>

/// Private to this module.
namespace thalweg::pipeline {

/// Logs what reading changed in the files that the recipe names (CRS, units), and where the grid's UTM zone measures
/// wrong lengths; notes both for the report.
/// Takes: a terrain whose grid is known.
void report_conversions(Terrain& terrain, Run const& run);

} // namespace thalweg::pipeline
