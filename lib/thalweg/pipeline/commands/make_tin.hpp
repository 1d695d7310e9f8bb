// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/core/tin.hpp>
#include <thalweg/io/mesh/points.hpp>

namespace thalweg::pipeline {

/// Options of make_tin().
struct MakeTinParams {
    std::string path = {};              ///< a DEM, points, lines with heights, or a folder that make wrote
    std::string breaklines = {};        ///< lines with heights, for points and lines; "" for none
    std::string crs = {};               ///< of the result, projected, in metres; "" takes the file's own
    std::optional<double> error_m = {}; ///< [m] > 0, of a DEM; 1 without one
    std::string source_crs = {};        ///< of points and lines whose file has no CRS; "" for none
    /// points alone; averaged where nothing is said
    std::optional<io::DuplicatePoints> duplicates = {};
    std::string columns = {};          ///< of text with points, as io::ReadPointsParams; "" for none
    std::optional<double> nodata = {}; ///< of the DEM, as in io::ReadDemParams
};

/// A TIN and how it came about.
struct MadeTin {
    Tin tin;
    std::string crs;
    std::string source;            ///< "dem", "points" or "network"
    std::optional<double> error_m; ///< greatest there is, of a DEM
    std::int64_t left_out = 0;     ///< cells of a DEM in no triangle
    std::int64_t merged = 0;       ///< as in geometry::Triangulation
    double merged_dz_m = 0.0;
    std::int64_t averaged = 0; ///< as in FeaturePoints
    double averaged_dz_m = 0.0;
    std::int64_t crossings = 0;
    double crossings_dz_m = 0.0;
};

/// Reads a file and makes a TIN of what it holds: a DEM within an error; points, with breaklines; lines as breaklines.
/// \param params files; breaklines are reprojected to the CRS of the points
/// \return as the stages do.
/// \throws BadParameter when an option does not belong to what the file holds
/// \throws BadInput also when lines have no heights
MadeTin make_tin(MakeTinParams const& params, Run const& run = {});

} // namespace thalweg::pipeline
