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

#include <thalweg/core/numbers/random.hpp>

namespace flood_land_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

constexpr float infinitely_high = std::numeric_limits<float>::infinity();

/// Land of one height in a frame of nothing.
TerrainLevel level_of(std::int64_t width, std::int64_t height, float z) {
    TerrainLevel level;
    level.width = width + 2;
    level.height = height + 2;
    level.type.assign(static_cast<std::size_t>(level.cells()), CellType::outside);
    level.z.assign(level.type.size(), infinitely_high);
    each_inner(level, [&](std::size_t i) {
        level.type[i] = CellType::land;
        level.z[i] = z;
    });
    return level;
}

std::size_t cell_at(TerrainLevel const& level, std::int64_t col, std::int64_t row) {
    return static_cast<std::size_t>((row + 1) * level.width + col + 1);
}

/// A river of one cell, from which water leaves.
void add_spring(TerrainLevel& level, std::size_t cell) {
    level.type[cell] = CellType::river;
    level.rivers.cell.push_back(static_cast<std::uint32_t>(cell));
    level.rivers.receiver.push_back(-1);
    level.rivers.direction.push_back(no_direction);
    level.rivers.level.push_back(0);
    level.rivers.number.push_back(static_cast<std::int64_t>(level.rivers.number.size()));
}

/// Rough land with holes, some river cells with or without banks, and some of the sea.
TerrainLevel any_flood_level() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 12).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, 12).as("height");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    bool const banks = *rc::gen::arbitrary<bool>().as("banks");
    TerrainLevel level = level_of(width, height, 0.0F);
    level.side = *rc::gen::element(1.0F, 4.0F).as("side");
    each_inner(level, [&](std::size_t i) {
        level.z[i] = static_cast<float>(random_word(seed, 1, i) % 10);
        auto const kind = random_word(seed, 2, i) % 16;
        if (kind == 0) {
            add_spring(level, i);
        } else if (kind <= 3) {
            level.type[i] = CellType::outside;
            level.z[i] = infinitely_high;
        } else if (kind == 4) {
            level.type[i] = CellType::sea;
            level.z[i] = 0.0F;
        }
    });
    if (banks) {
        each_inner(level, [&](std::size_t i) {
            auto const offsets = level.offsets();
            bool const beside = std::any_of(offsets.begin(), offsets.end(), [&](std::int64_t offset) {
                return level.type[moved(i, offset)] == CellType::river;
            });
            if (level.type[i] == CellType::land && beside) {
                level.type[i] = CellType::bank;
            }
        });
    }
    return level;
}

/// Calls visit(neighbour, direction) for the cells of a level beside one.
template <class Visit> void each_beside(TerrainLevel const& level, std::size_t i, Visit visit) {
    auto const col = static_cast<std::int64_t>(i) % level.width;
    auto const row = static_cast<std::int64_t>(i) / level.width;
    for (std::size_t k = 0; k < d8_steps.size(); ++k) {
        std::int64_t const c = col + d8_steps[k].col;
        std::int64_t const r = row + d8_steps[k].row;
        if (c >= 0 && c < level.width && r >= 0 && r < level.height) {
            visit(static_cast<std::size_t>(r * level.width + c), k);
        }
    }
}

/// The least heights by definition: what water leaves from stays, all other land stands a step above some neighbour.
/// Infinite where no water can leave.
std::vector<double> least_heights(TerrainLevel const& level) {
    std::vector<double> least(level.z.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < least.size(); ++i) {
        if (level.type[i] == CellType::river || level.type[i] == CellType::sea) {
            least[i] = static_cast<double>(level.z[i]);
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < least.size(); ++i) {
            if (!is_land(level.type[i])) {
                continue;
            }
            each_beside(level, i, [&](std::size_t n, std::size_t k) {
                double const above =
                    least[n] + static_cast<double>(least_tangent * level.side) * static_cast<double>(step_lengths[k]);
                double const here = std::max(static_cast<double>(level.z[i]), above);
                if (here < least[i] - 1e-9) {
                    least[i] = here;
                    changed = true;
                }
            });
        }
    }
    return least;
}

} // namespace

TEST(FloodLand, LandWithoutAWayOutIsNone) {
    TerrainLevel level = level_of(3, 2, 5.0F);
    flood_terrain(level);
    for (std::size_t i = 0; i < level.type.size(); ++i) {
        EXPECT_EQ(level.type[i], CellType::outside);
        EXPECT_EQ(level.z[i], infinitely_high);
        EXPECT_EQ(level.direction[i], no_direction);
    }
}

