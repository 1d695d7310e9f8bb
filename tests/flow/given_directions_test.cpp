// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/flow/given_directions.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <measure/dems.hpp>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/condition.hpp>
#include <thalweg/flow/extract_streams.hpp>

namespace given_directions_test {

using namespace thalweg;
using flow::Direction;
using flow::DirectionCodes;
using flow::FlowField;

namespace {

Raster<std::int32_t> codes_in(std::int64_t width, std::vector<std::int32_t> const& codes) {
    Raster<std::int32_t> raster(frame(width, static_cast<std::int64_t>(codes.size()) / width));
    std::ranges::copy(codes, raster.values().begin());
    return raster;
}

/// Whether water of a cell flows through another, by following it.
bool drains_through(FlowField const& drainage, std::int64_t from, std::int64_t mouth) {
    std::int64_t at = from;
    while (at >= 0 && at != mouth) {
        at = drainage.receiver(at);
    }
    return at == mouth;
}

std::string message_of(auto const& call) {
    try {
        call();
    } catch (Error const& error) {
        return error.what();
    }
    return "nothing thrown";
}

} // namespace

TEST(GivenDirections, CodesOfEveryProgramComeBack) {
    ASSERT_TRUE(rc::check("directions in codes and back", [] {
        FlowField const drainage = flow::route(*gen_dem(9, 20));
        for (auto const of : {DirectionCodes::thalweg, DirectionCodes::esri, DirectionCodes::grass,
                              DirectionCodes::pcraster, DirectionCodes::whitebox}) {
            Raster<Direction> const back = flow::directions_of(flow::codes_of(drainage.direction, of), of);
            RC_ASSERT(std::ranges::equal(back.values(), drainage.direction.values()));
        }
        for (auto const of : {DirectionCodes::saga, DirectionCodes::taudem}) { // they cannot say that water ends
            Raster<Direction> const back = flow::directions_of(flow::codes_of(drainage.direction, of), of);
            for (std::int64_t i = 0; i < back.cells(); ++i) {
                bool const is_last = drainage.receiver(i) >= 0 && drainage.receiver(drainage.receiver(i)) < 0;
                if (flow::goes_on(drainage.direction[i])) {
                    Direction const wanted = is_last ? Direction::leaves : drainage.direction[i];
                    RC_ASSERT(back[i] == wanted);
                }
            }
        }
    }));
}

TEST(GivenDirections, TheEightNeighboursByTheManualsOfThePrograms) {
    // North-west, north, ... in reading order around a middle cell: each row points from the middle to one of these.
    struct Manual {
        DirectionCodes of;
        std::vector<std::int32_t> around; // NW, N, NE, W, E, SW, S, SE
    };
    std::vector<Manual> const manuals = {{DirectionCodes::esri, {32, 64, 128, 16, 1, 8, 4, 2}},
                                         {DirectionCodes::grass, {3, 2, 1, 4, 8, 5, 6, 7}},
                                         {DirectionCodes::pcraster, {7, 8, 9, 4, 6, 1, 2, 3}},
                                         {DirectionCodes::saga, {7, 0, 1, 6, 2, 5, 4, 3}},
                                         {DirectionCodes::taudem, {4, 3, 2, 5, 1, 6, 7, 8}},
                                         {DirectionCodes::whitebox, {64, 128, 1, 32, 2, 16, 8, 4}}};
    std::vector<std::int64_t> const neighbour = {0, 1, 2, 3, 5, 6, 7, 8};
    for (Manual const& manual : manuals) {
        for (std::size_t k = 0; k < neighbour.size(); ++k) {
            // Cells around point outwards: of a 3 x 3 grid all leave.
            std::vector<std::int32_t> codes(9);
            for (std::size_t n = 0; n < neighbour.size(); ++n) {
                codes[static_cast<std::size_t>(neighbour[n])] = manual.around[n];
            }
            codes[4] = manual.around[k];
            Raster<Direction> const direction = flow::directions_of(codes_in(3, codes), manual.of);
            EXPECT_EQ(flow::receiver(direction, 4), neighbour[k]) << static_cast<int>(manual.of) << " " << k;
            for (std::int64_t const n : neighbour) {
                EXPECT_EQ(direction[n], Direction::leaves);
            }
        }
    }
}

TEST(GivenDirections, WhatIsNoDirectionIsRefusedByName) {
    EXPECT_NE(message_of([] {
                  flow::directions_of(codes_in(2, {1, 4, 16, 3}), DirectionCodes::esri);
              }).find("3 at column 1, row 1 is no direction; the codes are 1, 2, 4, 8, 16, 32, 64, 128"),
              std::string::npos);
    // GRASS: below 0 water leaves; the least int is no data.
    Raster<Direction> const grass =
        flow::directions_of(codes_in(3, {8, -4, std::numeric_limits<std::int32_t>::min()}), DirectionCodes::grass);
    EXPECT_EQ(grass[0], Direction::east);
    EXPECT_EQ(grass[1], Direction::leaves);
    EXPECT_EQ(grass[2], Direction::no_data);
}

TEST(GivenDirections, FollowedTheyHaveTheAreasOfTheDem) {
    ASSERT_TRUE(rc::check("areas of followed directions are those of route", [] {
        FlowField const drainage = flow::route(*gen_dem(12, 15));
        FlowField const followed = flow::follow(drainage.direction);
        RC_ASSERT(std::ranges::equal(followed.area_cells.values(), drainage.area_cells.values()));
    }));
    Raster<Direction> circle(frame(2, 1), Direction::east);
    circle[1] = Direction::west;
    EXPECT_NE(message_of([&] { flow::follow(circle); }).find("water of 2 cells runs in a circle"), std::string::npos);
    EXPECT_THROW(flow::follow(Raster<Direction>(frame(2, 1), Direction::east)), BadInput);
}

TEST(GivenDirections, AmountsAddUpAlongTheWater) {
    ASSERT_TRUE(rc::check("sums are those of the cells that drain through", [] {
        FlowField const drainage = flow::route(*gen_dem(8, 15));
        Raster<double> amounts(drainage.grid());
        for (double& one : amounts.values()) {
            one = static_cast<double>(*evenly(-5, 20));
        }
        Raster<double> const sums = flow::accumulate(drainage, amounts);
        for (std::int64_t i = 0; i < sums.cells(); ++i) {
            double expected = 0.0;
            for (std::int64_t j = 0; j < sums.cells(); ++j) {
                expected +=
                    drainage.direction[j] != Direction::no_data && drains_through(drainage, j, i) ? amounts[j] : 0.0;
            }
            bool const is_right =
                drainage.direction[i] == Direction::no_data ? std::isnan(sums[i]) : sums[i] == expected;
            RC_ASSERT(is_right);
        }
    }));
    FlowField const drainage = flow::route(dem_of(2, {2, 1}));
    Raster<double> amounts(drainage.grid(), 1.0);
    amounts[1] = hole;
    EXPECT_NE(message_of([&] { flow::accumulate(drainage, amounts); }).find("at column 1, row 0 is nan"),
              std::string::npos);
    EXPECT_THROW(flow::accumulate(drainage, Raster<double>(frame(1, 2))), BadInput);
}

TEST(GivenDirections, ACatchmentIsWhatDrainsThroughItsOutlet) {
    ASSERT_TRUE(rc::check("catchments by following every path", [] {
        FlowField const drainage = flow::route(*gen_dem(9, 15));
        Grid const& grid = drainage.grid();
        std::int64_t const mouth = *evenly<std::int64_t>(0, grid.cells());
        RC_PRE(drainage.direction[mouth] != Direction::no_data);
        Mask const found = flow::catchment(drainage, grid.centre(grid.at(mouth)));
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            bool const is_inside = found[i] == 1;
            RC_ASSERT(is_inside == drains_through(drainage, i, mouth));
        }
    }));
    // The outlet moves to the stream beside it.
    FlowField const drainage = flow::route(dem_of(3, {9, 2, 9, 9, 1, 9, 9, 0, 9}));
    Grid const& grid = drainage.grid();
    Vec2 const beside = grid.centre({0, 1});
    auto const cells = [&](double snap_m) {
        Mask const mask = flow::catchment(drainage, beside, {.snap_m = snap_m});
        return std::ranges::count(mask.values(), 1);
    };
    EXPECT_EQ(cells(0.0), 1);
    EXPECT_EQ(cells(grid.cell_m), drainage.area_cells[grid.index({1, 1})]);
    EXPECT_EQ(cells(1.5 * grid.cell_m), drainage.area_cells[grid.index({1, 2})]);
    EXPECT_THROW(flow::catchment(drainage, {-1e9, 0.0}), BadInput);
    EXPECT_THROW(flow::catchment(drainage, beside, {.snap_m = -1.0}), BadParameter);
}

