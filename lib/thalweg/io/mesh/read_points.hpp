// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <thalweg/core/feature_points.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Whether points need heights.
enum class PointHeights : std::uint8_t {
    wanted,
    passed_over ///< points lie in plan: whatever heights they have count as 0, and text needs no third column
};

/// What becomes of points that lie at one place in plan at unequal heights.
enum class DuplicatePoints : std::uint8_t {
    refused,
    averaged ///< all of a place take the mean of their heights
};

/// Options of read_points().
struct ReadPointsParams {
    std::string path = {};     ///< text (.csv, .txt, .xyz) or anything OGR opens
    std::string layer = {};    ///< "" takes the only layer of points
    std::string z_field = "z"; ///< heights of points that have none themselves
    std::string crs = {};      ///< of the result; "" takes the file's own when projected in metres, else its UTM zone;
                               ///< a file without one, text included, is taken to be in it unless source_crs says
    PointHeights heights = PointHeights::wanted;
    DuplicatePoints duplicates = DuplicatePoints::refused;
    /// Text: the columns that hold x, y and z, as names of a first line or numbers from 1 ("3,2,4"), or "pnezd"
    /// (number, northing, easting, height, description). "": a first line names them x, y and z, or there are just
    /// these three; nothing where the user has no option to name them
    std::optional<std::string> columns = {};
    /// CRS of a file that has none, text included ("": crs); nothing where the user has no option to name it
    std::optional<std::string> source_crs = {};
};

/// Reads points with heights. Text: one a line, x y z in three columns, in those that a first line names (x, y, z in
/// any case and order) or in those of params.columns, separated by commas, semicolons or blanks; empty lines and those
/// that begin with # are skipped. OGR: points and multi-points, their Z or the field z, reprojected and rounded to 1e-6
/// m as read_rivers does. \param params options, each with its default, unit and range \param run progress, log, stop
/// token and number of threads \return the points \throws BadInput naming file and line or feature: missing file, layer
/// or height, several layers of points, no points, something that is not a point or not a number, NaN or infinite
/// values, no CRS (not in text), coordinates that cannot be reprojected, text without names that has more than three
/// columns, text without a CRS that can only be longitudes and latitudes (where params.source_crs is set) \throws
/// BadParameter columns that are not three \throws IoError when the file cannot be read to its end \throws Cancelled
FeaturePoints read_points(ReadPointsParams const& params, Run const& run = {});

/// \param path path of the file
/// \return whether a path's ending is that of text with points.
bool is_text_of_points(std::string const& path);

} // namespace thalweg::io
