// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include <thalweg/surface/equilibrium/equilibrium.hpp>

namespace thalweg::pipeline {

/// What a land in equilibrium is like, beside surface.relief and network.concavity.
struct EquilibriumRecipe {
    std::optional<double> mean_slope_deg; ///< none: 25, where no relief is asked
    double hillslope_m = 0.0;             ///< [m] 0: one cell
    double floor_width = 0.04;            ///< as surface::EquilibriumParams
    double roughness = 0.25;
    std::optional<surface::Edge> edge; ///< none: mainland by coastlines, coast by other sea, else open
    std::string uplift;                ///< raster on the grid; "" for none
    std::string erodibility;           ///< raster on the grid, or polygons with a field of that name; "" for none
    std::string lakes;                 ///< polygons; "" for none
    double lake_share = 0.0;           ///< [0, 1] of the reaches with enough water, that run through a lake
};

} // namespace thalweg::pipeline
