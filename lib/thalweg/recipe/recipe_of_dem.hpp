// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <thalweg/core/raster.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// A recipe, and in words what a reader should know of it.
struct DemRecipe {
    Recipe recipe;
    std::vector<std::string> notes; ///< one line of UTF-8 each, the first naming the source
};

/// The recipe of a land with the statistics of a DEM.
/// \pre the DEM, its CRS of any kind or ""; its statistics
/// \param dem [m] heights by cell; NaN: no data
/// \param source its file name, whose stem becomes the title
/// \return sections [grid] and [statistics] with mean, std, max, min, length, slope and dimension; what the heights do
/// not tell, or no recipe may ask for, is left out and said in notes. The grid is the DEM's whole rectangle, holes
/// included, at its place where the CRS is projected in metres; else at the default place, with cells as large as those
/// of the DEM are on the ground.
/// \throws BadInput when all heights are equal, or as io::ground_cell does
DemRecipe recipe_of_dem(Raster<float> const& dem, measure::Statistics const& statistics, std::string const& source);

} // namespace thalweg::recipe
