// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// One polygon somebody drew, as its file gives it, in the coordinates of the grid.
struct Polygon {
    std::int64_t feature = 0;             ///< id in the file
    std::vector<std::vector<Vec2>> rings; ///< [m] closed by themselves; what an odd number of them surrounds is inside
    double value = 0.0;                   ///< of the field that was asked for
};

/// Polygons with their features.
struct Polygons {
    std::vector<Polygon> polygons;
    std::string crs;  ///< of the coordinates; "" for none
    std::string name; ///< file, for messages
};

} // namespace thalweg
