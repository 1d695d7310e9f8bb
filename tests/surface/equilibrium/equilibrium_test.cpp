// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/equilibrium.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/direction.hpp>

#include "channel_trees.hpp"

namespace equilibrium_test {

using namespace thalweg;
using channel_trees::beside;
using channel_trees::Room;
using surface::Edge;
using surface::equilibrium;
using surface::EquilibriumFields;
using surface::EquilibriumParams;
using surface::EquilibriumTerrain;
using surface::Heads;
using surface::RiverHeights;

namespace {

using test::has;
using test::message_of;
using test::on_threads;

struct Scene {
    Channels rivers;
    EquilibriumFields fields;
    EquilibriumParams params;
    Room room = Room::apart;
};

bool dry(Scene const& scene, std::int64_t cell) {
    return scene.fields.land.cells() == 0 || scene.fields.land[cell] != 0;
}

/// Whether water may leave a cell: at the grid's border or beside the sea.
bool at_end(Scene const& scene, std::int64_t cell) {
    auto const near = beside(scene.rivers.grid, cell);
    return scene.rivers.grid.on_border(scene.rivers.grid.at(cell)) ||
           std::any_of(near.begin(), near.end(), [&](std::int64_t n) { return !dry(scene, n); });
}

/// Land within the circle about the middle, and every cell that a circle at random adds.
Mask island(Grid const& grid, std::uint64_t seed) {
    Mask land(grid);
    for (std::uint64_t blob = 0; blob < 3; ++blob) {
        double const x = static_cast<double>(grid.width) * unit(random_word(seed, 21, blob));
        double const y = static_cast<double>(grid.height) * unit(random_word(seed, 22, blob));
        double const r =
            0.5 * static_cast<double>(std::max(grid.width, grid.height)) * unit(random_word(seed, 23, blob));
        for (std::int64_t i = 0; i < land.cells(); ++i) {
            Cell const c = grid.at(i);
            double const dx = static_cast<double>(c.col) - x;
            double const dy = static_cast<double>(c.row) - y;
            land[i] = land[i] != 0 || dx * dx + dy * dy <= r * r ? 1 : 0;
        }
    }
    land[{grid.width / 2, grid.height / 2}] = 1;
    return land;
}

/// Lakes: what lies within three steps upstream of some cells.
void add_lakes(Channels& rivers, std::uint64_t seed) {
    rivers.level.assign(rivers.cell.size(), 0);
    std::vector<int> left(rivers.cell.size(), 0);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        std::int64_t const r = rivers.receiver[n];
        if (r < 0) {
            continue;
        }
        left[n] = std::max(0, left[static_cast<std::size_t>(r)] - 1);
        if (random_word(seed, 31, n) % 20 == 0) {
            left[n] = 4;
        }
        rivers.level[n] = left[n] > 0 ? 1 : 0;
    }
}

/// Heights that rise upstream from 100 m at random, or not at all; some cells have none.
void add_heights(Channels& rivers, std::uint64_t seed) {
    std::vector<float> z(rivers.cell.size(), 100.0F);
    for (std::size_t n = 0; n < z.size(); ++n) {
        if (rivers.receiver[n] >= 0) {
            double const rise = static_cast<double>(random_word(seed, 51, n) % 4) * 0.7;
            z[n] = z[static_cast<std::size_t>(rivers.receiver[n])] + static_cast<float>(rise);
        }
    }
    rivers.z = z;
    for (std::size_t n = 1; n < z.size(); ++n) {
        rivers.z[n] = random_word(seed, 52, n) % 3 == 0 ? rivers.z[n] : std::numeric_limits<float>::quiet_NaN();
    }
}

/// Its terrain; no trial where so much of it is level that the slope asked cannot be reached.
EquilibriumTerrain land_of(Scene const& scene) {
    try {
        return equilibrium(scene.rivers, scene.fields, scene.params);
    } catch (BadParameter const& fault) {
        RC_PRE(std::string(fault.what()).find("cannot be reached") == std::string::npos);
        throw;
    }
}

/// Layers as thick as a few cells.
surface::Strata any_strata(Grid const& grid, std::uint64_t seed) {
    auto const number = [&](std::uint64_t what, std::uint64_t n) { return unit(random_word(seed, 60 + what, n)); };
    surface::Strata strata;
    for (std::uint64_t k = 0; k < 2 + random_word(seed, 59) % 12; ++k) {
        strata.layers.push_back({.thickness_m = grid.cell_m * (0.2 + 3.0 * number(1, k)),
                                 .strength = std::exp(8.0 * number(2, k) - 4.0),
                                 .cliff = 0.05 + 6.0 * number(3, k)});
    }
    strata.base_m = grid.cell_m * (4.0 * number(4, 0) - 3.0);
    strata.dip_deg = random_word(seed, 58) % 2 == 0 ? 0.0 : 60.0 * number(5, 0);
    strata.strike_deg = 360.0 * number(6, 0);
    strata.undulation_m = 2.0 * grid.cell_m * number(7, 0);
    strata.undulation_wave_m = 10.0 * grid.cell_m;
    strata.seed = seed;
    return strata;
}

Scene any_scene() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 41).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, 41).as("height");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    auto const cells = *rc::gen::inRange<std::int64_t>(1, 200).as("river cells");
    Scene scene;
    scene.params.edge = *rc::gen::element(Edge::open, Edge::closed, Edge::coast, Edge::mainland).as("edge");
    scene.params.seed = seed;
    scene.params.theta = *rc::gen::element(0.45, 0.45, 0.1, 0.9).as("theta");
    scene.params.hillslope_m = *rc::gen::element(15.0, 15.0, 0.0, 1e4).as("hillslope");
    scene.params.debris_area_m2 = *rc::gen::element(5e4, 0.0, 1e9).as("debris flows");
    scene.params.grain = *rc::gen::element(5.0, 1.0, 20.0).as("grain");
    scene.params.longest_wave_m = *rc::gen::element(10'800.0, 1.0, 1e7).as("longest wave");
    scene.params.roughness = *rc::gen::element(0.4, 0.4, 0.0, 1.0).as("roughness");
    scene.params.floor_width_km = *rc::gen::element(0.0085, 0.0, 1.0).as("floor");
    scene.params.mean_slope_deg = *rc::gen::element(25.0, 0.001, 60.0).as("slope");
    scene.room = *rc::gen::element(Room::apart, Room::apart, Room::crowd).as("room");
    Grid const grid = test::frame(width, height, *rc::gen::element(10.0, 0.5, 1000.0).as("cell"));
    // A closed land that is in pieces would need a river on each.
    bool const sea = scene.params.edge != Edge::closed && *rc::gen::arbitrary<bool>().as("sea");
    if (sea) {
        scene.fields.land = island(grid, seed);
    }
    bool const sinks = *rc::gen::element(false, false, true).as("sinks");
    scene.rivers.grid = grid;
    std::vector<std::int64_t> ends;
    std::vector<std::int64_t> possible;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (dry(scene, i) && (sinks || at_end(scene, i))) {
            possible.push_back(i);
        }
    }
    for (std::uint64_t end = 0; end < 3; ++end) {
        ends.push_back(possible[random_word(seed, 41, end) % possible.size()]);
    }
    scene.rivers = channel_trees::grown(grid, ends, scene.fields.land, cells, scene.room, seed);
    // A lake's water cannot be told from a river's that lies beside it.
    if (scene.room == Room::apart && *rc::gen::arbitrary<bool>().as("lakes")) {
        add_lakes(scene.rivers, seed);
    }
    scene.params.heights =
        *rc::gen::element(RiverHeights::graded, RiverHeights::graded, RiverHeights::soft, RiverHeights::fixed)
             .as("heights");
    scene.params.heads = *rc::gen::element(Heads::cut, Heads::kept).as("heads");
    if (*rc::gen::element(false, false, true).as("features")) {
        scene.fields.features = channel_trees::any_features(grid, seed);
    }
    if (scene.params.heights != RiverHeights::graded) {
        add_heights(scene.rivers, seed);
    } else if (scene.fields.features.empty() && *rc::gen::element(false, false, true).as("layers")) {
        scene.fields.strata = any_strata(grid, seed);
    }
    return scene;
}

