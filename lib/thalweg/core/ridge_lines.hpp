// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// A crest between the areas of two streams.
struct RidgeLine {
    std::vector<Vec3> line; ///< [m] at least two vertices, no two in a row at the same place in plan
    std::int64_t left = 0;  ///< label of the stream to the left of the line
    std::int64_t right = 0; ///< label of the stream to the right; differs from left
};

/// The ridges between streams. Law: no ridge meets a river; ridges meet only at their ends.
struct RidgeLines {
    std::vector<RidgeLine> lines;
};

} // namespace thalweg
