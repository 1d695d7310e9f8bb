// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/core/feature_points.hpp>
#include <thalweg/core/run/run.hpp>

namespace thalweg::io {

/// Whether points need heights.
enum class PointHeights : std::uint8_t {
    wanted,
    passed_over ///< points lie in plan: whatever heights they have count as 0, and text needs no third column
};

/// Options of read_points().
struct ReadPointsParams {
    std::string path = {};     ///< text (.csv, .txt, .xyz) or anything OGR opens
    std::string layer = {};    ///< "" takes the only layer of points
    std::string z_field = "z"; ///< heights of points that have none themselves
    std::string crs = {};      ///< of the result; "" takes the file's own when projected in metres, else its UTM zone;
                               ///< a file without one, text included, is taken to be in it
    PointHeights heights = PointHeights::wanted;
};

/// Reads points with heights. Text: one a line, x y z in the first three columns or in those a first line names (x, y,
/// z in any case and order), parted by commas, semicolons or blanks; empty lines and those that begin with # are
/// skipped. OGR: points and multi-points, their Z or the field z, reprojected and rounded to 1e-6 m as read_rivers
/// does.
/// \param params options, each with its default, unit and range
/// \param run progress, log, stop token and number of threads
/// \return the points
/// \throws BadInput naming file and line or feature: missing file, layer or height, several layers of points, no
/// points, something that is not a point or not a number, NaN or infinite values, no CRS (not in text), coordinates
/// that cannot be reprojected
/// \throws IoError when the file cannot be read to its end
/// \throws Cancelled
FeaturePoints read_points(ReadPointsParams const& params, Run const& run = {});

/// \param path path of the file
/// \return whether a path's ending is that of text with points.
bool is_text_of_points(std::string const& path);

} // namespace thalweg::io
