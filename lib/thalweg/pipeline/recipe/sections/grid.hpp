// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace thalweg::pipeline {

/// Where the land lies. What is left out is chosen from the network.
struct GridRecipe {
    std::int64_t width = 0;  ///< [cells] 0: the network's box and 5 % around it
    std::int64_t height = 0; ///< [cells] likewise
    double cell_m = 30.0;    ///< [m] > 0; 0 chooses it from the lines of a file
    std::string crs;         ///< projected, metres; "": the line file's own or its UTM zone, else EPSG:32631
    std::optional<std::array<double, 2>> origin; ///< [m] west and north edge
    bool clip = false;                           ///< cut rivers at the grid's edge instead of refusing them
};

} // namespace thalweg::pipeline
