// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/internal/steps.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/flow/direction.hpp>

namespace written_land_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

/// A straight river from the middle of the west border into rough land, solved as far as a flood does.
struct SolvedLand {
    Grid grid;
    Mask land; ///< without cells: all
    std::int64_t margin = 0;
    Channels rivers;
    TerrainLevel level;

    Window window() const { return {grid, land, margin}; }
};

SolvedLand solved_land(std::int64_t width, std::int64_t height, std::int64_t margin, std::uint64_t seed) {
    SolvedLand out;
    out.grid = {width, height, 10.0, 0.0, 10.0 * static_cast<double>(height), ""};
    out.margin = margin;
    out.rivers.grid = out.grid;
    TerrainLevel& level = out.level;
    level.width = width + 2 * margin + 2;
    level.height = height + 2 * margin + 2;
    level.type.assign(static_cast<std::size_t>(level.cells()), CellType::outside);
    level.z.assign(level.type.size(), std::numeric_limits<float>::infinity());
    each_inner(level, [&](std::size_t i) {
        level.type[i] = CellType::land;
        level.z[i] = static_cast<float>(random_word(seed, i) % 1000) * 0.01F;
    });
    std::int64_t const row = height / 2;
    for (std::int64_t col = 0; col < (width + 1) / 2; ++col) {
        auto const i = static_cast<std::size_t>((row + margin + 1) * level.width + col + margin + 1);
        out.rivers.cell.push_back(out.grid.index({col, row}));
        out.rivers.receiver.push_back(col - 1);
        level.type[i] = CellType::river;
        level.z[i] = 0.1F * static_cast<float>(col + 1);
        level.rivers.cell.push_back(static_cast<std::uint32_t>(i));
        level.rivers.receiver.push_back(static_cast<std::int32_t>(col) - 1);
        level.rivers.direction.push_back(col == 0 ? no_direction : std::int8_t{4}); // to the west
        level.rivers.level.push_back(0);
        level.rivers.number.push_back(col);
    }
    auto const offsets = level.offsets();
    each_inner(level, [&](std::size_t i) {
        bool const beside = std::any_of(offsets.begin(), offsets.end(), [&](std::int64_t offset) {
            return level.type[moved(i, offset)] == CellType::river;
        });
        if (level.type[i] == CellType::land && beside) {
            level.type[i] = CellType::bank;
        }
    });
    flood_terrain(level);
    set_stack_order(level);
    return out;
}

SolvedLand any_solved_land() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 16).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, 16).as("height");
    auto const margin = *rc::gen::inRange<std::int64_t>(0, 3).as("margin");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    return solved_land(width, height, margin, seed);
}

EquilibriumParams with_relief(double relief_m) {
    EquilibriumParams params;
    params.relief_m = relief_m;
    return params;
}

double level_height(SolvedLand const& land, Cell c) {
    return static_cast<double>(
        land.level.z[static_cast<std::size_t>((c.row + land.margin + 1) * land.level.width + c.col + land.margin + 1)]);
}

/// By definition: highest less lowest cell of the caller's grid, in the solver's units.
double range_by_definition(SolvedLand const& land) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::int64_t i = 0; i < land.grid.cells(); ++i) {
        low = std::min(low, level_height(land, land.grid.at(i)));
        high = std::max(high, level_height(land, land.grid.at(i)));
    }
    return high - low;
}

/// A direction of steepest descent, as nearly as doubles tell; -1 where nothing is lower.
void require_steepest(Raster<float> const& dem, Cell c, flow::Direction direction) {
    double steepest = 0.0;
    double chosen = 0.0;
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        Cell const n{c.col + d8_steps[k].col, c.row + d8_steps[k].row};
        if (!dem.grid().contains(n) || std::isnan(dem[n])) {
            continue;
        }
        double const fall = static_cast<double>(dem[c]) - static_cast<double>(dem[n]);
        double const slope = fall / (k % 2 == 0 ? 1.0 : std::sqrt(2.0));
        steepest = std::max(steepest, slope);
        chosen = flow::direction_of(k) == direction ? slope : chosen;
    }
    RC_ASSERT(flow::goes_on(direction) == (steepest > 0.0));
    RC_ASSERT(chosen >= steepest * (1.0 - 1e-12));
}

} // namespace

TEST(WrittenLand, OneCell) {
    SolvedLand const land = solved_land(1, 1, 0, 7);
    EquilibriumTerrain const out =
        extract_terrain(land.level, land.rivers, land.window(), {10.0, -1.0, 0.5}, {}, Heads::cut, {});
    ASSERT_EQ(out.dem.cells(), 1);
    EXPECT_NEAR(out.dem[0], 0.0, 1e-6); // 0.1 of 10 m, less 1 m
    EXPECT_TRUE(out.direction[0] == flow::Direction::leaves);
    EXPECT_TRUE(out.shortened.empty());
    EXPECT_EQ(out.rise, 1.0);
}

