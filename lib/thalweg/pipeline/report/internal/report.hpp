// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/draw/picture.hpp>
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/pipeline/make/against.hpp>

namespace thalweg::pipeline {

/// Draws the differences of a terrain and the DEM it is compared with.
draw::Picture differences_against(Against const& against, Terrain const& terrain, int width_px);

/// Draws a terrain beside the DEM it is compared with.
draw::Picture comparison_against(Against const& against, Terrain const& terrain, std::string const& title);

// Parts of report.json common to other reports.

/// Figures of a terrain beside a DEM as a JSON object.
std::string figures_against(TerrainAgainst const& terrain);

/// Whether a finding is about one of the input's features and no fault.
bool is_repair(Finding const& finding);

/// A certificate as a JSON object.
std::string certificate_json(measure::Certificate const& certificate);

} // namespace thalweg::pipeline
