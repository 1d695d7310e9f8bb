// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/mesh/internal/read_las.hpp>
#include <thalweg/io/mesh/points.hpp>

class OGRSpatialReference;

namespace thalweg::io {

/// The points that are taken from a cloud.
struct Cloud {
    std::vector<Vec3> points;      ///< in the file's coordinates and its unit of heights
    std::vector<Finding> findings; ///< classes, thinning
    std::int64_t left_out = 0;     ///< points of the classes whose height stands for no data
};

/// Reads a point cloud in passes: one that counts classes; one that finds where there are points, if a cell has to be
/// chosen; one that takes points. Up to 2^25 points are decoded once and kept in between; a larger file is read again.
/// \param params classes, thin_m and nodata
/// \param crs of the coordinates; empty: they are metres
/// \return no points if the file has none
/// \throws BadInput when it is damaged, has no points of the classes, or all are no data
/// \throws BadParameter for wrong classes or cells too small
Cloud read_cloud(LasHeader const& header, ReadPointsParams const& params, OGRSpatialReference const& crs,
                 Run const& run);

} // namespace thalweg::io