flow::Direction plain_d8(Raster<float> const& dem, std::int64_t cell) {
    if (std::isnan(dem[cell])) {
        return flow::Direction::no_data;
    }
    flow::Direction way = flow::Direction::leaves;
    double best = 0.0;
    Cell const at = dem.grid().at(cell);
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        Cell const n{at.col + d8_steps[k].col, at.row + d8_steps[k].row};
        if (dem.grid().contains(n)) {
            double const slope = (static_cast<double>(dem[cell]) - static_cast<double>(dem[n])) * d8_per_length[k];
            if (slope > best) {
                best = slope;
                way = flow::direction_of(k);
            }
        }
    }
    return way;
}

std::int64_t next(Grid const& grid, std::int64_t cell, flow::Direction way) {
    Cell const at = grid.at(cell);
    Cell const step = d8_steps[index_of(way)];
    return grid.index({at.col + step.col, at.row + step.row});
}

/// Cells below the level at which their water spills towards the border, the sea or a river's end.
std::int64_t cells_in_depressions(Scene const& scene, Raster<float> const& dem) {
    std::vector<float> level(static_cast<std::size_t>(dem.cells()), std::numeric_limits<float>::infinity());
    std::set<std::int64_t> ends;
    for (std::size_t n = 0; n < scene.rivers.cell.size(); ++n) {
        if (scene.rivers.receiver[n] < 0) {
            ends.insert(scene.rivers.cell[n]);
        }
    }
    using Entry = std::pair<float, std::int64_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        bool const ends_here =
            scene.params.edge == Edge::closed ? ends.contains(i) : ends.contains(i) || at_end(scene, i);
        if (!std::isnan(dem[i]) && ends_here) {
            level[static_cast<std::size_t>(i)] = dem[i];
            queue.emplace(dem[i], i);
        }
    }
    while (!queue.empty()) {
        auto const [z, i] = queue.top();
        queue.pop();
        for (std::int64_t const n : beside(dem.grid(), i)) {
            if (!std::isnan(dem[n]) && std::isinf(level[static_cast<std::size_t>(n)])) {
                level[static_cast<std::size_t>(n)] = std::max(z, dem[n]);
                queue.emplace(level[static_cast<std::size_t>(n)], n);
            }
        }
    }
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        count += level[static_cast<std::size_t>(i)] > dem[i] ? 1 : 0;
    }
    return count;
}

/// Numbers of the river cells that are still such.
std::vector<std::size_t> kept(Scene const& scene, EquilibriumTerrain const& land) {
    std::set<std::int64_t> const gone(land.shortened.begin(), land.shortened.end());
    std::vector<std::size_t> out;
    for (std::size_t n = 0; n < scene.rivers.cell.size(); ++n) {
        if (!gone.contains(static_cast<std::int64_t>(n))) {
            out.push_back(n);
        }
    }
    return out;
}

std::set<std::int64_t> river_cells(Scene const& scene, EquilibriumTerrain const& land) {
    std::set<std::int64_t> out;
    for (std::size_t const n : kept(scene, land)) {
        out.insert(scene.rivers.cell[n]);
    }
    return out;
}

template <class Thrown> std::string message(Scene const& scene) {
    return message_of<Thrown>([&] { equilibrium(scene.rivers, scene.fields, scene.params); });
}

