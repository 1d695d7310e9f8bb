// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// A polygon of a file, in the grid's coordinates.
struct Polygon {
    std::int64_t feature = 0;             ///< id in the file
    std::vector<std::vector<Vec2>> rings; ///< [m] implicitly closed; even-odd rule
    double value = 0.0;                   ///< of the requested field
};

/// The polygons of a file.
struct Polygons {
    std::vector<Polygon> polygons;
    std::string crs;  ///< of the coordinates; "" for none
    std::string name; ///< file, for messages
};

} // namespace thalweg
