// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// A triangulated irregular network. Law: every vertex belongs to a triangle, no two vertices coincide in plan;
/// triangles are counterclockwise from above, have positive area and do not overlap.
struct Tin {
    std::vector<Vec3> vertices;                          ///< [m]
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< indices of vertices
};

} // namespace thalweg