/// One river straight through a square from its middle column's head to the southern border.
Scene square(std::int64_t side, Edge edge = Edge::open) {
    Scene scene;
    scene.rivers.grid = test::frame(side, side, 10.0);
    scene.params.edge = edge;
    for (std::int64_t row = side - 1; row >= side / 4; --row) {
        scene.rivers.receiver.push_back(static_cast<std::int64_t>(scene.rivers.cell.size()) - 1);
        scene.rivers.cell.push_back(row * side + side / 2);
    }
    return scene;
}

} // namespace

// The least there can be: a cell, a row, a column; and a grid that is all river.
TEST(Equilibrium, TinyGridsHaveLand) {
    for (Edge const edge : {Edge::open, Edge::closed, Edge::coast, Edge::mainland}) {
        for (auto const& [width, height] :
             {std::pair<std::int64_t, std::int64_t>{1, 1}, {5, 1}, {1, 5}, {2, 2}, {3, 3}}) {
            Scene scene;
            scene.params.edge = edge;
            scene.rivers = {test::frame(width, height, 10.0), {0}, {-1}, {}, {}};
            EquilibriumTerrain const land = equilibrium(scene.rivers, {}, scene.params);
            EXPECT_EQ(land.dem[0], 0.0F);
            EXPECT_EQ(land.direction[0], flow::Direction::leaves);
            for (std::int64_t i = 1; i < land.dem.cells(); ++i) {
                EXPECT_GT(land.dem[i], 0.0F) << width << " x " << height << " cell " << i;
            }
        }
    }
}

TEST(Equilibrium, AGridMayBeAllRiver) {
    Scene scene;
    scene.rivers = {test::frame(4, 1, 10.0), {0, 1, 2, 3}, {-1, 0, 1, 2}, {}, {}};
    EquilibriumTerrain const land = equilibrium(scene.rivers, {}, scene.params);
    for (std::int64_t i = 1; i < 4; ++i) {
        EXPECT_GT(land.dem[i], land.dem[i - 1]);
        EXPECT_EQ(land.direction[i], flow::Direction::west);
    }
}

// Every other cell has a strictly lower neighbour, so there is no depression but a sink; directions are those of the
// steepest descent of the floats that are written, and those of rivers are towards their receivers.
TEST(Equilibrium, LandDrains) {
    EXPECT_TRUE(rc::check("land drains", [] {
        Scene const scene = any_scene();
        EquilibriumTerrain const land = land_of(scene);
        auto const rivers = river_cells(scene, land);
        for (std::int64_t i = 0; i < land.dem.cells(); ++i) {
            RC_ASSERT(std::isnan(land.dem[i]) == !dry(scene, i));
            RC_ASSERT(!std::isinf(land.dem[i]));
            if (!rivers.contains(i)) {
                RC_ASSERT(land.direction[i] == plain_d8(land.dem, i));
                RC_ASSERT((land.direction[i] != flow::Direction::leaves ||
                           (scene.params.edge != Edge::closed && at_end(scene, i))));
            }
        }
        RC_ASSERT(cells_in_depressions(scene, land.dem) == 0);
    }));
}

// Water of a river cell goes to its receiver; lakes are level; cells beside rivers stand above them; the lowest end
// stands at 0.
TEST(Equilibrium, RiversKeepTheirWater) {
    EXPECT_TRUE(rc::check("rivers keep their water", [] {
        Scene const scene = any_scene();
        EquilibriumTerrain const land = land_of(scene);
        Channels const& rivers = scene.rivers;
        auto const cells = river_cells(scene, land);
        float lowest = std::numeric_limits<float>::infinity();
        for (std::size_t const n : kept(scene, land)) {
            std::int64_t const i = rivers.cell[n];
            for (std::int64_t const near : beside(rivers.grid, i)) {
                RC_ASSERT((cells.contains(near) || std::isnan(land.dem[near]) || land.dem[near] > land.dem[i]));
            }
            if (rivers.receiver[n] < 0) {
                lowest = std::min(lowest, land.dem[i]);
                RC_ASSERT(land.direction[i] == flow::Direction::leaves);
                continue;
            }
            std::int64_t const below = rivers.cell[static_cast<std::size_t>(rivers.receiver[n])];
            RC_ASSERT(next(rivers.grid, i, land.direction[i]) == below);
            if (!rivers.level.empty() && rivers.level[n] != 0) {
                RC_ASSERT(land.dem[i] == land.dem[below]);
                continue;
            }
            RC_ASSERT(land.dem[i] > land.dem[below]);
            if (scene.room == Room::apart && scene.params.heights == RiverHeights::graded) {
                RC_ASSERT(plain_d8(land.dem, i) == land.direction[i]);
            }
        }
        RC_ASSERT((scene.params.heights != RiverHeights::graded || lowest == 0.0F));
        // Only tips are given up: with a cell goes all that lies upstream of it.
        RC_ASSERT(std::is_sorted(land.shortened.begin(), land.shortened.end()));
        for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
            bool const river = cells.contains(rivers.cell[n]);
            RC_ASSERT((!river || rivers.receiver[n] < 0 ||
                       cells.contains(rivers.cell[static_cast<std::size_t>(rivers.receiver[n])])));
        }
    }));
}

namespace {

/// A river of many cells that leaves to the south, and beside its head a short one that leaves to the north.
Channels long_and_short(std::int64_t apart) {
    Channels rivers{test::frame(96, 160, 30.0), {}, {}, {}, {}};
    auto const draw = [&](std::int64_t col, std::int64_t from, std::int64_t to, std::int64_t step) {
        for (std::int64_t row = from; row != to; row += step) {
            bool const is_end = row == from;
            rivers.receiver.push_back(is_end ? -1 : static_cast<ChannelId>(rivers.cell.size()) - 1);
            rivers.cell.push_back(rivers.grid.index({col, row}));
        }
    };
    draw(40, 159, 9, -1);
    draw(40 + apart, 0, 20, 1);
    return rivers;
}

EquilibriumTerrain with_heads(Channels const& rivers, Heads heads) {
    EquilibriumParams params;
    params.heads = heads;
    params.region = 1.0;
    return equilibrium(rivers, {}, params);
}

} // namespace

