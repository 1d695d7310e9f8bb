// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/key_kinds.hpp>
#include <thalweg/pipeline/recipe_sections.hpp>

namespace thalweg::pipeline {

void add_forest_keys(std::vector<Key>& keys) {
    keys.push_back(
        choice<LandShape>("network.forest.shape", {{"grid", LandShape::grid}, {"island", LandShape::island}},
                          "the land, where no region is given: all of the grid, or an island in it",
                          in_network<LandShape>([](NetworkRecipe& n) -> LandShape& { return n.forest.shape; })));
    keys.push_back(number("network.forest.ruggedness", "", {0, 1}, "how far fjords and capes of an island reach",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.forest.ruggedness; })));
    keys.push_back(text("network.forest.region", "file name",
                        "polygons that are land, the rest is sea; \"\": the shape",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.forest.region; })));
    keys.push_back(text("network.forest.outlets", "file name",
                        "points; lines, along which the coast has outlets; or polygons of water that outlets lie on; "
                        "\"\": all of the coast has some",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.forest.outlets; })));
    keys.push_back(integer<std::int64_t>(
        "network.forest.seeds", "", {0, 1e6},
        "outlets, spread along the coast by chance; 0: one for every six spacings of it",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.forest.seeds; })));
    keys.push_back(integer<std::int64_t>(
        "network.forest.spacing", "cells", {8, 200}, "rivers that do not meet keep this distance",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.forest.spacing_cells; })));
    keys.push_back(integer<std::int64_t>(
        "network.forest.particles", "", {0, 1e9}, "of all trees; 0: until the land is full",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.forest.growth.particles; })));
    keys.push_back(number("network.forest.sticking", "", {0, 1, true}, "chance with which an arrival holds",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.forest.growth.sticking; })));
    keys.push_back(integer<int>("network.forest.visits", "", {1, 255},
                                "arrivals a cell needs before it may hold: more make straighter rivers",
                                in_network<int>([](NetworkRecipe& n) -> int& { return n.forest.growth.visits; })));
}

} // namespace thalweg::pipeline
