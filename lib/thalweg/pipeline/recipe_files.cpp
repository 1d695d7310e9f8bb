// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe_files.hpp>

namespace thalweg::pipeline {

std::string file_in(Recipe const& recipe, std::string const& name) {
    return recipe.folder.empty() || name.empty() || name.front() == '/' ? name : recipe.folder + "/" + name;
}

void take_frame(Terrain& terrain, Grid const& grid) {
    terrain.grid = grid;
    terrain.recipe.grid.width = grid.width;
    terrain.recipe.grid.height = grid.height;
    terrain.recipe.grid.origin = {grid.west, grid.north};
}

} // namespace thalweg::pipeline