TEST(Equilibrium, FixedHeightsMayNeedWalls) {
    Channels rivers = long_and_short(12);
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        rivers.z.push_back(n < 150 ? 20.0F + 3.0F * static_cast<float>(n) : static_cast<float>(n - 150));
    }
    EquilibriumParams params;
    params.heights = RiverHeights::fixed;
    params.heads = Heads::kept;
    EXPECT_FALSE(equilibrium(rivers, {}, params).walled.empty());
}

// Fixed: given heights are kept, but for the least rise that water needs. Soft: they are upper bounds, and what lies
// below them is told.
TEST(Equilibrium, GivenHeightsHold) {
    EXPECT_TRUE(rc::check("given heights hold", [] {
        Scene scene = any_scene();
        scene.params.heights = *rc::gen::element(RiverHeights::soft, RiverHeights::fixed).as("which");
        scene.rivers.level.clear();
        add_heights(scene.rivers, scene.params.seed);
        scene.fields.strata = {};
        EquilibriumTerrain const land = land_of(scene);
        float const ulps = 100.0F * static_cast<float>(scene.rivers.cell.size()) * 0x1p-22F;
        double deepest = 0.0;
        for (std::size_t n = 0; n < scene.rivers.cell.size(); ++n) {
            float const asked = scene.rivers.z[n];
            if (std::isnan(asked)) {
                continue;
            }
            float const z = land.dem[scene.rivers.cell[n]];
            RC_ASSERT(z <= asked + ulps);
            if (scene.params.heights == RiverHeights::fixed) {
                RC_ASSERT(z >= asked);
            }
            deepest = std::max(deepest, static_cast<double>(asked) - static_cast<double>(z));
        }
        RC_ASSERT(land.max_lowered_m == deepest);
        RC_ASSERT((land.p95_lowered_m >= 0.0 && land.p95_lowered_m <= deepest));
        RC_ASSERT(land.shortened.empty());
    }));
}

// On the mainland a river runs on beyond the grid, where nothing is asked: steps of floats there lift nobody here.
TEST(Equilibrium, WhatLiesBeyondTheGridDoesNotLiftGivenHeights) {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    for (std::int64_t length = 2; length < 7; ++length) {
        Channels rivers;
        rivers.grid = test::frame(3, 8, 0.5);
        for (std::int64_t n = 0; n < length; ++n) {
            rivers.cell.push_back(1 + 3 * n);
            rivers.receiver.push_back(n - 1);
            rivers.z.push_back(n + 1 == length ? 100.0F : none);
        }
        EquilibriumParams params;
        params.heights = RiverHeights::fixed;
        params.edge = Edge::mainland;
        params.mean_slope_deg = 0.001;
        params.hillslope_m = 50.0;
        params.floor_width_km = 1.0;
        EquilibriumTerrain const land = equilibrium(rivers, {}, params);
        float const source = land.dem[rivers.cell.back()];
        EXPECT_GE(source, 100.0F);
        EXPECT_LE(source, 100.0F + static_cast<float>(length) * 100.0F * 0x1p-22F) << length;
    }
}

// Only an outlet and a source are given: the river between them falls all the way, more steeply where it drains less.
TEST(Equilibrium, RiversAreGradedBetweenGivenHeights) {
    Scene scene = square(80);
    scene.rivers.z.assign(scene.rivers.cell.size(), std::numeric_limits<float>::quiet_NaN());
    scene.rivers.z.front() = 20.0F;
    scene.rivers.z.back() = 50.0F;
    scene.params.heights = RiverHeights::fixed;
    EquilibriumTerrain const land = equilibrium(scene.rivers, {}, scene.params);
    auto const z = [&](std::size_t n) { return land.dem[scene.rivers.cell[n]]; };
    std::size_t const last = scene.rivers.cell.size() - 1;
    EXPECT_EQ(z(0), 20.0F);
    EXPECT_EQ(z(last), 50.0F);
    for (std::size_t n = 1; n <= last; ++n) {
        EXPECT_GT(z(n), z(n - 1));
    }
    EXPECT_LT(z(last / 2) - z(0), z(last) - z(last / 2));
}

// The same bytes for any number of threads, and others for another seed.
TEST(Equilibrium, HeadsAreKeptByFirmerRock) {
    Channels const rivers = long_and_short(12);
    EXPECT_GE(with_heads(rivers, Heads::cut).shortened.size(), 5U);
    EquilibriumTerrain const land = with_heads(rivers, Heads::kept);
    EXPECT_TRUE(land.shortened.empty());
    EXPECT_TRUE(land.walled.empty());
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        if (rivers.receiver[n] >= 0) {
            std::int64_t const below = rivers.cell[static_cast<std::size_t>(rivers.receiver[n])];
            EXPECT_EQ(next(rivers.grid, rivers.cell[n], plain_d8(land.dem, rivers.cell[n])), below) << n;
        }
    }
}

/// River cells beside which all land stands more than a height above them.
std::int64_t cells_in_trenches(Scene const& scene, EquilibriumTerrain const& land, double height_m) {
    std::set<std::int64_t> const rivers = river_cells(scene, land);
    return std::count_if(rivers.begin(), rivers.end(), [&](std::int64_t cell) {
        float lowest = std::numeric_limits<float>::infinity();
        for (std::int64_t const n : beside(scene.rivers.grid, cell)) {
            lowest = rivers.contains(n) ? lowest : std::min(lowest, land.dem[n]);
        }
        return std::isfinite(lowest) && static_cast<double>(lowest - land.dem[cell]) > height_m;
    });
}

