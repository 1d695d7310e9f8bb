// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/forest/grow_forest.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <growth/chi_squared.hpp>
#include <growth/growth_params.hpp>
#include <growth/plain_forest.hpp>
#include <gtest/gtest.h>
#include <network/networks.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/growth/forest/coast.hpp>
#include <thalweg/measure/topology/topology.hpp>
#include <thalweg/network/elevation/set_heights.hpp>
#include <thalweg/network/order/order.hpp>

namespace grow_forest_test {

using namespace thalweg;
using namespace thalweg::growth;
using test::forest_params;
using test::frame;
using test::mask_of;
using test::random_blob;

namespace {

using test::count;
using test::on_threads;

/// Some cells of a region that lie two steps apart, at least one.
std::vector<Cell> random_seeds(Mask const& region, std::int64_t step, std::size_t most, std::uint64_t seed) {
    std::vector<Cell> seeds;
    RandomStream words(seed, 77, 0);
    for (int tries = 0; tries < 4000 && seeds.size() < most; ++tries) {
        Cell const c =
            region.grid().at(static_cast<std::int64_t>(words.word() % static_cast<std::uint64_t>(region.cells())));
        bool const alone =
            std::ranges::all_of(seeds, [&](Cell s) { return plain_forest::squared_distance(s, c) >= 4 * step * step; });
        if (region[c] != 0 && alone) {
            seeds.push_back(c);
        }
    }
    return seeds;
}

/// Particles, leaves and box of a forest.
using Shape = std::array<std::int64_t, 4>;

Shape shape(GrownForest const& forest) {
    std::vector<int> children(forest.cells.size(), 0);
    for (std::int64_t const up : forest.parent) {
        if (up >= 0) {
            ++children[static_cast<std::size_t>(up)];
        }
    }
    auto const [west, east] = std::ranges::minmax(forest.cells, {}, &Cell::col);
    auto const [north, south] = std::ranges::minmax(forest.cells, {}, &Cell::row);
    return {static_cast<std::int64_t>(forest.cells.size()), std::ranges::count(children, 0), (east.col - west.col) / 4,
            (south.row - north.row) / 4};
}

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

TEST(GrowForest, refuses_parameters_and_seeds) {
    Mask const land = mask_of({"####", "####", "..##"});
    ForestParams negative;
    negative.particles = -1;
    for (ForestParams const& wrong :
         {forest_params(1, 7, 0.0), forest_params(1, 7, 1.0000001),
          forest_params(1, 7, std::numeric_limits<double>::quiet_NaN()), forest_params(0, 7), forest_params(101, 7),
          forest_params(1, 7, 1.0, 0), forest_params(1, 7, 1.0, 256), negative}) {
        EXPECT_TRUE(test::refused<BadParameter>("growth.grow_forest", [&] { grow_forest(land, {{0, 0}}, wrong); }));
    }
    for (double const sticking : {1e-300, 1e-12}) { // it would not end
        EXPECT_THROW(grow_forest(Mask(frame(40, 40), 1), {{20, 20}}, {.sticking = sticking}), BadParameter);
    }
    for (std::vector<Cell> const& seeds : std::vector<std::vector<Cell>>{{}, {{0, 2}}, {{4, 0}}, {{0, 0}, {1, 1}}}) {
        EXPECT_TRUE(test::refused("growth.grow_forest", [&] { grow_forest(land, seeds, forest_params(1, 7)); }));
    }
    EXPECT_NO_THROW(grow_forest(land, {{0, 0}, {2, 0}}, forest_params(1, 7)));
    for (Grid const& large : {frame(100000, 100000), frame(2000000, 1)}) { // refused before a cell is read
        EXPECT_TRUE(test::refused("growth.grow_forest", [&] {
            grow_forest(Mask::view_of(large, {}, nullptr), {{0, 0}}, forest_params(5, 7));
        }));
    }
}

TEST(GrowForest, is_cancelled_while_nothing_grows) {
    EXPECT_THROW(grow_forest(Mask(frame(300, 300), 1), {{0, 0}}, forest_params(5, 7), test::stopped_run()), Cancelled);
    EXPECT_THROW(grow_forest(Mask(frame(3, 3), 1), {{0, 0}}, forest_params(1, 7, 1e-9), test::stopped_run()),
                 Cancelled);
}

// Laws of the header: a particle hangs on the one nearest to it, s to s + 1 away; it keeps 2 s from all others, but
// from that one's children and parent less; trees are their seeds'; nowhere could another particle be.
TEST(GrowForest, laws_of_a_forest) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        auto const step = *rc::gen::inRange<std::int64_t>(1, 8);
        Mask const region = random_blob(seed, *rc::gen::inRange(1, 70), *rc::gen::inRange(1, 70),
                                        *rc::gen::inRange(1, 9), *rc::gen::inRange(1, 20));
        auto const seeds = random_seeds(region, step, *rc::gen::inRange<std::size_t>(1, 6), seed);
        RC_PRE(!seeds.empty());
        ForestParams const params =
            forest_params(step, seed, *rc::gen::element(1.0, 0.85, 0.3), *rc::gen::inRange(1, 5));
        GrownForest const f = grow_forest(region, seeds, params);
        RC_ASSERT(f.stop == ForestStop::full);
        RC_ASSERT(f.parent.size() == f.cells.size());
        RC_ASSERT(f.tree.size() == f.cells.size());
        plain_forest::Trees trees(region, step);
        for (std::size_t p = 0; p < f.cells.size(); ++p) {
            if (p < seeds.size()) {
                RC_ASSERT(f.cells[p] == seeds[p]);
                RC_ASSERT(f.parent[p] == -1);
                RC_ASSERT(f.tree[p] == static_cast<std::int64_t>(p));
            } else {
                RC_ASSERT(trees.may_hold(f.cells[p]));
                RC_ASSERT(trees.nearest(f.cells[p]) == f.parent[p]);
                RC_ASSERT(f.tree[p] == f.tree[static_cast<std::size_t>(f.parent[p])]);
            }
            trees.add(f.cells[p], f.parent[p]);
        }
        Mask const reached = plain_forest::reached_from(seeds, region);
        for (std::int64_t i = 0; i < region.cells(); ++i) {
            RC_ASSERT(!(reached[i] != 0 && trees.may_hold(region.grid().at(i))));
        }
    }));
}