TEST(GivenDirections, APathGoesDownToTheEnd) {
    ASSERT_TRUE(rc::check("paths follow the receivers", [] {
        FlowField const drainage = flow::route(*gen_dem(9, 15));
        Grid const& grid = drainage.grid();
        std::int64_t const start = *evenly<std::int64_t>(0, grid.cells());
        RC_PRE(drainage.direction[start] != Direction::no_data);
        auto const path = flow::path_down(drainage, grid.centre(grid.at(start)));
        RC_ASSERT(path.front() == start);
        for (std::size_t i = 0; i < path.size(); ++i) {
            std::int64_t const next = i + 1 < path.size() ? path[i + 1] : -1;
            RC_ASSERT(drainage.receiver(path[i]) == next);
        }
    }));
}

TEST(FillDepressions, RaisesToTheSpillLevelAndDrains) {
    ASSERT_TRUE(rc::check("filled DEMs have no depressions", [] {
        Raster<float> const dem = *gen_dem(10, 15);
        Raster<float> const level = flow::fill_depressions(dem, {.level = true});
        FlowField const drainage = flow::route(dem);
        // The spill level is the least over all ways out of the highest height on the way.
        Raster<float> slow = dem;
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            if (!std::isnan(dem[i])) {
                for (std::int64_t at = i; at >= 0; at = drainage.receiver(at)) {
                    slow[i] = std::max(slow[i], dem[at]);
                }
                bool const is_between = level[i] >= dem[i] && level[i] <= slow[i];
                RC_ASSERT(is_between);
            } else {
                RC_ASSERT(std::isnan(level[i]));
            }
        }
        RC_ASSERT(flow::route(level).pits == 0);
        Raster<float> const sloping = flow::fill_depressions(dem);
        RC_ASSERT(flow::route(sloping).pits == 0);
        for (std::int64_t i = 0; i < dem.cells(); ++i) {
            bool const is_near = std::isnan(dem[i]) || (sloping[i] >= level[i] && sloping[i] < level[i] + 0.1F);
            RC_ASSERT(is_near);
        }
    }));
}