// Rivers that head far inland, and gorges in the east, where uplift is six times as high.
TEST(Equilibrium, NoRiverLiesInATrench) {
    Scene scene;
    Grid const grid = test::frame(192, 192, 30.0);
    scene.fields.uplift = Raster<float>(grid, 1.0F);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        scene.fields.uplift[i] = grid.at(i).col > 96 ? 6.0F : 1.0F;
    }
    scene.params.roughness = 0.4;
    std::int64_t graded = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        scene.params.seed = seed;
        scene.params.heads = seed % 3 == 0 ? Heads::kept : Heads::cut;
        scene.rivers = channel_trees::grown(grid, {grid.index({0, 60}), grid.index({191, 100}), grid.index({80, 191})},
                                            {}, 900, Room::apart, seed);
        EquilibriumTerrain const land = equilibrium(scene.rivers, scene.fields, scene.params);
        EXPECT_EQ(cells_in_trenches(scene, land, grid.cell_m), 0) << seed; // 45 degrees
        graded += land.graded_heads;
        EXPECT_LE(land.graded_heads, std::ssize(land.shortened));
    }
    EXPECT_GT(graded, 0);
}

TEST(Equilibrium, OnlyHeadsBesideAnotherRiverAreCut) {
    Channels const rivers = long_and_short(1); // twelve rows side by side
    EquilibriumTerrain const land = with_heads(rivers, Heads::kept);
    EXPECT_GE(land.shortened.size(), 11U);
    EXPECT_LE(land.shortened.size(), 24U);
}

TEST(Equilibrium, ThreadsDoNotMatterSeedsDo) {
    Scene scene = square(90);
    auto const bytes = [&](int threads) {
        thalweg::Run const run = on_threads(threads);
        EquilibriumTerrain const land = equilibrium(scene.rivers, {}, scene.params, run);
        std::vector<std::uint32_t> out;
        std::transform(land.dem.values().begin(), land.dem.values().end(), std::back_inserter(out),
                       [](float z) { return std::bit_cast<std::uint32_t>(z); });
        return out;
    };
    auto const one = bytes(1);
    EXPECT_EQ(one, bytes(2));
    EXPECT_EQ(one, bytes(5));
    scene.params.seed = 8;
    EXPECT_NE(one, bytes(1));
}

TEST(Equilibrium, ComesNearKnownHeightsAndNoWaterCrossesRidges) {
    Grid const grid = test::frame(160, 160, 30.0);
    Scene scene;
    scene.rivers = channel_trees::grown(grid, {80}, {}, 300, Room::apart, 4);
    Raster<float> const before = equilibrium(scene.rivers, {}, scene.params).dem;
    scene.fields.features = {{grid.index({30, 30}), 1.4F * before[{30, 30}]},
                             {grid.index({120, 60}), 0.8F * before[{120, 60}]},
                             {grid.index({60, 120}), 1.2F * before[{60, 120}]}};
    Raster<float> const after = equilibrium(scene.rivers, scene.fields, scene.params).dem;
    for (surface::FeatureCell const& feature : scene.fields.features) {
        EXPECT_NEAR(after[feature.cell], feature.z, 0.1F * std::fabs(feature.z - before[feature.cell]));
    }
}

TEST(Equilibrium, NoWaterCrossesRidges) {
    constexpr std::int64_t crest = 40;
    Scene scene = square(120, Edge::closed);
    scene.rivers = channel_trees::parallel(scene.rivers.grid, {20, 100});
    Grid const& grid = scene.rivers.grid;
    auto const crossing = [&](EquilibriumTerrain const& land) {
        std::int64_t count = 0;
        for (std::int64_t i = 0; i < grid.cells(); ++i) {
            std::int64_t at = i;
            while (grid.at(at).col != 20 && grid.at(at).col != 100) {
                at = next(grid, at, land.direction[at]);
            }
            count += (grid.at(i).col < crest) != (grid.at(at).col == 20) && grid.at(i).col != crest ? 1 : 0;
        }
        return count;
    };
    std::int64_t const without = crossing(equilibrium(scene.rivers, {}, scene.params));
    for (std::int64_t row = 0; row < grid.height; ++row) {
        scene.fields.features.push_back({grid.index({crest, row}), std::numeric_limits<float>::quiet_NaN(), true});
    }
    std::int64_t const with = crossing(equilibrium(scene.rivers, scene.fields, scene.params));
    EXPECT_GT(without, 1500);
    EXPECT_LT(with, 150);
}

TEST(Equilibrium, HasTheReliefAsked) {
    for (Edge const edge : {Edge::open, Edge::closed, Edge::coast, Edge::mainland}) {
        Scene scene = square(64, edge);
        scene.params.relief_m = 123.0;
        EquilibriumTerrain const land = equilibrium(scene.rivers, {}, scene.params);
        auto const values = land.dem.values();
        auto const [low, high] = std::minmax_element(values.begin(), values.end());
        EXPECT_NEAR(*high - *low, 123.0F, 0.01F);
    }
}

