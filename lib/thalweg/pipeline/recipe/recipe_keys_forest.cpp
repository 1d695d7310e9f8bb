// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/key_kinds.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_sections.hpp>

namespace thalweg::pipeline {

void add_forest_keys(std::vector<Key>& keys) {
    keys.push_back(
        choice<LandShape>("network.forest.shape", {{"grid", LandShape::grid}, {"island", LandShape::island}},
                          "extent of the land where no region is given: the whole grid, or an island in it",
                          in_network<LandShape>([](NetworkRecipe& n) -> LandShape& { return n.forest.shape; })));
    keys.push_back(number("network.forest.ruggedness", "", {0, 1}, "how far fjords and capes of the island reach",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.forest.ruggedness; })));
    keys.push_back(file("network.forest.region", "polygons that are land, with sea around them; \"\": see shape",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.forest.region; })));
    keys.push_back(file("network.forest.outlets",
                        "where rivers reach the coast: points, lines along the coast, or polygons of water; \"\": "
                        "anywhere on the coast",
                        in_network<std::string>([](NetworkRecipe& n) -> std::string& { return n.forest.outlets; })));
    keys.push_back(integer<std::int64_t>(
        "network.forest.seeds", "", {0, 1e6},
        "number of outlets at random places on the coast; 0: one for every six spacings of coast",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.forest.seeds; })));
    keys.push_back(integer<std::int64_t>(
        "network.forest.spacing", "cells", {8, 200}, "minimum distance between rivers that do not meet",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.forest.spacing_cells; })));
    keys.push_back(integer<std::int64_t>(
        "network.forest.particles", "", {0, 1e9}, "number of particles of all trees; 0: until the land is full",
        in_network<std::int64_t>([](NetworkRecipe& n) -> std::int64_t& { return n.forest.growth.particles; })));
    keys.push_back(number("network.forest.sticking", "", {0, 1, true}, "sticking probability",
                          in_network<double>([](NetworkRecipe& n) -> double& { return n.forest.growth.sticking; })));
    keys.push_back(integer<int>("network.forest.visits", "", {1, 255},
                                "noise-reduction count M: arrivals that a cell needs before it is occupied; larger "
                                "values make straighter rivers",
                                in_network<int>([](NetworkRecipe& n) -> int& { return n.forest.growth.visits; })));
}

} // namespace thalweg::pipeline