TEST(BreachDepressions, DrainsAndMovesNoMoreThanFilling) {
    ASSERT_TRUE(rc::check("breached DEMs drain", [] {
        Raster<float> const dem = *gen_dem(10, 15);
        Raster<float> const breached = flow::breach_depressions(dem);
        RC_ASSERT(flow::route(breached).pits == 0);
        RC_ASSERT(flow::change_between(dem, breached).volume_m3() <=
                  flow::change_between(dem, flow::fill_depressions(dem)).volume_m3() * (1.0 + 1e-9));
    }));
}

TEST(ExtractStreams, SupportInSquareKilometres) {
    Raster<float> dem(frame(40, 40));
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        Cell const c = dem.grid().at(i);
        dem[i] = static_cast<float>(c.row + std::abs(c.col - 20));
    }
    FlowField const drainage = flow::route(dem);
    double const cell_km2 = dem.grid().cell_m * dem.grid().cell_m * 1e-6;
    EXPECT_EQ(flow::support_for_area(drainage, 25.0 * cell_km2), 25);
    EXPECT_EQ(flow::support_for_area(drainage, 25.5 * cell_km2), 26);
    EXPECT_EQ(flow::support_for_area(drainage, 1e-30), 1);
    EXPECT_THROW(flow::support_for_area(drainage, 0.0), BadParameter);
    auto const by_cells = flow::extract_streams(drainage, dem, {.support_cells = 25});
    auto const by_area = flow::extract_streams(drainage, dem, {.support_km2 = 25.0 * cell_km2});
    EXPECT_EQ(by_cells.network.planform.length_m(), by_area.network.planform.length_m());
    Raster<float> const elsewhere(Grid{40, 40, dem.grid().cell_m, 5.0, 0.0, ""}, 1.0F);
    EXPECT_NE(message_of([&] { flow::extract_streams(drainage, elsewhere); }).find("of equal sizes"),
              std::string::npos);
    EXPECT_THROW(flow::change_between(dem, dem_of(1, {1, 2})), BadInput);
}

} // namespace given_directions_test
