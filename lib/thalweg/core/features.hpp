// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/finding.hpp>
#include <thalweg/core/vec.hpp>

namespace thalweg {

/// Points through which the terrain passes: surveyed, read from a file, or random (\cite zhang). Law: all coordinates
/// and heights are finite.
struct FeaturePoints {
    std::vector<Vec3> points;           ///< [m]
    std::string crs;                    ///< as in Grid; "" for none
    std::int64_t left_out = 0;          ///< points whose height stood for no data
    std::int64_t averaged = 0;          ///< places where points had unequal heights and took their mean
    double averaged_dz_m = 0.0;         ///< [m] the largest difference of heights at one of them
    std::vector<Finding> findings = {}; ///< how a point cloud was read
};

/// A crest between the areas of two streams.
struct RidgeLine {
    std::vector<Vec3> line; ///< [m] at least two vertices, no two in a row at the same place in plan
    std::int64_t left = 0;  ///< label of the stream to the left of the line
    std::int64_t right = 0; ///< label of the stream to the right; differs from left, unless both are 0: of a file
};

/// The ridges between streams. Law: no ridge meets a river; ridges meet only at their ends.
struct RidgeLines {
    std::vector<RidgeLine> lines;
};

/// A polygon of a file, in the grid's coordinates.
struct Polygon {
    std::int64_t feature = 0;             ///< id in the file
    std::vector<std::vector<Vec2>> rings; ///< [m] implicitly closed; even-odd rule
    double value = 0.0;                   ///< [as the field] the requested one; NaN: it has none
};

/// The polygons of a file.
struct Polygons {
    std::vector<Polygon> polygons;
    std::string crs;  ///< of the coordinates; "" for none
    std::string name; ///< file, for messages
};

} // namespace thalweg
