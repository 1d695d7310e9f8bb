// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

Rows<ForestRecipe> forest_keys() {
    using network::ForestParams;
    Use const grown = source_is("forest");
    Use const shaped = grown && not_given("network.forest.region");
    return {
        choice("shape", &ForestRecipe::shape)
            .one_of({{"grid", LandShape::grid}, {"island", LandShape::island}})
            .used(shaped)
            .means("extent of the land where no region is given: the whole grid, or an island in it"),
        number("ruggedness", &ForestRecipe::ruggedness)
            .range({0, 1})
            .used(shaped && is("network.forest.shape", {"island"}))
            .means("how far fjords and capes of the island reach"),
        file("region", &ForestRecipe::region)
            .used(grown)
            .means("polygons that are land, with sea around them; \"\": see shape"),
        file("outlets", &ForestRecipe::outlets)
            .used(grown)
            .means("where rivers reach the coast: points, lines along the coast, or polygons of water; \"\": anywhere "
                   "on the coast"),
        number("seeds", &ForestRecipe::seeds)
            .range({0, 1e6})
            .used(grown)
            .means("number of outlets at random places on the coast; 0: see outlet_spacing"),
        number("outlet_spacing", &ForestRecipe::outlet_spacing_cells)
            .unit("cells")
            .range({0, 1e6})
            .used(grown && is("network.forest.seeds", {"0"}))
            .means("coast, or border of the grid, for each outlet; 0: six spacings of rivers"),
        number("spacing", &ForestRecipe::spacing_cells)
            .unit("cells")
            .range({8, 200})
            .used(grown)
            .means("minimum distance between rivers that do not meet"),
        number("particles", &ForestRecipe::growth, &ForestParams::particles)
            .range({0, 1e9})
            .used(grown)
            .means("number of particles of all trees; 0: until the land is full"),
        number("sticking", &ForestRecipe::growth, &ForestParams::sticking)
            .range({0, 1, left_open})
            .used(grown)
            .means("sticking probability"),
        number("visits", &ForestRecipe::growth, &ForestParams::visits)
            .range({1, 255})
            .used(grown)
            .means("noise-reduction count M: arrivals that a cell needs before it is occupied; larger values make "
                   "straighter rivers"),
    };
}

} // namespace thalweg::pipeline