TEST(GrowForest, land_without_a_seed_stays_empty) {
    Mask const land = mask_of({"####.###", "####.###", "####.###", "####.###"});
    GrownForest const f = grow_forest(land, {{0, 0}}, forest_params(1, 7));
    EXPECT_GT(f.cells.size(), 5U);
    EXPECT_TRUE(std::ranges::all_of(f.cells, [](Cell c) { return c.col < 4; }));
}

// Law: no field of Run changes a result.
TEST(GrowForest, same_cells_for_any_number_of_threads) {
    Mask const land = random_blob(5, 200, 200, 8, 60);
    std::vector<Cell> const seeds = random_seeds(land, 5, 6, 9);
    GrownForest const first = grow_forest(land, seeds, forest_params(5, 7), on_threads(1));
    for (GrownForest const& again : {grow_forest(land, seeds, forest_params(5, 7), on_threads(2)),
                                     grow_forest(land, seeds, forest_params(5, 7))}) {
        EXPECT_EQ(again.cells, first.cells);
        EXPECT_EQ(again.parent, first.parent);
        EXPECT_EQ(again.walkers, first.walkers);
    }
    EXPECT_NE(grow_forest(land, seeds, forest_params(5, 8)).cells, first.cells);
}

TEST(GrowForest, a_longer_growth_continues_a_shorter) {
    Mask const land(frame(120, 90), 1);
    GrownForest const whole = grow_forest(land, {{0, 0}, {100, 50}}, forest_params(4, 7));
    ForestParams params = forest_params(4, 7);
    params.particles = 60;
    GrownForest const part = grow_forest(land, {{0, 0}, {100, 50}}, params);
    ASSERT_EQ(part.cells.size(), 60U);
    EXPECT_EQ(part.stop, ForestStop::particles);
    EXPECT_TRUE(std::equal(part.cells.begin(), part.cells.end(), whole.cells.begin()));
    EXPECT_GT(whole.cells.size(), 200U);
}

// Laws: every cell of grid and frame has a byte of its own; neighbours and the eight cells of a row are where cells
// say.
TEST(CellTiles, cells_and_indices_are_one_to_one) {
    enum class Byte : std::uint8_t { empty, full };
    for (auto const& [width, height] : {std::pair{1, 1}, {6, 7}, {7, 6}, {14, 15}, {40, 3}, {3, 40}}) {
        Grid const grid = frame(width, height);
        CellTiles<Byte> tiles(grid, Byte::empty);
        for (std::int64_t row = -1; row <= height; ++row) {
            for (std::int64_t col = -1; col <= width; ++col) {
                Cell const c{col, row};
                ASSERT_EQ(tiles.cell(tiles.index(c)), c);
                ASSERT_EQ(tiles[c], Byte::empty);
                tiles[c] = Byte::full;
                Cell const first{CellTiles<Byte>::first_of_eight(col), row};
                ASSERT_TRUE(first.col <= col && col < first.col + 8);
                ASSERT_NE(tiles.eight(first), 0U);
                if (grid.contains(c)) {
                    auto const beside = plain_forest::neighbours(c);
                    auto const found = tiles.neighbours(tiles.index(c));
                    for (std::size_t k = 0; k < 4; ++k) {
                        ASSERT_EQ(tiles.cell(found[k]), beside[k]);
                    }
                }
            }
        }
        ASSERT_EQ(std::ranges::count(tiles.all(), Byte::full), (width + 2) * (height + 2));
    }
}