TEST(FloodLand, OneRiverCellStays) {
    TerrainLevel level = level_of(1, 1, 5.0F);
    add_spring(level, cell_at(level, 0, 0));
    flood_terrain(level);
    EXPECT_EQ(level.type[cell_at(level, 0, 0)], CellType::river);
    EXPECT_EQ(level.z[cell_at(level, 0, 0)], 5.0F);
    EXPECT_EQ(level.direction[cell_at(level, 0, 0)], no_direction);
}

TEST(FloodLand, GivesUpOnlyTheIslandWithoutARiver) {
    TerrainLevel level = level_of(5, 1, 1.0F);
    level.type[cell_at(level, 2, 0)] = CellType::outside;
    level.z[cell_at(level, 2, 0)] = infinitely_high;
    level.z[cell_at(level, 0, 0)] = 0.0F;
    add_spring(level, cell_at(level, 0, 0));
    flood_terrain(level);
    EXPECT_EQ(level.type[cell_at(level, 1, 0)], CellType::land);
    EXPECT_EQ(level.direction[cell_at(level, 1, 0)], 4); // west
    EXPECT_EQ(level.z[cell_at(level, 1, 0)], 1.0F);
    EXPECT_EQ(level.type[cell_at(level, 3, 0)], CellType::outside);
    EXPECT_EQ(level.type[cell_at(level, 4, 0)], CellType::outside);
}

// A bank takes the steepest way and is raised above all river cells beside it, not only above its receiver.
TEST(FloodLand, BanksStandAboveAllRiversBesideThem) {
    TerrainLevel level = level_of(3, 1, 0.0F);
    add_spring(level, cell_at(level, 0, 0));
    add_spring(level, cell_at(level, 2, 0));
    level.z[cell_at(level, 2, 0)] = 4.0F;
    level.type[cell_at(level, 1, 0)] = CellType::bank;
    level.z[cell_at(level, 1, 0)] = 1.0F;
    flood_terrain(level);
    EXPECT_EQ(level.direction[cell_at(level, 1, 0)], 4); // west, down 1 m; the east is higher
    EXPECT_GT(level.z[cell_at(level, 1, 0)], 4.0F);
    EXPECT_LT(level.z[cell_at(level, 1, 0)], 4.01F);
}

TEST(FloodLand, EveryLandCellStandsAboveItsReceiver) {
    ASSERT_TRUE(rc::check("ways lead out, down by a step at least; no land is lowered", [] {
        TerrainLevel const before = any_flood_level();
        TerrainLevel level = before;
        flood_terrain(level);
        std::vector<double> const least = least_heights(before);
        auto const offsets = level.offsets();
        each_inner(level, [&](std::size_t i) {
            bool const was_land = is_land(before.type[i]);
            RC_ASSERT((was_land && std::isinf(least[i])) == (was_land && level.type[i] == CellType::outside));
            if (!is_land(level.type[i])) {
                RC_ASSERT(level.direction[i] == no_direction);
                RC_ASSERT((was_land || level.z[i] == before.z[i]));
                return;
            }
            RC_ASSERT(level.direction[i] >= 0);
            RC_ASSERT(level.z[i] >= before.z[i]);
            RC_ASSERT(static_cast<double>(level.z[i]) >= least[i] - 1e-4);
            auto const k = static_cast<std::size_t>(level.direction[i]);
            std::size_t const receiver = moved(i, offsets[k]);
            RC_ASSERT(level.type[receiver] != CellType::outside);
            RC_ASSERT(level.z[i] - level.z[receiver] >= 0.999F * least_tangent * level.side * step_lengths[k] - 1e-6F);
            if (is_bank(level.type[i])) {
                RC_ASSERT(level.type[receiver] == CellType::river);
                each_beside(level, i, [&](std::size_t n, std::size_t) {
                    RC_ASSERT((level.type[n] != CellType::river || level.z[i] > level.z[n]));
                });
            }
        });
    }));
}

// Heights in one bucket are taken in any order: that may raise a cell by the height of a bucket for each step. And a
// cell is settled by the first one that reaches it, across a corner though the next one would reach it across a side.
TEST(FloodLand, RaisesHardlyMoreThanTheLeast) {
    ASSERT_TRUE(rc::check("the least heights without banks, but for buckets", [] {
        TerrainLevel level = any_flood_level();
        for (CellType& type : level.type) {
            type = is_land(type) ? CellType::land : type;
        }
        std::vector<double> const least = least_heights(level);
        flood_terrain(level);
        double const bucket_m = 10.0 / 65535.0;
        double const corner_m = (std::sqrt(2.0) - 1.0) * static_cast<double>(least_tangent * level.side);
        double const slack = 1e-4 + static_cast<double>(level.cells()) * (bucket_m + corner_m);
        each_inner(level, [&](std::size_t i) {
            if (is_land(level.type[i])) {
                RC_ASSERT(static_cast<double>(level.z[i]) <= least[i] + slack);
            }
        });
    }));
}

} // namespace flood_land_test
