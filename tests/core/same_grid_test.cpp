// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/same_grid.hpp>

#include <string>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>

namespace same_grid_test {

using namespace thalweg;

TEST(SameGrid, TheFirstDifferenceIsNamed) {
    Grid const grid{20, 10, 30.0, 500000.0, 4000000.0, "EPSG:32631"};
    auto const said = [&](Grid const& other) -> std::string {
        try {
            require_same_grid(grid, other, "flow.route_dinf", "the DEM and its directions", "route this DEM");
        } catch (BadInput const& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(said(grid), "");
    Grid other = grid;
    other.height = 11;
    EXPECT_EQ(said(other), "the DEM and its directions have different grids: 20 x 10 cells and 20 x 11; "
                           "route this DEM");
    other = grid;
    other.cell_m = 30.5;
    EXPECT_NE(said(other).find("cells of 30 and 30.5 m"), std::string::npos);
    other = grid;
    other.west = 500030.0;
    EXPECT_NE(said(other).find("of equal sizes, with north-western corners at (500000, 4000000) and (500030, 4000000)"),
              std::string::npos);
    other = grid;
    other.crs = "";
    EXPECT_NE(said(other).find("of equal sizes, in EPSG:32631 and no CRS"), std::string::npos);
}

} // namespace same_grid_test