TEST(Equilibrium, AMainlandIsLowAtTheSeaAndGoesOnInland) {
    Scene scene = square(64, Edge::mainland);
    scene.fields.land = Mask(scene.rivers.grid, 1);
    for (std::int64_t row = 0; row < 64; ++row) {
        for (std::int64_t col = 0; col < 12; ++col) {
            scene.fields.land[Cell{col, row}] = 0;
        }
    }
    for (std::int64_t const cell : scene.rivers.cell) {
        scene.fields.land[cell] = 1;
    }
    EquilibriumTerrain const land = equilibrium(scene.rivers, scene.fields, scene.params);
    scene.params.edge = Edge::coast;
    EquilibriumTerrain const island = equilibrium(scene.rivers, scene.fields, scene.params);
    auto const mean = [](Raster<float> const& dem, std::int64_t col) {
        double sum = 0.0;
        int cells = 0;
        for (std::int64_t row = 0; row < dem.height(); ++row) {
            if (!std::isnan(dem[Cell{col, row}])) {
                sum += static_cast<double>(dem[Cell{col, row}]);
                ++cells;
            }
        }
        return sum / cells;
    };
    // At the sea both are low; at the far border only the island is.
    EXPECT_LT(mean(land.dem, 12), 0.4 * mean(land.dem, 40));
    EXPECT_GT(mean(land.dem, 63), 0.5 * mean(land.dem, 40));
    EXPECT_LT(mean(island.dem, 63), 0.4 * mean(island.dem, 40));
}

TEST(Equilibrium, AMainlandWithoutSeaIsOpen) {
    Scene scene = square(48);
    Raster<float> const open = equilibrium(scene.rivers, {}, scene.params).dem;
    scene.params.edge = Edge::mainland;
    Raster<float> const mainland = equilibrium(scene.rivers, {}, scene.params).dem;
    EXPECT_TRUE(std::equal(open.values().begin(), open.values().end(), mainland.values().begin()));
}

TEST(Equilibrium, HasTheMeanSlopeAsked) {
    for (double const asked : {2.0, 25.0, 50.0}) {
        Scene scene = square(64);
        scene.params.mean_slope_deg = asked;
        EquilibriumTerrain const land = equilibrium(scene.rivers, {}, scene.params);
        double sum = 0.0;
        for (std::int64_t row = 1; row < 63; ++row) {
            for (std::int64_t col = 1; col < 63; ++col) {
                auto const z = [&](std::int64_t c, std::int64_t r) {
                    return static_cast<double>(land.dem[Cell{col + c, row + r}]);
                };
                double const east = z(1, -1) + 2 * z(1, 0) + z(1, 1) - z(-1, -1) - 2 * z(-1, 0) - z(-1, 1);
                double const south = z(-1, 1) + 2 * z(0, 1) + z(1, 1) - z(-1, -1) - 2 * z(0, -1) - z(1, -1);
                sum += std::atan(std::hypot(east, south) / 80.0);
            }
        }
        EXPECT_NEAR(sum / (62.0 * 62.0) * 180.0 / 3.14159265, asked, 0.01 * asked);
    }
}

/// The normalised steepness of the main stem above the first river cell: rise over chi, with the areas that the
/// terrain's own directions give.
double main_steepness(Channels const& rivers, EquilibriumTerrain const& land) {
    std::int64_t const cells = land.dem.cells();
    std::vector<double> area(static_cast<std::size_t>(cells), 1.0);
    std::vector<std::int64_t> order(static_cast<std::size_t>(cells));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) { return land.dem[a] > land.dem[b]; });
    for (std::int64_t const cell : order) {
        if (std::int64_t const to = flow::receiver(land.direction, cell); to >= 0) {
            area[static_cast<std::size_t>(to)] += area[static_cast<std::size_t>(cell)];
        }
    }
    double chi = 0.0;
    std::size_t at = 0;
    for (std::size_t next = at; next != rivers.cell.size();) {
        at = next;
        next = rivers.cell.size();
        for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
            auto const a = [&](std::size_t k) { return area[static_cast<std::size_t>(rivers.cell[k])]; };
            if (rivers.receiver[n] == static_cast<std::int64_t>(at) && (next == rivers.cell.size() || a(n) > a(next))) {
                next = n;
            }
        }
        if (next != rivers.cell.size()) {
            Cell const a = rivers.grid.at(rivers.cell[at]);
            Cell const b = rivers.grid.at(rivers.cell[next]);
            double const step_m = rivers.grid.cell_m * std::hypot(a.col - b.col, a.row - b.row);
            double const area_m2 =
                area[static_cast<std::size_t>(rivers.cell[next])] * rivers.grid.cell_m * rivers.grid.cell_m;
            chi += step_m * std::pow(area_m2, -0.45);
        }
    }
    return static_cast<double>(land.dem[rivers.cell[at]] - land.dem[rivers.cell[0]]) / chi;
}

// Land whose main stem would be steeper is lowered to the steepness asked, and else stays as it is.
TEST(Equilibrium, MainStemsAreNoSteeperThanAsked) {
    Scene scene = square(64, Edge::closed);
    EquilibriumTerrain const free = equilibrium(scene.rivers, {}, scene.params);
    EXPECT_FALSE(free.is_bounded);
    EXPECT_NEAR(free.steepness / main_steepness(scene.rivers, free), 1.0, 0.02);
    scene.params.steepness = 0.4 * free.steepness;
    EquilibriumTerrain const bounded = equilibrium(scene.rivers, {}, scene.params);
    EXPECT_TRUE(bounded.is_bounded);
    EXPECT_NEAR(bounded.steepness / *scene.params.steepness, 1.0, 1e-9);
    EXPECT_NEAR(main_steepness(scene.rivers, bounded) / *scene.params.steepness, 1.0, 0.02);
    for (std::int64_t i = 0; i < free.dem.cells(); ++i) {
        EXPECT_NEAR(bounded.dem[i], 0.4F * free.dem[i], 1e-3F + 1e-4F * free.dem[i]);
    }
    scene.params.steepness = 2.0 * free.steepness;
    EquilibriumTerrain const loose = equilibrium(scene.rivers, {}, scene.params);
    EXPECT_FALSE(loose.is_bounded);
    EXPECT_TRUE(std::equal(loose.dem.values().begin(), loose.dem.values().end(), free.dem.values().begin()));
    scene.params.relief_m = 100.0; // comes before it
    scene.params.steepness = 0.4 * free.steepness;
    EXPECT_FALSE(equilibrium(scene.rivers, {}, scene.params).is_bounded);
    scene.params = {};
    scene.params.steepness = 0.0;
    EXPECT_TRUE(has(message<BadParameter>(scene), "steepness"));
}

