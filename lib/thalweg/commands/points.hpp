// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::commands {

/// Which cells of a terrain become points.
enum class PointsOf : std::uint8_t {
    land,    ///< all cells with heights
    skeleton ///< cells of its rivers and ridges
};

/// Options of run_points().
struct PointsParams {
    std::string path = {};   ///< a DEM, or a folder written by make
    std::string output = {}; ///< a new file
    io::Existing existing = io::Existing::refuse;
    std::string format = {}; ///< a name of io::point_formats(); "": by the output's extension
    PointsOf of = PointsOf::land;
    std::int64_t every = 1;         ///< as in io::WritePointsParams
    io::ReadDemParams reading = {}; ///< how the DEM is read
};

/// The points written.
struct PointsResult {
    std::uint64_t count = 0;
    std::string crs;
    std::vector<Finding> findings = {}; ///< how the DEM was read
};

/// Runs `thalweg points`: reads a DEM and writes its cells as points, completely or not at all; for a skeleton, the
/// cells of network.tif in the same folder and those under the ridges of its network.gpkg, with the heights of dem.tif.
/// \return number of points, as io::write_points
/// \throws BadParameter as io::write_points, for an unknown format, and for a skeleton of something other than a folder
/// \throws BadInput as io::OutputFile, and when a file is missing, the coordinates are not metres or the frames differ
PointsResult run_points(PointsParams const& params, Run const& run = {});

} // namespace thalweg::commands
