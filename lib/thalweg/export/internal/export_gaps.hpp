// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/run/run.hpp>
#include <thalweg/export/export.hpp>
#include <thalweg/export/internal/river_splines.hpp>
#include <thalweg/report/pictures.hpp>

namespace thalweg::exports {

/// Refuses words of --rim and --holes that are none, and a level of the sea that is no number.
/// \throws BadParameter
void require_gap_options(ExportParams const& params);

/// Tells whether the user asks for gaps to be closed.
bool asks_for_gaps(ExportParams const& params);

/// Closes the gaps of a scene's DEM as surface::close_gaps, and says so in the result. Cells under the sea count as
/// lakes, so that maps and masks show water there. A folder whose recipe has a sea keeps its gaps: they are that sea.
/// \param scene with a DEM; a DEM that is cut becomes smaller
/// \throws BadInput when a folder with a sea is given options of gaps
void close_gaps_of(report::Scene& scene, ExportParams const& params, ExportResult& made, Run const& run);

/// Describes what close_gaps_of() did.
/// \return a JSON object: cells_without_data and, where there are some, without_data_m, rim, holes, sea_level_m
std::string description_of_gaps(ExportResult const& made);

/// Cuts rivers off at the border of a DEM that was cut, and says how much in the result.
/// \return the parts inside, in order; parts of one arc have its numbers
std::vector<RiverSpline> rivers_inside(std::vector<RiverSpline> const& rivers, Grid const& grid, ExportResult& made);

} // namespace thalweg::exports