// A sea without land in it is no land to draw; rivers that break their law are named with their place.
TEST(Equilibrium, RefusesWhatCannotBe) {
    Scene const good = square(8);
    auto const with = [&](auto change) {
        Scene scene = good;
        change(scene);
        return scene;
    };
    auto const bad_input = [&](auto change) { return message<BadInput>(with(change)); };
    auto const bad_parameter = [&](auto change) { return message<BadParameter>(with(change)); };
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.grid = test::frame(0, 0, 10.0); }), "no cells"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.grid.cell_m = 0.0; }), "cell size"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers = {test::frame(8, 8, 10.0), {}, {}, {}, {}}; }), "no rivers"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.receiver.pop_back(); }), "one each"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.cell[1] = 64; }), "outside"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.cell[1] = s.rivers.cell[0]; }), "column 4, row 7"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.receiver[1] = 2; }), "downstream first"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.receiver[3] = 0; }), "not a neighbour"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.fields.land = Mask(test::frame(7, 8, 10.0), 1); }), "different grids"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.fields.land = Mask(test::frame(8, 8, 10.0), 0); }), "no land"));
    EXPECT_TRUE(has(bad_input([](Scene& s) {
                        s.fields.land = Mask(test::frame(8, 8, 10.0), 1);
                        s.fields.land[{4, 6}] = 0;
                    }),
                    "column 4, row 6 lies at sea"));
    EXPECT_TRUE(has(bad_input([](Scene& s) {
                        s.fields.uplift = Raster<float>(test::frame(8, 8, 10.0), 1.0F);
                        s.fields.uplift[{2, 3}] = std::numeric_limits<float>::quiet_NaN();
                    }),
                    "uplift is nan at column 2, row 3"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.fields.erodibility = Raster<float>(test::frame(8, 8, 10.0), 0.0F); }),
                    "erodibility"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.z = {5, 6, 7, 6, 9, 10}; }), "rises"));
    EXPECT_TRUE(has(bad_input([](Scene& s) {
                        s.params.edge = Edge::closed;
                        s.fields.land = Mask(test::frame(8, 8, 10.0), 1);
                        for (std::int64_t i = 0; i < 8; ++i) {
                            s.fields.land[{1, i}] = 0;
                        }
                    }),
                    "column 0, row 0"));
    EXPECT_TRUE(has(bad_input([](Scene& s) { s.rivers.lake_z = {1, 2}; }), "levels of lakes; give one each"));
    EXPECT_TRUE(has(bad_input([](Scene& s) {
                        s.rivers.level = {0, 0, 1, 0, 0, 0};
                        s.rivers.lake_z.assign(6, std::nanf(""));
                        s.rivers.lake_z[2] = 5.0F;
                    }),
                    "column 4, row 5 is 5 m within a lake"));
    EXPECT_TRUE(has(bad_parameter([](Scene& s) { s.params.theta = 0.0; }), "theta"));
    EXPECT_TRUE(has(bad_parameter([](Scene& s) { s.params.relief_m = 0.0; }), "relief_m"));
    EXPECT_TRUE(has(bad_parameter([](Scene& s) { s.params.mean_slope_deg = 61.0; }), "mean_slope_deg"));
    EXPECT_TRUE(has(bad_parameter([](Scene& s) { s.params.hillslope_m = std::nan(""); }), "hillslope_m"));
    EXPECT_TRUE(has(bad_parameter([](Scene& s) { s.params.floor_width_km = -1.0; }), "floor_width_km"));
    EXPECT_TRUE(has(bad_parameter([](Scene& s) { s.params.roughness = 2.0; }), "roughness"));
    EXPECT_TRUE(has(bad_parameter([](Scene& s) { s.params.longest_wave_m = 0.0; }), "longest_wave_m"));
}

namespace {

bool is_lake(Channels const& rivers, std::size_t n) {
    return !rivers.level.empty() && rivers.level[n] != 0 && rivers.receiver[n] >= 0;
}

/// Gives some lakes levels at random.
void add_levels(Channels& rivers, std::uint64_t seed) {
    rivers.lake_z.assign(rivers.cell.size(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
        auto const r = static_cast<std::size_t>(std::max<std::int64_t>(rivers.receiver[n], 0));
        if (is_lake(rivers, n) && !is_lake(rivers, r) && random_word(seed, 61, r) % 3 > 0) {
            rivers.lake_z[r] = static_cast<float>(300.0 * unit(random_word(seed, 62, r)) - 50.0);
        }
    }
}

/// The least height from which water falls to the next lake with a level downstream of an outlet, or to the end.
float least_level(Scene const& scene, EquilibriumTerrain const& land, std::size_t outlet) {
    Channels const& rivers = scene.rivers;
    int falls = 0;
    std::size_t at = outlet;
    do {
        if (rivers.receiver[at] < 0) {
            bool const given = scene.params.heights != RiverHeights::graded;
            float const end = given ? rivers.z[at] : land.dem[rivers.cell[at]];
            if (std::isnan(end)) {
                return -std::numeric_limits<float>::infinity();
            }
            float z = end;
            for (; falls > 0; --falls) {
                z = std::max(z + 0x1p-13F, std::nextafter(z, 1e30F));
            }
            return z;
        }
        falls += is_lake(rivers, at) ? 0 : 1;
        at = static_cast<std::size_t>(rivers.receiver[at]);
    } while (std::isnan(rivers.lake_z[at]));
    float z = land.dem[rivers.cell[at]];
    for (; falls > 0; --falls) {
        z = std::max(z + 0x1p-13F, std::nextafter(z, 1e30F));
    }
    return z;
}

} // namespace

// A lake has its level to the bit, or the least one from which its water falls; water falls below it and into it, and
// nothing of all this costs the land its drainage.
TEST(Equilibrium, LakesHaveTheirLevels) {
    EXPECT_TRUE(rc::check("lakes have their levels", [] {
        Scene scene = any_scene();
        scene.room = Room::apart;
        add_lakes(scene.rivers, scene.params.seed);
        add_levels(scene.rivers, scene.params.seed);
        scene.fields.strata = {};
        EquilibriumTerrain const land = land_of(scene);
        Channels const& rivers = scene.rivers;
        auto const z = [&](std::size_t n) { return land.dem[rivers.cell[n]]; };
        auto const cells = river_cells(scene, land);
        for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
            if (!std::isnan(rivers.lake_z[n])) {
                RC_ASSERT(cells.contains(rivers.cell[n]));
                RC_ASSERT(z(n) == std::max(rivers.lake_z[n], least_level(scene, land, n)));
            }
            if (rivers.receiver[n] >= 0 && cells.contains(rivers.cell[n])) {
                auto const r = static_cast<std::size_t>(rivers.receiver[n]);
                RC_ASSERT((is_lake(rivers, n) ? z(n) == z(r) : z(n) > z(r)));
            }
        }
        RC_ASSERT(cells_in_depressions(scene, land.dem) == 0);
    }));
}

