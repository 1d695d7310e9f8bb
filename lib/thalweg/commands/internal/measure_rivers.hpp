// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/commands/measure.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/river_files.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/flow/catchments.hpp>
#include <thalweg/flow/route.hpp>
#include <thalweg/measure/rivers/profiles.hpp>

namespace thalweg::commands {

// The rivers of `thalweg measure`: those of a file, or of the DEM.

struct MeasuredRiver {
    flow::Reaches reaches;
    std::vector<std::int64_t> basins; ///< by reach
    std::vector<std::string> names;   ///< by reach; "": none
    std::int64_t cut = 0;             ///< reaches that leave the grid
    std::int64_t outside = 0;
    std::int64_t nowhere = 0;
    std::int64_t unknown = 0; ///< arcs that name one downstream which the file does not hold
};

/// Joins lines to trees and directs them, as `check --fix`: first by the DEM where nothing else tells.
/// \param findings gets the doubts about directions
/// \return arcs numbered from 1
/// \throws BadInput when they make no tree
NetworkFile joined_lines(NetworkFile const& file, Raster<float> const& dem, std::vector<Finding>& findings,
                         Run const& run);

/// The reaches of a file's arcs inside a grid, as reaches_of_file.
MeasuredRiver rivers_of_file(NetworkFile const& file, Grid const& grid);

/// The streams that extract_streams finds, numbered from 1.
MeasuredRiver rivers_of_dem(Raster<float> const& dem, flow::FlowField const& drainage, std::int64_t support_cells,
                            Run const& run);

struct RiverMeasures {
    measure::RiverProfiles profiles;
    std::vector<double> chi;
    std::vector<double> k_sn;                   ///< by cell of the profiles
    std::vector<measure::ReachProfile> reaches; ///< by reach
    std::vector<measure::Knickpoint> knickpoints;
    MeasuredStreams counts;
};

/// Profiles, chi with the concavity index of params or a fitted one, steepness and knickpoints.
/// \throws BadInput when a concavity index is to be fitted to rivers that do not fall
RiverMeasures measure_rivers(MeasuredRiver const& rivers, Raster<float> const& dem, flow::FlowField const& drainage,
                             MeasureParams const& params, Run const& run);

/// Values of river cells as a raster; NaN elsewhere.
Raster<double> raster_of(measure::RiverProfiles const& profiles, std::vector<double> const& values, Grid const& grid);

/// Layers arcs (at the heights of the profiles; those without any are left out) and knickpoints.
void write_streams(MeasuredRiver const& rivers, RiverMeasures const& measures, Grid const& grid,
                   std::string const& path, Run const& run);

/// Layers catchments and basins, with their relief; catchments also with Pfafstetter codes.
MeasuredCatchments write_catchments(MeasuredRiver const& rivers, Raster<float> const& dem,
                                    flow::FlowField const& drainage, std::string const& path, Run const& run);

} // namespace thalweg::commands
