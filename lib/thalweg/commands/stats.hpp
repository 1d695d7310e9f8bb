// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/laws.hpp>
#include <thalweg/make/relief.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/recipe/recipe_of_dem.hpp>

namespace thalweg::commands {

/// Options of run_stats().
struct StatsParams {
    std::string path = {};          ///< any raster of heights, or, for the laws alone, river lines
    io::ReadDemParams reading = {}; ///< how the DEM is read
    bool laws = false;              ///< of the streams extracted from the DEM, or of the lines
    bool relief = false;
    bool recipe = false;                                              ///< of other terrain with the same statistics
    std::int64_t support_cells = make::DemLawsParams{}.support_cells; ///< of the laws, as in DemLawsParams
};

/// What run_stats() returns.
struct StatsResult {
    Grid grid; ///< of the DEM that was measured
    measure::Statistics statistics;
    std::optional<make::DemLaws> laws = {};
    std::optional<make::LineLaws> lines =
        {}; ///< laws of lines: then there is no DEM, and grid and statistics are empty
    std::optional<make::TerrainRelief> relief = {};
    std::optional<recipe::DemRecipe> recipe = {};
    std::vector<Finding> findings = {}; ///< how the DEM was read
};

/// Runs `thalweg stats`: reads a DEM and computes its statistics. One that is not on squares in metres is warped to
/// such as io::read_drawable does, and findings say so; count, mean, deviation, extremes, skewness and kurtosis remain
/// those of the file's own cells (of degrees weighted by their area). Lines are repaired as by `thalweg check --fix`.
/// \param params file and options
/// \return the statistics, and what else is set
/// \throws BadInput as io::read_drawable, io::read_network, the statistics and recipe_of_dem, and for lines that make
/// no tree
StatsResult run_stats(StatsParams const& params, Run const& run = {});

} // namespace thalweg::commands
