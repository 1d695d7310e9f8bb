// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/measure/drainage/certificate.hpp>
#include <thalweg/surface/equilibrium/equilibrium.hpp>

/// Parts of report.json that other reports have too. Private to this module.
namespace thalweg::pipeline {

/// Findings as a JSON array.
std::string findings_json(std::vector<Finding> const& findings);

/// Water that enters the grid as a JSON array, the largest first.
std::string inflows_json(Grid const& grid, std::vector<surface::RegionInflow> inflows);

/// A certificate as a JSON object.
std::string certificate_json(measure::Certificate const& certificate);

} // namespace thalweg::pipeline
