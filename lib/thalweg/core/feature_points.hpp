// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// Points through which the terrain passes: surveyed, read from a file, or random (\cite zhang). Law: all coordinates
/// and heights are finite.
struct FeaturePoints {
    std::vector<Vec3> points;   ///< [m]
    std::string crs;            ///< as in Grid; "" for none
    std::int64_t averaged = 0;  ///< places where points had unequal heights and took their mean
    double averaged_dz_m = 0.0; ///< [m] the largest difference of heights at one of them
};

} // namespace thalweg
