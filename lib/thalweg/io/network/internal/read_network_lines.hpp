// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <thalweg/core/vec.hpp>

class OGRGeometry;

/// What is drawn as an arc. Private to this module.
namespace thalweg::io {

struct DrawnLine {
    bool is_line = true;                  ///< else the rest is empty
    std::vector<std::vector<Vec3>> parts; ///< one when they join end to end; z is NaN without heights
    int drawn_parts = 0;                  ///< as they stand in the file
    bool has_z = false;
    bool has_m = false;
    bool curved = false;
};

/// Takes: any geometry, or none (nullptr), which is a line without vertices.
DrawnLine drawn_line(OGRGeometry const* shape);

} // namespace thalweg::io