TEST(Equilibrium, LevelsThatNoLakeHasChangeNothing) {
    Scene scene = square(80);
    scene.rivers.level.assign(scene.rivers.cell.size(), 0);
    std::fill(scene.rivers.level.begin() + 20, scene.rivers.level.begin() + 30, std::uint8_t{1});
    Scene same = scene;
    same.rivers.lake_z.assign(same.rivers.cell.size(), std::numeric_limits<float>::quiet_NaN());
    auto const dem = [](Scene const& s) { return equilibrium(s.rivers, {}, s.params).dem; };
    EXPECT_TRUE(std::ranges::equal(dem(scene).values(), dem(same).values()));
    // The level that it has anyway leaves the terrain as high as it is.
    Raster<float> const without = dem(scene);
    same.rivers.lake_z[19] = without[scene.rivers.cell[19]];
    Raster<float> const with = dem(same);
    double sum = 0.0;
    for (std::int64_t i = 0; i < with.cells(); ++i) {
        sum += std::fabs(static_cast<double>(with[i]) - static_cast<double>(without[i]));
    }
    EXPECT_LT(sum / static_cast<double>(with.cells()), 2.0);
}

TEST(Equilibrium, LandRisesAndFallsWithALake) {
    Scene scene = square(160);
    scene.rivers.level.assign(scene.rivers.cell.size(), 0);
    std::fill(scene.rivers.level.begin() + 60, scene.rivers.level.begin() + 70, std::uint8_t{1});
    scene.params.region = 3.0;
    scene.params.bring_to_target = false;
    EquilibriumTerrain const free = equilibrium(scene.rivers, {}, scene.params);
    float const own = free.dem[scene.rivers.cell[59]];
    ASSERT_TRUE(free.in_region);
    for (float const by : {-0.9F * own, -5.0F, 5.0F, 40.0F, 150.0F}) {
        scene.rivers.lake_z.assign(scene.rivers.cell.size(), std::numeric_limits<float>::quiet_NaN());
        scene.rivers.lake_z[59] = own + by;
        EquilibriumTerrain const land = equilibrium(scene.rivers, {}, scene.params);
        EXPECT_TRUE(land.in_region);
        EXPECT_EQ(land.dem[scene.rivers.cell[0]], free.dem[scene.rivers.cell[0]]);
        EXPECT_EQ(land.dem[scene.rivers.cell[59]], own + by);
        EXPECT_EQ(land.dem[scene.rivers.cell[69]], own + by);
        // Halfway down the river has half the change, more or less, and upstream most of it.
        float const above = land.dem[scene.rivers.cell[80]] - free.dem[scene.rivers.cell[80]];
        EXPECT_GT(above / by, 0.6F) << by;
        EXPECT_LT(above / by, 1.4F) << by;
        float const middle = land.dem[scene.rivers.cell[30]] - free.dem[scene.rivers.cell[30]];
        EXPECT_GT(middle / by, 0.2F) << by;
        EXPECT_LT(middle / by, 0.8F) << by;
    }
}

TEST(Equilibrium, ALakeStandsAboveTheNextOne) {
    Scene scene = square(80);
    scene.rivers.level.assign(scene.rivers.cell.size(), 0);
    std::fill(scene.rivers.level.begin() + 11, scene.rivers.level.begin() + 20, std::uint8_t{1});
    std::fill(scene.rivers.level.begin() + 31, scene.rivers.level.begin() + 40, std::uint8_t{1});
    scene.rivers.lake_z.assign(scene.rivers.cell.size(), std::numeric_limits<float>::quiet_NaN());
    scene.rivers.lake_z[10] = 50.0F;
    scene.rivers.lake_z[30] = 20.0F;
    EquilibriumTerrain const land = equilibrium(scene.rivers, {}, scene.params);
    EXPECT_EQ(land.dem[scene.rivers.cell[15]], 50.0F);
    EXPECT_EQ(land.dem[scene.rivers.cell[35]], 50.0F + 11.0F * 0x1p-13F); // eleven cells above the lower lake
}

TEST(Equilibrium, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    Scene const scene = square(8);
    EXPECT_THROW(equilibrium(scene.rivers, {}, scene.params, run), Cancelled);
}

} // namespace equilibrium_test
