// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/io/files/files.hpp>
#include <thalweg/io/mesh/points.hpp>
#include <thalweg/io/raster/raster_files.hpp>

namespace thalweg::commands {

/// Options of run_tin().
struct TinParams {
    std::string path = {};   ///< a DEM, points (clouds too), lines with heights, or a folder written by make
    std::string output = {}; ///< a new file
    io::Existing existing = io::Existing::refuse;
    std::string format = {};            ///< a name of io::tin_formats(); "": by the output's extension
    std::string breaklines = {};        ///< lines with heights, for points and lines; "": none
    std::string height_column = {};     ///< of points or lines; "": their Z, of points without one a column z
    std::string crs = {};               ///< of the result, projected, in metres; "": the file's own
    std::optional<double> error_m = {}; ///< [m] > 0, for a DEM; 1 if not set
    std::string source_crs = {};        ///< of points and lines whose file has no CRS; "": none
    /// for points; averaged if not set
    std::optional<io::DuplicatePoints> duplicates = {};
    std::string columns = {};          ///< of text with points, as io::ReadPointsParams; "": none
    std::string classes = {};          ///< of a point cloud, as io::ReadPointsParams; "": ground
    std::optional<double> thin_m = {}; ///< [m] >= 0, of a point cloud, as io::ReadPointsParams
    bool medial_points = false;        ///< surface::medial_points() for the level areas of lines
    io::ReadDemParams reading = {};    ///< how the DEM is read; nodata also applies to points
};

/// A TIN and the statistics of its construction.
struct TinResult {
    Tin tin;
    std::string crs;
    std::string source;            ///< "dem", "points" or "network"
    std::optional<double> error_m; ///< largest error, for a DEM
    std::int64_t left_out = 0;     ///< cells of a DEM in no triangle
    std::int64_t merged = 0;       ///< as in geometry::Triangulation
    double merged_dz_m = 0.0;
    std::int64_t averaged = 0;       ///< as in FeaturePoints
    std::int64_t without_height = 0; ///< points that stand for no data, left out
    double averaged_dz_m = 0.0;
    std::int64_t crossings = 0;
    double crossings_dz_m = 0.0;
    std::int64_t medial = 0;            ///< points in level areas, by medial_points
    std::optional<double> flat = {};    ///< [0, 1] share of the area in level triangles, for lines and points
    std::vector<Finding> findings = {}; ///< how a DEM, points or lines were read
};

/// Runs `thalweg tin`: reads a file and writes a TIN of its content, completely or not at all: of a DEM within an
/// error; of points, with breaklines; of lines as breaklines.
/// \param params files and options; breaklines are reprojected to the CRS of the points
/// \return as the stages
/// \throws BadParameter when an option does not apply to the file's content, or for an unknown format
/// \throws BadInput as the stages, readers and io::OutputFile, and when lines have no heights
TinResult run_tin(TinParams const& params, Run const& run = {});

} // namespace thalweg::commands
