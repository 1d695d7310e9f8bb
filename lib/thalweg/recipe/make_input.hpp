// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include <thalweg/core/run/run.hpp>
#include <thalweg/recipe/recipe.hpp>

namespace thalweg::recipe {

/// Reads or creates the recipe of a path.
/// \param path a recipe (a name that ends in .toml, or a text that begins like TOML), or data as for data_recipe()
/// \return the recipe
/// \throws BadParameter with all faults of a recipe
/// \throws BadInput when the path is neither, with its content
Recipe recipe_from(std::string const& path);

/// Creates the recipe for terrain in equilibrium with the rivers of a file or folder.
/// \param path as for io::find_rivers
/// \return grid.cell is 0: chosen from the rivers
/// \throws BadInput as io::find_rivers
Recipe rivers_recipe(std::string const& path);

/// Creates the recipe for terrain as a DEM has it.
/// \param path of a raster that GDAL reads
/// \return surface.method is "raster"; grid.cell is 0: that of the DEM
Recipe raster_recipe(std::string const& path);

/// Creates the recipe for a file of data.
/// \param path rivers as for rivers_recipe(), or a raster without lines
/// \return as these
/// \throws BadInput when the path is neither, with its content
Recipe data_recipe(std::string const& path);

/// Makes a recipe of rivers from a file one that rebuilds the terrain between them: in equilibrium, with the heights of
/// the file where it leaves these open, and on the cells of the DEM of output.against, where it names one, as far as
/// its [grid] leaves them open. Rivers are clipped there.
/// \param recipe of lines
/// \return the recipe
/// \throws BadInput when the rivers are not lines of a file; when neither the DEM nor the recipe has a CRS; as
/// io::read_dem
Recipe rebuild_recipe(Recipe recipe, Run const& run = {});

/// Sets in a recipe what make_terrain() would choose from its rivers and its DEM: CRS, cell size and, from a DEM, the
/// frame; paths become absolute.
/// \param recipe any
/// \return the recipe
/// \throws Error as make_terrain()
Recipe settled_recipe(Recipe const& recipe, Run const& run = {});

} // namespace thalweg::recipe