TEST(WrittenLand, RaiseGivesTheReliefThatIsAsked) {
    ASSERT_TRUE(rc::check("highest less lowest cell is the relief; the lowest river end stands at 0", [] {
        SolvedLand const land = any_solved_land();
        double const relief_m = *rc::gen::element(1.0, 250.0).as("relief");
        HeightConversion const raise =
            height_conversion_for(land.level, land.rivers, land.window(), with_relief(relief_m));
        double const range = range_by_definition(land);
        RC_ASSERT((range == 0.0 || std::fabs(range * raise.metres - relief_m) < 1e-6 * relief_m));
        double const end = level_height(land, land.grid.at(land.rivers.cell[0]));
        RC_ASSERT(std::fabs(end * raise.metres + raise.base_m) < 1e-9 * (1.0 + std::fabs(raise.base_m)));
        double const share = share_of_target(land.level, land.window(), 0.5 * raise.metres, with_relief(relief_m));
        RC_ASSERT((range == 0.0 || std::fabs(share - 0.5) < 1e-6));
    }));
}

TEST(WrittenLand, DrainsDownItsOwnFloats) {
    ASSERT_TRUE(
        rc::check("rivers go to their receivers, land down the steepest slope, and nothing is a depression", [] {
            SolvedLand const land = any_solved_land();
            HeightConversion const raise =
                height_conversion_for(land.level, land.rivers, land.window(), with_relief(100.0));
            EquilibriumTerrain const out =
                extract_terrain(land.level, land.rivers, land.window(), raise, {}, Heads::cut, {});
            RC_ASSERT(out.dem.grid() == land.grid);
            RC_ASSERT(std::is_sorted(out.shortened.begin(), out.shortened.end()));
            std::vector<bool> river(static_cast<std::size_t>(land.grid.cells()), false);
            for (std::size_t n = 0; n < land.rivers.cell.size(); ++n) {
                if (std::binary_search(out.shortened.begin(), out.shortened.end(), static_cast<std::int64_t>(n))) {
                    continue;
                }
                std::int64_t const i = land.rivers.cell[n];
                river[static_cast<std::size_t>(i)] = true;
                RC_ASSERT((out.direction[i] == (n == 0 ? flow::Direction::leaves : flow::Direction::west)));
                RC_ASSERT((n == 0 || out.dem[i] > out.dem[land.rivers.cell[n - 1]]));
            }
            RC_ASSERT(river[static_cast<std::size_t>(land.rivers.cell[0])]);
            for (std::int64_t i = 0; i < land.grid.cells(); ++i) {
                if (!river[static_cast<std::size_t>(i)]) {
                    require_steepest(out.dem, land.grid.at(i), out.direction[i]);
                    RC_ASSERT((flow::goes_on(out.direction[i]) || land.grid.on_border(land.grid.at(i))));
                }
            }
        }));
}

TEST(WrittenLand, TheSeaHasNoHeight) {
    SolvedLand land = solved_land(6, 5, 1, 3);
    land.land = Mask(land.grid, 1);
    land.land[Cell{5, 4}] = 0;
    EquilibriumTerrain const out =
        extract_terrain(land.level, land.rivers, land.window(), {10.0, 0.0, 0.5}, {}, Heads::cut, {});
    for (std::int64_t i = 0; i < land.grid.cells(); ++i) {
        EXPECT_EQ(std::isnan(out.dem[i]), land.land[i] == 0);
        EXPECT_EQ(out.direction[i] == flow::Direction::no_data, land.land[i] == 0);
    }
}

TEST(WrittenLand, FixedHeightsAreKept) {
    SolvedLand land = solved_land(9, 7, 1, 5);
    for (std::size_t n = 0; n < land.rivers.cell.size(); ++n) {
        land.rivers.z.push_back(3.0F + static_cast<float>(n));
    }
    EquilibriumTerrain const out =
        extract_terrain_with_heights(land.level, land.rivers, land.window(), {10.0, 0.0, 0.5}, RiverHeights::fixed, {});
    for (std::size_t n = 0; n < land.rivers.cell.size(); ++n) {
        EXPECT_EQ(out.dem[land.rivers.cell[n]], land.rivers.z[n]);
    }
    EXPECT_EQ(out.max_lowered_m, 0.0);
    EXPECT_TRUE(out.shortened.empty());
}

TEST(WrittenLand, SoftHeightsAreUpperBounds) {
    SolvedLand land = solved_land(9, 7, 1, 5);
    for (std::size_t n = 0; n < land.rivers.cell.size(); ++n) {
        land.rivers.z.push_back(0.5F * static_cast<float>(n));
    }
    EquilibriumTerrain const out =
        extract_terrain_with_heights(land.level, land.rivers, land.window(), {10.0, 0.0, 0.5}, RiverHeights::soft, {});
    double greatest = 0.0;
    for (std::size_t n = 0; n < land.rivers.cell.size(); ++n) {
        float const z = out.dem[land.rivers.cell[n]];
        EXPECT_LE(z, land.rivers.z[n] + 1e-4F);
        greatest = std::max(greatest, static_cast<double>(land.rivers.z[n]) - static_cast<double>(z));
    }
    EXPECT_NEAR(out.max_lowered_m, greatest, 1e-9);
    EXPECT_LE(out.p95_lowered_m, out.max_lowered_m);
}

} // namespace written_land_test
