// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/cells.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace cells_along_test {

using namespace thalweg;

namespace {

using test::has;
using test::message_of;

Grid const grid = {20, 12, 10.0, 500.0, 220.0, ""};

} // namespace

TEST(CellsAlong, NothingAndOneVertex) {
    EXPECT_TRUE(cells_along({}, grid).empty());
    EXPECT_EQ(cells_along({{505.0, 215.0}}, grid), (std::vector<Cell>{{0, 0}}));
    EXPECT_EQ(cells_along({{505.0, 215.0}, {507.0, 213.0}}, grid), (std::vector<Cell>{{0, 0}}));
}

TEST(CellsAlong, RefusesWhatLiesOutside) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (Vec2 const p :
         {Vec2{499.0, 215.0}, Vec2{700.001, 215.0}, Vec2{505.0, 99.999}, Vec2{1e300, 215.0}, Vec2{nan, 215.0}}) {
        EXPECT_TRUE(has(message_of<BadInput>([&] { cells_along({{505.0, 215.0}, p}, grid); }), "vertex 1")) << p.x;
    }
}

TEST(CellsAlong, OuterEdgesBelongToTheOutermostCells) {
    EXPECT_EQ(cells_along({{700.0, 100.0}}, grid), (std::vector<Cell>{{19, 11}}));
}

TEST(CellsAlong, KnightsMove) {
    EXPECT_EQ(cells_along({{505.0, 215.0}, {535.0, 205.0}}, grid), (std::vector<Cell>{{0, 0}, {1, 0}, {2, 1}, {3, 1}}));
}

TEST(CellsAlong, LawsOfTheLine) {
    ASSERT_TRUE(rc::check("8-connected, no cell twice in a row, within half a cell of the segment", [] {
        // Evenly: rapidcheck's own range keeps to small numbers.
        auto const any = rc::gen::resize(rc::kNominalSize, rc::gen::exec([] {
                                             return Cell{*rc::gen::inRange<std::int64_t>(0, grid.width),
                                                         *rc::gen::inRange<std::int64_t>(0, grid.height)};
                                         }));
        Cell const a = *any;
        Cell const b = *any;
        auto const cells = cells_along({grid.centre(a), grid.centre(b)}, grid);
        RC_ASSERT((cells.front() == a && cells.back() == b));
        std::int64_t const across = std::abs(b.col - a.col);
        std::int64_t const down = std::abs(b.row - a.row);
        RC_ASSERT(static_cast<std::int64_t>(cells.size()) == std::max(across, down) + 1);
        for (std::size_t i = 1; i < cells.size(); ++i) {
            Cell const step{cells[i].col - cells[i - 1].col, cells[i].row - cells[i - 1].row};
            RC_ASSERT((std::abs(step.col) <= 1 && std::abs(step.row) <= 1 && !(step == Cell{0, 0})));
            // Off the ideal line, across the longer axis, by at most half a cell.
            std::int64_t const off =
                (cells[i].col - a.col) * (b.row - a.row) - (cells[i].row - a.row) * (b.col - a.col);
            RC_ASSERT(2 * std::abs(off) <= std::max(across, down));
        }
    }));
}

} // namespace cells_along_test
