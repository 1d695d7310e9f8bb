// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/cells.hpp>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

namespace nearest_cells_test {

namespace {

using namespace thalweg;
using test::frame_below;
using test::on_threads;

} // namespace

TEST(NearestCells, OneMarkedCell) {
    Mask marked(frame_below(4, 3, 10.0));
    marked[Cell{1, 2}] = 1;
    Raster<std::int64_t> const found = nearest_cells(marked, {});
    for (std::int64_t const nearest : found.values()) {
        EXPECT_EQ(nearest, 9);
    }
}

TEST(NearestCells, AreThoseOfASearchOverAll) {
    ASSERT_TRUE(rc::check("least squared distance, of equals the lowest index; for any number of threads", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(1, 30);
        auto const height = *rc::gen::inRange<std::int64_t>(1, 30);
        Grid const grid = frame_below(width, height, 10.0);
        auto const cells =
            *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, grid.cells()));
        RC_PRE(!cells.empty());
        Mask marked(grid);
        for (std::int64_t const cell : cells) {
            marked[cell] = 1;
        }
        thalweg::Run const run = on_threads(*rc::gen::inRange(1, 4));
        Raster<std::int64_t> const found = nearest_cells(marked, run);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            std::int64_t best = -1;
            for (std::int64_t k = 0; k < grid.cells(); ++k) {
                bool const nearer =
                    best < 0 || squared_cells(grid.at(i), grid.at(k)) < squared_cells(grid.at(i), grid.at(best));
                best = marked[k] != 0 && nearer ? k : best;
            }
            RC_ASSERT(found[i] == best);
        }
    }));
}

} // namespace nearest_cells_test
