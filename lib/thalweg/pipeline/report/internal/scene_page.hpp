// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/pipeline/report/pictures.hpp>

namespace thalweg::pipeline {

/// The report page of a scene: any DEM, with or without rivers, measured and drained for it.
/// Takes: a scene with a DEM; notes: what was changed in reading it; command: what makes the page again.
/// Throws: BadInput when the scene has no DEM or the DEM no height; Cancelled; IoError.
std::string scene_page(Scene const& scene, std::vector<std::string> const& notes, std::string const& command,
                       Run const& run = {});

} // namespace thalweg::pipeline
