// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <thalweg/core/vec.hpp>

namespace thalweg {

/// One line somebody drew, as its file gives it, in the coordinates of the grid.
struct RiverLine {
    std::int64_t feature = 0;   ///< id in the file
    std::vector<Vec3> vertices; ///< [m], coordinates rounded to 1e-6 m; z is NaN where the file has none
    std::string type;           ///< river type (Rosgen) from the type field, or ""
    std::int64_t rank = 0;      ///< flow rank from the direction field: falls downstream; 0 where there is none
    int lambda = 0;             ///< generator of the network a stroke grows; 0 where the file has none
};

struct RiverLines {
    std::vector<RiverLine> lines;
    std::string crs;    ///< of the coordinates
    std::string name;   ///< file (and layer), for messages
    bool has_z = false; ///< every vertex has a height
};

} // namespace thalweg
