// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/cells.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace cells_test {

using namespace thalweg;

namespace {

using test::frame_below;
using test::has;
using test::message_of;
using test::on_threads;

Grid const grid = {20, 12, 10.0, 500.0, 220.0, ""};

} // namespace

TEST(CellsAlong, NothingAndOneVertex) {
    EXPECT_TRUE(cells_along({}, grid).empty());
    EXPECT_EQ(cells_along({{505.0, 215.0}}, grid), (std::vector<Cell>{{0, 0}}));
    EXPECT_EQ(cells_along({{505.0, 215.0}, {507.0, 213.0}}, grid), (std::vector<Cell>{{0, 0}}));
}

TEST(CellsAlong, RefusesWhatLiesOutside) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (Vec2 const p : {Vec2{499.0, 215.0}, Vec2{700.001, 215.0}, Vec2{505.0, 99.999}, Vec2{505.0, 220.001},
                         Vec2{1e300, 215.0}, Vec2{nan, 215.0}}) {
        EXPECT_TRUE(has(message_of<BadInput>([&] { cells_along({{505.0, 215.0}, p}, grid); }), "vertex 1")) << p.x;
    }
}

TEST(CellsAlong, OuterEdgesBelongToTheOutermostCells) {
    EXPECT_EQ(cells_along({{700.0, 100.0}}, grid), (std::vector<Cell>{{19, 11}}));
}

TEST(Grid, CellsOfPlacesOnTheOuterEdge) {
    for (auto const& [p, cell] : std::vector<std::pair<Vec2, Cell>>{{{500, 220}, {0, 0}},
                                                                    {{700, 220}, {19, 0}},
                                                                    {{500, 100}, {0, 11}},
                                                                    {{700, 100}, {19, 11}},
                                                                    {{600, 100}, {10, 11}},
                                                                    {{700, 160}, {19, 6}},
                                                                    {{690, 110}, {19, 11}}}) {
        EXPECT_EQ(grid.cell_of(p), cell) << p.x << " " << p.y;
    }
    for (Vec2 const outside : {Vec2{700.001, 150}, Vec2{499.999, 150}, Vec2{600, 99.999}, Vec2{600, 220.001}}) {
        EXPECT_FALSE(grid.contains(grid.cell_of(outside))) << outside.x << " " << outside.y;
    }
    ASSERT_TRUE(rc::check("a place on a border lies in a cell, whatever is rounded", [] {
        Grid any = grid;
        any.cell_m = 0.001 * *rc::gen::inRange(1, 100000);
        any.west = 1e-3 * *rc::gen::inRange(-1000000000, 1000000000);
        any.north = 1e-3 * *rc::gen::inRange(-1000000000, 1000000000);
        any.width = *rc::gen::inRange(1, 3000);
        any.height = *rc::gen::inRange(1, 3000);
        for (Vec2 const p : {Vec2{any.west, any.north}, Vec2{any.east(), any.south()}}) {
            RC_ASSERT(any.contains(any.cell_of(p)));
        }
    }));
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

} // namespace cells_test
