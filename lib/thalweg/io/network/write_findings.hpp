// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Writes findings as the points of a new GeoPackage: layer findings, with fields kind (text), feature (integer; 0 for
/// none), amount (real, in the unit of its kind) and text.
/// \post one point a finding, in their order; a layer without features where there is none; the same bytes on any day.
/// \pre findings; what is not finite in them stands as 0.
/// \param findings the findings
/// \param crs of their places, "" for none
/// \param path path of the file
/// \param run progress, log, stop token and number of threads
/// \throws IoError also when the file exists
/// \throws Cancelled
void write_findings(std::vector<Finding> const& findings, std::string const& crs, std::string const& path,
                    Run const& run = {});

} // namespace thalweg::io
