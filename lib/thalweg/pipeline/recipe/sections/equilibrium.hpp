// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include <thalweg/surface/equilibrium/equilibrium.hpp>
#include <thalweg/surface/uplift/uplift_pattern.hpp>

namespace thalweg::pipeline {

/// What a land in equilibrium is like, beside surface.relief and network.concavity.
struct EquilibriumRecipe {
    std::optional<double> mean_slope_deg; ///< none: 25, where no relief is asked
    double hillslope_m = 15.0;            ///< [m] this and what follows as surface::EquilibriumParams
    double debris_area_km2 = 0.045;
    double floor_width = 0.0425; ///< [0, 1] 0.0425: floors 18 m wide where 1 km² drains, in proportion
    double roughness = 0.22;
    double longest_wave_m = 10'800.0;
    double grain = 5.0;
    std::optional<double> strike_deg;
    std::optional<surface::Edge> edge; ///< none: mainland by coastlines, coast by other sea, else open
    std::optional<double> region;      ///< none: 3 for grown rivers, 1 for those of a file
    std::string uplift;                ///< raster on the grid; "" for none
    std::optional<surface::UpliftPattern> uplift_pattern; ///< none: uplift is the same everywhere, but for the raster
    double uplift_contrast = 4.0;
    double uplift_wave_m = 12'000.0;
    std::string erodibility; ///< raster on the grid, or polygons with a field of that name; "" for none
    std::string lakes;       ///< polygons; "" for none
    double lake_share = 0.0; ///< [0, 1] of the reaches with enough water, that run through a lake
};

} // namespace thalweg::pipeline