// Law: on trees that do not grow, walkers by jumps and walkers by unit steps arrive alike, in a region with corners and
// an islet; the test would see it if one in twenty were displaced.
TEST(RegionWalk, arrivals_have_the_distribution_of_unit_steps) {
    Mask land(frame(60, 50), 1);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        Cell const c = land.grid().at(i);
        bool const bay = c.col > 30 && c.row < 14;
        bool const islet = c.col > 12 && c.col < 20 && c.row > 24 && c.row < 31;
        land[i] = bay || islet ? 0 : 1;
    }
    ForestParams params = forest_params(4, 7);
    params.particles = 14;
    GrownForest const f = grow_forest(land, {{0, 0}, {59, 49}}, params);
    auto const fast = plain_forest::arrivals_by_jumps(land, f, params.step_cells, 150000, 1);
    auto const slow = plain_forest::arrivals_by_steps(land, f, params.step_cells, 150000, 2);
    auto const honest = chi_squared::two_samples(fast, slow);
    EXPECT_GT(honest.freedom, 40.0);
    EXPECT_GT(honest.p, 0.01) << "chi2 " << honest.x << " of " << honest.freedom;

    auto planted = fast;
    std::vector<std::int64_t> places = fast;
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (std::size_t i = 0; i < planted.size(); i += 20) {
        auto const next = std::ranges::upper_bound(places, planted[i]);
        planted[i] = next == places.end() ? places.front() : *next;
    }
    EXPECT_LT(chi_squared::two_samples(planted, slow).p, 0.01);
}

// Law: forests take each shape as often as by the rules written out over unit steps and all pairs of particles, with
// walkers from everywhere.
TEST(GrowForest, shapes_come_as_often_as_by_unit_steps) {
    Mask const land = mask_of({"############.....", "############.....", "#################", "#####...#########",
                               "#####...#########", "#################", "#################", "....#############",
                               "....#############", "#################"});
    for (auto const& [sticking, visits] : {std::pair{1.0, 1}, {0.4, 1}, {0.6, 2}}) {
        std::vector<Shape> fast;
        std::vector<Shape> slow;
        for (std::uint64_t seed = 0; seed < 500; ++seed) {
            fast.push_back(shape(grow_forest(land, {{0, 2}, {16, 9}}, forest_params(2, seed, sticking, visits))));
            slow.push_back(
                shape(plain_forest::grow(land, {{0, 2}, {16, 9}}, forest_params(2, seed + 100000, sticking, visits))));
        }
        auto const test = chi_squared::two_samples(fast, slow);
        EXPECT_GT(test.freedom, 4.0);
        EXPECT_GT(test.p, 0.001) << sticking << " " << visits << ": chi2 " << test.x << " of " << test.freedom;
    }
}

TEST(PlantForest, refuses_what_leaves_no_room) {
    Mask const land(frame(40, 40), 1);
    for (auto const& [on, outlets] : std::vector<std::pair<Mask, std::vector<Cell>>>{
             {Mask(frame(40, 40), 0), {}}, {Mask(frame(5, 5), 1), {{0, 0}}}, {land, {{20, 20}}}, {land, {{40, 20}}}}) {
        EXPECT_TRUE(test::refused("growth.plant_forest", [&] { plant_forest(on, outlets); }));
    }
    EXPECT_THROW(plant_forest(land, {{0, 20}}, forest_params(3, 7)), BadParameter);
    EXPECT_THROW(plant_forest(land, {{0, 20}}, forest_params(101, 7)), BadParameter);
}

TEST(PlantForest, outlets_are_added_and_left_out_with_notes) {
    PlantedForest const one = plant_forest(Mask(frame(60, 60), 1), {});
    EXPECT_EQ(one.outlets, 1);
    EXPECT_EQ(count(one.notes, "added_outlet"), 1);
    EXPECT_EQ(one.stop, ForestStop::full);
    PlantedForest const crowded = plant_forest(Mask(frame(80, 60), 1), {{0, 30}, {0, 32}, {79, 30}, {79, 30}});
    EXPECT_EQ(crowded.outlets, 2);
    EXPECT_EQ(count(crowded.notes, "crowded_outlet"), 2);
    // Two large islands and a small one.
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
            f = plant_forest(land, outlets, forest_params(step, seed));
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

// Law: the network passes every check, with many outlets.
TEST(PlantForest, networks_pass_every_check) {
    for (std::uint64_t const seed : {1U, 2U, 3U}) {
        Grid const grid = frame(400, 300);
        Mask const land = shape_island(grid, {0.7, seed});
        PlantedForest const f = plant_forest(land, spread_outlets(land, coast_cells(land), {}), forest_params(5, seed));
        EXPECT_GT(f.outlets, 10);
        ElevatedNetwork const raised = network::set_heights(f.network).network;
        measure::TopologyReport const report =
            measure::check_topology(measure::as_file(raised, network::order(raised.planform)));
        for (Check const& check : report.checks) {
            EXPECT_TRUE(check.ok) << check.name << " " << check.value;
        }
    }
}

TEST(PlantForest, same_network_for_any_number_of_threads) {
    Mask const land = shape_island(frame(220, 200), {0.5, 4});
    std::vector<Cell> const outlets = spread_outlets(land, coast_cells(land), {});
    EXPECT_TRUE(test::same_network(plant_forest(land, outlets, forest_params(5, 7), on_threads(1)).network,
                                   plant_forest(land, outlets, forest_params(5, 7)).network));
}

} // namespace grow_forest_test
