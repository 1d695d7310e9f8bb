// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// Points through which the terrain passes: surveyed, read from a file, or random (\cite zhang). Law: all coordinates
/// and heights are finite.
struct FeaturePoints {
    std::vector<Vec3> points; ///< [m]
    std::string crs;          ///< as in Grid; "" for none
};

} // namespace thalweg
