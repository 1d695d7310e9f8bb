// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace thalweg {

/// Ground position [m] in the coordinate system of the grid: x to the east, y to the north.
struct Vec2 {
    double x = 0.0;
    double y = 0.0;
    friend bool operator==(Vec2 const&, Vec2 const&) = default;
};

/// Ground position and height [m].
struct Vec3 {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    friend bool operator==(Vec3 const&, Vec3 const&) = default;
};

/// Distance [m]. Only the square root is used: std::hypot has other bits on other machines.
inline double distance(Vec2 a, Vec2 b) {
    double const dx = a.x - b.x;
    double const dy = a.y - b.y;
    return std::sqrt(dx * dx + dy * dy);
}

} // namespace thalweg
