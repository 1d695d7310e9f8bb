// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/io/mesh/points.hpp>

namespace thalweg::pipeline {

/// Which cells of a terrain become points.
enum class PointsOf : std::uint8_t {
    land,    ///< all cells with heights
    skeleton ///< cells of its rivers and ridges
};

/// Options of make_points().
struct MakePointsParams {
    std::string path = {}; ///< a DEM, or a folder written by make
    PointsOf of = PointsOf::land;
    io::WritePointsParams write = {};
    std::optional<double> nodata = {}; ///< of the DEM, as in io::ReadDemParams
};

/// The points written.
struct MadePoints {
    std::uint64_t count = 0;
    std::string crs;
};

/// Reads a DEM and writes its cells as points; for a skeleton, the cells of network.tif in the same folder and those
/// under the ridges of its network.gpkg, with the heights of dem.tif.
/// \param output a new file
/// \return number of points, as io::write_points
/// \throws BadParameter as io::write_points, and for a skeleton of something other than a folder
/// \throws BadInput when a file is missing, the coordinates are not metres or the frames differ
MadePoints make_points(MakePointsParams const& params, std::string const& output, Run const& run = {});

} // namespace thalweg::pipeline
