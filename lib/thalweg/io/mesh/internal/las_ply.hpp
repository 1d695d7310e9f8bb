// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include <thalweg/core/height_unit.hpp>
#include <thalweg/core/vec.hpp>
#include <thalweg/io/files/internal/put_number.hpp>

namespace thalweg::io {

// Parts of binary PLY files, common to points and triangles. Source: Turk 1994, The PLY polygon file format.

/// Appends the header. crs: a comment; "": none; faces: their number; nothing: vertices only; the unit of heights: a
/// comment unless metres.
void put_ply_header(std::string& bytes, std::string const& crs, std::uint64_t vertices,
                    std::optional<std::uint64_t> faces = {}, HeightUnit unit = HeightUnit::metre);

/// Appends a vertex: three doubles.
void put_ply_vertex(std::string& bytes, Vec3 vertex);

// Parts of a LAS 1.2 file with points of format 0. Source: ASPRS, LAS specification version 1.2.

/// The smallest box around points.
struct PointExtent {
    Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
             std::numeric_limits<double>::infinity()};
    Vec3 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity()};

    void add(Vec3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
};

/// One axis: whole multiples of scale above offset.
struct LasAxis {
    double scale = 0.001;
    double offset = 0.0;

    std::int32_t whole(double v) const;
    double read(std::int32_t whole) const { return static_cast<double>(whole) * scale + offset; }
};

/// The common header values of all points.
struct LasFrame {
    LasAxis x;
    LasAxis y;
    LasAxis z;
    PointExtent extent; ///< of the coordinates as stored
    std::uint32_t count = 0;
};

/// Chooses scales and offsets.
/// \param extent of the points
/// \param count number of points
/// \param short_way [m] > 0, a short distance between points
/// \return scales of 0.001, or the power of ten below a thousandth of that distance, or the least one that fits the box
LasFrame las_frame(PointExtent const& extent, std::uint32_t count, double short_way);

/// Appends the header, with GeoTIFF keys if crs is "EPSG:n", projected in metres. The date is always 1 January 2000, so
/// that files are reproducible.
void put_las_header(std::string& bytes, LasFrame const& frame, std::string const& crs);

/// Appends a point within the frame's box, as the only return of its pulse.
void put_las_point(std::string& bytes, LasFrame const& frame, Vec3 point, std::uint8_t classification);

} // namespace thalweg::io
