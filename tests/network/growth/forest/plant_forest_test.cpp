// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/forest/grow_forest.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <network/growth_params.hpp>
#include <network/masks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/growth/forest/coast.hpp>
#include <thalweg/network/order/order.hpp>

namespace plant_forest_test {

using namespace thalweg;
using namespace thalweg::network;
using test::frame;
using test::growth;
using test::random_blob;

namespace {

using test::count;
using test::full_message_of;
using test::on_threads;

/// By cell the basin of the river that runs there, 0 for none.
Raster<std::int64_t> basins(StreamNetwork const& network, Grid const& grid) {
    Raster<std::int64_t> basin(grid, 0);
    for (std::size_t a = 0; a < network.arc_count(); ++a) {
        for (Cell const c : cells_along(network.arc(a).line, grid)) {
            basin[c] = network.basin(network.to(a));
        }
    }
    return basin;
}

} // namespace

TEST(PlantForest, refuses_what_leaves_no_room) {
    EXPECT_THROW(plant_forest(Mask(frame(40, 40), 0), {}), BadInput);
    EXPECT_THROW(plant_forest(Mask(frame(5, 5), 1), {{0, 0}}), BadInput);
    Mask const land(frame(40, 40), 1);
    EXPECT_THROW(plant_forest(land, {{20, 20}}), BadInput);
    EXPECT_THROW(plant_forest(land, {{40, 20}}), BadInput);
    EXPECT_THROW(plant_forest(land, {{0, 20}}, growth(3, 7)), BadParameter);
    EXPECT_THROW(plant_forest(land, {{0, 20}}, growth(101, 7)), BadParameter);
    EXPECT_EQ(full_message_of<BadInput>([&] {
                  plant_forest(land, {{20, 20}});
              }),
              "network.plant_forest: the outlet (20, 20) lies off the land's coast");
}

TEST(PlantForest, land_without_outlets_gets_one_and_says_so) {
    PlantedForest const f = plant_forest(Mask(frame(60, 60), 1), {});
    EXPECT_EQ(f.outlets, 1);
    EXPECT_EQ(count(f.notes, "added_outlet"), 1);
    EXPECT_EQ(f.stop, ForestStop::full);
}

TEST(PlantForest, outlets_too_near_to_one_another_are_left_out) {
    PlantedForest const f = plant_forest(Mask(frame(80, 60), 1), {{0, 30}, {0, 32}, {79, 30}, {79, 30}});
    EXPECT_EQ(f.outlets, 2);
    EXPECT_EQ(count(f.notes, "crowded_outlet"), 2);
}

TEST(PlantForest, islands_get_an_outlet_or_a_note) {
    Mask land(frame(200, 80), 0);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        Cell const c = land.grid().at(i);
        bool const wide = c.row > 2 && c.row < 77 && ((c.col > 2 && c.col < 90) || (c.col > 92 && c.col < 180));
        land[i] = wide || (c.col > 185 && c.col < 190 && c.row > 20 && c.row < 25) ? 1 : 0;
    }
    PlantedForest const f = plant_forest(land, {{3, 40}});
    EXPECT_EQ(f.outlets, 2);
    EXPECT_EQ(count(f.notes, "added_outlet"), 1);
    ASSERT_EQ(count(f.notes, "dry_land"), 1);
    EXPECT_EQ(f.notes.back().amount, 16.0);
}

// Laws: one tree an outlet, on its cell of the coast; rivers run on land, those of two trees with two cells between
// them; every island has an outlet or a note.
TEST(PlantForest, laws_of_a_planted_forest) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const step = *rc::gen::inRange<std::int64_t>(4, 9);
        Mask const land = random_blob(seed, *rc::gen::inRange(40, 160), *rc::gen::inRange(40, 160),
                                      *rc::gen::inRange(1, 9), *rc::gen::inRange(14, 50));
        std::vector<Cell> const coast = coast_cells(land);
        std::vector<Cell> const outlets = spread_outlets(land, coast, {*rc::gen::inRange(1, 30), 60.0, seed});
        PlantedForest f;
        try {
            f = plant_forest(land, outlets, growth(step, seed));
        } catch (BadInput const&) {
            RC_DISCARD("no room");
        }
        Grid const& grid = land.grid();
        RC_ASSERT(static_cast<std::int64_t>(f.network.outlets().size()) == f.outlets);
        for (NodeId const n : f.network.outlets()) {
            Cell const c = grid.cell_of(f.network.node(n).at);
            RC_ASSERT(f.network.node(n).at == grid.centre(c));
            RC_ASSERT(std::ranges::find(coast, c) != coast.end());
        }
        Raster<std::int64_t> const basin = basins(f.network, grid);
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            if (basin[i] == 0) {
                continue;
            }
            RC_ASSERT(land[i] != 0);
            Cell const c = grid.at(i);
            for (std::int64_t row = c.row - 2; row <= c.row + 2; ++row) {
                for (std::int64_t col = c.col - 2; col <= c.col + 2; ++col) {
                    RC_ASSERT((!grid.contains({col, row}) || basin[Cell{col, row}] == 0 ||
                               basin[Cell{col, row}] == basin[i]));
                }
            }
        }
        RC_ASSERT(test::components(land, 1, 4) <= f.outlets + count(f.notes, "dry_land"));
    }));
}

// Law: what comes out passes every check of a network, with many outlets.
TEST(PlantForest, networks_pass_every_check) {
    for (std::uint64_t const seed : {1U, 2U, 3U}) {
        Grid const grid = frame(400, 300);
        Mask const land = shape_island(grid, {0.7, seed});
        PlantedForest const f = plant_forest(land, spread_outlets(land, coast_cells(land), {}), growth(5, seed));
        EXPECT_GT(f.outlets, 10);
        ElevatedNetwork const raised = set_heights(f.network).network;
        measure::TopologyReport const report = measure::check_topology(measure::as_file(raised, order(raised.plan)));
        for (Check const& check : report.checks) {
            EXPECT_TRUE(check.ok) << check.name << " " << check.value;
        }
    }
}

// Law: no field of Run changes a result.
TEST(PlantForest, same_network_for_any_number_of_threads) {
    Mask const land = shape_island(frame(220, 200), {0.5, 4});
    std::vector<Cell> const outlets = spread_outlets(land, coast_cells(land), {});
    thalweg::Run const one = on_threads(1);
    PlantedForest const a = plant_forest(land, outlets, growth(5, 7), one);
    PlantedForest const b = plant_forest(land, outlets, growth(5, 7));
    ASSERT_EQ(a.network.arc_count(), b.network.arc_count());
    for (std::size_t k = 0; k < a.network.arc_count(); ++k) {
        EXPECT_EQ(a.network.arc(k).line, b.network.arc(k).line);
    }
}

} // namespace plant_forest_test
