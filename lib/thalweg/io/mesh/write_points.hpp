// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/feature_points.hpp>
#include <thalweg/core/raster.hpp>
#include <thalweg/core/run/run.hpp>
#include <thalweg/core/skeleton.hpp>

namespace thalweg::io {

/// How a cloud of points is written.
enum class PointFormat : std::uint8_t {
    ply, ///< PLY, binary, coordinates as doubles
    las, ///< LAS 1.2, point format 0
    xyz, ///< text, x y z of one a line
};

/// A point format name.
struct PointFormatName {
    PointFormat format;
    char const* name;   ///< "las"
    char const* ending; ///< ".las"
};
std::vector<PointFormatName> const& point_formats();

/// \param name its name
/// \param path path of the file
/// \return the format of a name, or where it is "" of a path's ending, in any case of letters.
/// \throws BadParameter that lists the names there are
PointFormat point_format(std::string const& name, std::string const& path);

/// What LAS says of a point (its classification).
enum class PointClass : std::uint8_t {
    ground = 2,    ///< cells of a land
    key_point = 8, ///< points of a file, ridges and points of a skeleton (model key-point)
    water = 9      ///< rivers of a skeleton
};

/// Options of write_points().
struct WritePointsParams {
    PointFormat format = PointFormat::las;
    std::int64_t every = 1; ///< [1, ...] one point, or row and column, of this many: the first
};

/// Writes points, or the centres of all cells with a height, as a new file; gives how many there are.
/// \pre crs as in Grid, kept by ply (comment) and las (EPSG code); rivers: a mask in the skeleton's frame.
/// \param points the points
/// \param path path of the file
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return points in their order, cells row by row from the north-west. Coordinates read back bit for bit, in text a
/// cell's height as a float; in LAS within half a millimetre, or half a thousandth of a cell below a metre (of extents
/// that need more than 32 bits: half the least power of ten that fits). The same bytes on any day.
/// \throws BadParameter
/// \throws BadInput naming point or cell, for a number that is not finite, when there is no point, LAS cannot count so
/// many or the mask is of another frame
/// \throws IoError also when the file exists
/// \throws Cancelled
///
/// Source: ASPRS LAS 1.2; \cite turk1994, The PLY polygon file format.
std::uint64_t write_points(FeaturePoints const& points, std::string const& path, WritePointsParams const& params = {},
                           Run const& run = {});
std::uint64_t write_points(Raster<float> const& land, std::string const& path, WritePointsParams const& params = {},
                           Run const& run = {});
std::uint64_t write_points(Skeleton const& skeleton, Mask const& rivers, std::string const& path,
                           WritePointsParams const& params = {}, Run const& run = {});

} // namespace thalweg::io
