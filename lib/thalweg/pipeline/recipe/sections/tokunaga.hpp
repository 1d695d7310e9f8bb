// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>

namespace thalweg::pipeline {

enum class Side : std::uint8_t { north, east, south, west };

/// The keys of section [tokunaga] of a recipe.
struct TokunagaRecipe {
    int generator = 2; ///< [1, 50] lambda, also of strokes without their own
    int order = 6;     ///< [1, 12] Strahler order at the mouth; strokes: MaxDepth, that of one as long as the grid
    network::SideRule rule = network::SideRule::tokunaga;
    Side mouth = Side::south;   ///< of the grid, in the middle of which the river leaves
    std::string region;         ///< polygon the network fills; "": the grid
    std::string strokes;        ///< directed lines, each of which grows a network; "" grows one in the region
    std::string layer;          ///< of the strokes' file; "" takes the only line layer
    double spacing_cells = 3.0; ///< [cells] >= 0: links closer than this to others are left out
};

} // namespace thalweg::pipeline
