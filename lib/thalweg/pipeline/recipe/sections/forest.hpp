// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/network/growth/forest/grow_forest.hpp>

namespace thalweg::pipeline {

/// The land of a forest that no region is given for.
enum class LandShape : std::uint8_t { grid, island };

/// Rivers that grow inland from a coast or border until the land is full of them.
struct ForestRecipe {
    LandShape shape = LandShape::grid;
    double ruggedness = 0.5; ///< [0, 1] of an island's coast
    std::string region;      ///< polygons that are land; "": the shape
    std::string outlets;     ///< points; or lines or polygons along whose coast outlets lie; "": all of it
    std::int64_t seeds = 0;  ///< [0, ...] outlets; 0: by their spacing
    std::int64_t outlet_spacing_cells = 0; ///< [0, ...] along the coast or border; 0: six times that of rivers
    std::int64_t spacing_cells = 10;       ///< [8, 200] between rivers that do not meet
    network::ForestParams growth;          ///< its step and seed follow from the recipe
};

} // namespace thalweg::pipeline
