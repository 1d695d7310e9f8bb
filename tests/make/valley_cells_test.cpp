// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/make/valley_cells.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <support.hpp>

namespace {

using namespace thalweg;
using namespace thalweg::make;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// Law: cells set in any order are those of a raster in which each was set in turn.
RC_GTEST_PROP(ValleyCells, AreARasterOfWhichFewCellsAreSet, ()) {
    Grid const grid = test::frame(9, 7);
    Valley valley{Raster<float>(grid, none)};
    std::vector<std::pair<CellIndex, float>> set;
    for (int k = *rc::gen::inRange(0, 40); k > 0; --k) {
        auto const cell = *rc::gen::inRange<CellIndex>(0, grid.cells());
        float const z = *rc::gen::inRange(0, 5) == 0 ? none : static_cast<float>(k) - 20.5F;
        set.emplace_back(cell, z);
        valley.z[cell] = z;
    }
    ValleyCells const cells = valley_cells(grid, set);
    RC_ASSERT(test::same_bits(cells.raster(), valley.z));
    RC_ASSERT(valley_cells(valley).cell == cells.cell);
    RC_ASSERT(valley_cells(valley).z == cells.z);
    for (CellIndex i = 0; i < grid.cells(); ++i) {
        float const z = height_in(cells, i);
        RC_ASSERT(has_river(cells, i) == !std::isnan(valley.z[i]));
        RC_ASSERT(z == valley.z[i] || (std::isnan(z) && std::isnan(valley.z[i])));
    }
}

} // namespace
