// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/conditions.hpp>
#include <thalweg/pipeline/recipe/internal/sections.hpp>

namespace thalweg::pipeline {

Rows<TokunagaRecipe> tokunaga_keys() {
    using network::SideRule;
    Use const grown = source_is("tokunaga");
    Use const strokes = grown && given("network.tokunaga.strokes");
    Use const no_strokes = grown && not_given("network.tokunaga.strokes");
    return {
        number("generator", &TokunagaRecipe::generator)
            .range({1, 50})
            .used(grown)
            .means("lambda of the tree, and of strokes without their own: 1 has no side branches, 2 is dendritic, "
                   "larger values are feathered"),
        number("order", &TokunagaRecipe::order)
            .range({1, 12})
            .used(grown)
            .means("Strahler order at the outlet; with strokes, that of one as long as the grid is wide"),
        choice("rule", &TokunagaRecipe::rule)
            .one_of({{"tokunaga", SideRule::tokunaga}, {"constant", SideRule::constant}, {"plane", SideRule::plane}})
            .used(no_strokes)
            .means("number of side branches of a link: by its order, constant as published, or such that the fractal "
                   "dimension is 2"),
        choice("mouth", &TokunagaRecipe::mouth)
            .one_of({{"north", Side::north}, {"east", Side::east}, {"south", Side::south}, {"west", Side::west}})
            .used(no_strokes)
            .means("side of the grid or region where the river leaves"),
        file("region", &TokunagaRecipe::region).used(grown).means("polygon that the network fills; \"\": the grid"),
        file("strokes", &TokunagaRecipe::strokes)
            .used(grown)
            .means("lines drawn from outlet to source, each of which grows a network; \"\": one network in the region"),
        text("layer", &TokunagaRecipe::layer)
            .form("name")
            .used(strokes)
            .means("layer of the strokes; \"\": the only line layer"),
        number("spacing", &TokunagaRecipe::spacing_cells)
            .unit("cells")
            .range({0, 1e6})
            .used(grown)
            .means("minimum distance between links; closer ones are left out"),
    };
}

} // namespace thalweg::pipeline
