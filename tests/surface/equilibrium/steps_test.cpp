// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/surface/equilibrium/internal/land.hpp>
#include <thalweg/surface/equilibrium/internal/level.hpp>
#include <thalweg/surface/equilibrium/internal/river_cells.hpp>
#include <thalweg/surface/equilibrium/internal/start_level.hpp>

#include "channel_trees.hpp"

namespace steps_test {

using namespace thalweg;
using namespace thalweg::surface;

namespace {

/// Rivers at random in the frame of a closed land.
TerrainLevel any_level() {
    auto const width = *rc::gen::inRange<std::int64_t>(1, 25).as("width");
    auto const height = *rc::gen::inRange<std::int64_t>(1, 25).as("height");
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
    Grid const grid = test::frame(width, height, 10.0);
    auto const end = static_cast<std::int64_t>(random_word(seed, 1) % static_cast<std::uint64_t>(grid.cells()));
    Channels const rivers =
        channel_trees::grown(grid, {0, end}, {}, grid.cells() / 3 + 1, channel_trees::Room::crowd, seed);
    TerrainLevel level;
    level.width = width + 2;
    level.height = height + 2;
    EquilibriumParams closed;
    closed.edge = Edge::closed;
    level.rivers = padded(rivers, {}, closed).rivers;
    return level;
}

/// Rough land around such rivers, with some banks among it.
TerrainLevel any_land() {
    TerrainLevel level = any_level();
    auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("land");
    auto const cells = static_cast<std::size_t>(level.cells());
    level.type.assign(cells, CellType::outside);
    level.z.assign(cells, std::numeric_limits<float>::infinity());
    level.rock = Rock(Cells<float>(cells, 1.0F));
    each_inner(level, [&](std::size_t i) {
        level.type[i] = random_word(seed, 1, i) % 10 == 0 ? CellType::bank : CellType::land;
        level.z[i] = static_cast<float>(random_word(seed, 2, i) % 1000) * 0.01F;
        level.rock.set_cap(i, 0.1F + static_cast<float>(random_word(seed, 3, i) % 10) * 0.05F);
    });
    for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
        level.type[level.rivers.cell[n]] = CellType::river;
    }
    return level;
}

/// Any land with an open frame.
TerrainLevel any_open_land() {
    TerrainLevel level = any_land();
    auto const width = static_cast<std::size_t>(level.width);
    for (std::size_t i = 0; i < level.type.size(); ++i) {
        bool const inside = i % width > 0 && i % width + 1 < width && i >= width && i + width < level.type.size();
        level.type[i] = inside ? level.type[i] : CellType::boundary;
    }
    return level;
}

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

// Whole numbers below 512 have their power as a float; greater ones that of at most 1/256 less.
TEST(AreaPower, IsThePower) {
    AreaPower const power(0.45);
    for (int area = 1; area < 512; ++area) {
        EXPECT_EQ(power(static_cast<float>(area)), static_cast<float>(portable::pow(area, 0.45))) << area;
    }
    for (double area = 512.0; area < 0x1p40; area *= 1.37) {
        auto const value = static_cast<double>(power(static_cast<float>(area)));
        EXPECT_LE(value, portable::pow(area, 0.45) * (1.0 + 1e-6));
        EXPECT_GE(value, portable::pow(area * (1.0 - 1.0 / 256.0), 0.45) * (1.0 - 1e-6));
    }
}

// What is not in its table is the same.
TEST(AreaPower, IsTheSameBeyondItsTable) {
    AreaPower const all(0.45, 16.0, 2.0);
    AreaPower const few(0.45, 16.0, 2.0, 100.0);
    for (float area = 1.0F; area < 0x1p39F; area *= 1.13F) {
        EXPECT_EQ(few(area), all(area)) << area;
    }
}

// As A^theta far above the bend, level below.
TEST(AreaPower, BendsToALeast) {
    AreaPower const bent(0.45, 16.0);
    EXPECT_NEAR(bent(16.0F), std::sqrt(2.0) * std::pow(16.0, 0.45), 1e-5);
    EXPECT_NEAR(bent(1.0F), std::pow(16.0, 0.45), 0.05 * std::pow(16.0, 0.45));
    EXPECT_NEAR(bent(400.0F), std::pow(400.0, 0.45), 0.03 * std::pow(400.0, 0.45));
    for (int area = 1; area < 511; ++area) {
        EXPECT_LT(bent(static_cast<float>(area)), bent(static_cast<float>(area + 1)));
    }
}

// Without obstacles the nearest river by steps of 1 and sqrt(2) is known for each pair of cells.
TEST(NearestRiver, IsTheNearestOfAll) {
    EXPECT_TRUE(rc::check("nearest of all", [] {
        TerrainLevel const level = any_level();
        NearestRiver const near = nearest_river(level);
        for (std::int64_t row = 1; row + 1 < level.height; ++row) {
            for (std::int64_t col = 1; col + 1 < level.width; ++col) {
                auto const far = [&](std::uint32_t cell) {
                    std::int64_t const dx = std::abs(cell % level.width - col);
                    std::int64_t const dy = std::abs(cell / level.width - row);
                    return static_cast<double>(std::max(dx, dy) - std::min(dx, dy)) +
                           std::sqrt(2.0) * static_cast<double>(std::min(dx, dy));
                };
                double least = std::numeric_limits<double>::infinity();
                for (std::uint32_t const cell : level.rivers.cell) {
                    least = std::min(least, far(cell));
                }
                auto const i = static_cast<std::size_t>(row * level.width + col);
                RC_ASSERT(std::fabs(static_cast<double>(near.distance[i]) - least) < 1e-3);
                RC_ASSERT(std::fabs(far(level.rivers.cell[near.number[i]]) - least) < 1e-3);
            }
        }
    }));
}

// As nearest_river() where a river's head start is not used up, for any rows.
TEST(NearestRiver, IsTheSameRowsAtATime) {
    EXPECT_TRUE(rc::check("the same rows at a time", [] {
        TerrainLevel const level = any_level();
        std::vector<float> reach;
        std::vector<HeadStart> starts;
        float longest = 0.0F;
        for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
            reach.push_back(static_cast<float>(random_word(5, n) % 100) * 0.05F);
            starts.push_back({level.rivers.cell[n], static_cast<std::uint32_t>(n), reach.back()});
            longest = std::max(longest, reach.back());
        }
        std::sort(starts.begin(), starts.end(), [](HeadStart a, HeadStart b) { return a.cell < b.cell; });
        NearestRiver const all = nearest_river(level, reach);
        auto const beyond = static_cast<std::int64_t>(longest) + 2;
        for (std::int64_t row = 1; row + 1 < level.height; ++row) {
            std::int64_t const first = std::max<std::int64_t>(1, row - beyond);
            NearestRiver const some =
                nearest_in_rows(level, starts, first, std::min(level.height - 1, row + 1 + beyond));
            for (std::int64_t i = row * level.width; i < (row + 1) * level.width; ++i) {
                auto const at = static_cast<std::size_t>(i - (first - 1) * level.width);
                RC_ASSERT((some.distance[at] < 0.0F) == (all.distance[i] < 0.0F));
                if (all.distance[i] < 0.0F) {
                    RC_ASSERT(some.distance[at] == all.distance[i]);
                    RC_ASSERT(some.number[at] == all.number[i]);
                }
            }
        }
    }));
}

// Numbers that are set stand before those that follow from the fifth root.
TEST(Rock, HoldsWhatWasSet) {
    EXPECT_TRUE(rc::check("holds what was set", [] {
        auto const cells = *rc::gen::inRange<std::size_t>(1, 100).as("cells");
        auto const seed = *rc::gen::inRange<std::uint64_t>(0, 1U << 30).as("seed");
        Cells<float> root(cells);
        std::vector<float> erodibility(cells);
        std::vector<float> cap(cells);
        for (std::size_t i = 0; i < cells; ++i) {
            root[i] = 0.5F + static_cast<float>(random_word(seed, 1, i) % 100) * 0.01F;
            float const fourth = (root[i] * root[i]) * (root[i] * root[i]);
            erodibility[i] = fourth * root[i];
            cap[i] = steepest_tangent / fourth;
        }
        Rock rock(root);
        for (std::uint64_t k = 0; k < cells / 4; ++k) {
            std::size_t const i = random_word(seed, 2, k) % cells;
            auto const value = static_cast<float>(k + 1);
            k % 2 == 0 ? rock.set_cap(i, value) : rock.set_erodibility(i, value);
            (k % 2 == 0 ? cap : erodibility)[i] = value;
        }
        std::size_t const first = random_word(seed, 3) % cells;
        std::vector<float> row(cells - first);
        rock.caps(first, row);
        RC_ASSERT(std::equal(row.begin(), row.end(), cap.begin() + static_cast<std::ptrdiff_t>(first)));
        rock.erodibilities(first, row);
        RC_ASSERT(std::equal(row.begin(), row.end(), erodibility.begin() + static_cast<std::ptrdiff_t>(first)));
        for (std::size_t i = 0; i < cells; ++i) {
            RC_ASSERT(rock.cap(i) == cap[i]);
            RC_ASSERT(rock.erodibility(i) == erodibility[i]);
        }
    }));
}

// Areas are what is counted when each cell's water is followed to its end; no cell stands behind its receiver.
TEST(OrderCells, CountsWhatDrainsThrough) {
    EXPECT_TRUE(rc::check("counts what drains through", [] {
        TerrainLevel level = any_level();
        auto const cells = static_cast<std::size_t>(level.cells());
        level.type.assign(cells, CellType::outside);
        level.direction.assign(cells, no_direction);
        for (std::size_t n = 0; n < level.rivers.cell.size(); ++n) {
            // A forest as good as any; its ends are where water leaves.
            level.type[level.rivers.cell[n]] = level.rivers.receiver[n] < 0 ? CellType::boundary : CellType::land;
            level.direction[level.rivers.cell[n]] = level.rivers.direction[n];
        }
        std::vector<std::uint32_t> counted(cells);
        auto const offsets = level.offsets();
        for (std::size_t i = 0; i < cells; ++i) {
            for (std::size_t at = i;; at = moved(at, offsets[static_cast<std::size_t>(level.direction[at])])) {
                ++counted[at];
                if (level.direction[at] == no_direction) {
                    break;
                }
            }
        }
        for (int const threads : {1, 2, 3}) {
            thalweg::Run run;
            run.threads = threads;
            accumulate_areas(level, run, 3);
            for (std::size_t i = 0; i < cells; ++i) {
                RC_ASSERT(level.area[i] == counted[i]);
            }
            auto const draining =
                std::count_if(level.direction.begin(), level.direction.end(), [](std::int8_t d) { return d >= 0; });
            std::set<std::size_t> above;
            for (std::uint32_t const i : level.order) {
                RC_ASSERT(above.insert(i).second);
                RC_ASSERT(!above.contains(moved(i, offsets[static_cast<std::size_t>(level.direction[i])])));
            }
            bool const in_one_band = threads == 1 || level.height < 6;
            RC_ASSERT(std::ssize(above) == (in_one_band ? draining : 0));
            std::set<std::size_t> seen;
            std::mutex one_at_a_time;
            auto const visit = [&](std::size_t i) {
                std::lock_guard const lock(one_at_a_time);
                RC_ASSERT(seen.insert(i).second);
                std::size_t const below = moved(i, offsets[static_cast<std::size_t>(level.direction[i])]);
                RC_ASSERT(level.direction[below] == no_direction || seen.contains(below));
            };
            each_upstream(level, CellType::rim, run, visit, 5);
            RC_ASSERT(std::ssize(seen) == draining);
        }
    }));
}

// The order in which areas were counted leads to the same heights as one found from the directions.
TEST(RelaxTerrain, IsTheSameByAKeptOrder) {
    EXPECT_TRUE(rc::check("the same by a kept order", [] {
        TerrainLevel level = any_land();
        level.direction.assign(level.type.size(), no_direction);
        for (std::uint32_t const i : level.rivers.cell) {
            level.z[i] = 0.0F;
        }
        flood_terrain(level);
        thalweg::Run run;
        run.threads = 1;
        accumulate_areas(level, run);
        TerrainLevel without = level;
        without.order.clear();
        LandLaw const law{AreaPower(0.45, 4.0), 0.5F};
        Pull pull;
        if (*rc::gen::arbitrary<bool>().as("floor")) {
            pull.floor.assign(level.z.size(), 3.0F);
        }
        relax_terrain(level, law, pull, run);
        relax_terrain(without, law, pull, run);
        RC_ASSERT(level.z == without.z);
    }));
}

// Coarse rivers are trees as the fine ones are: downstream first, each cell once, each receiver a neighbour; a river
// cell lies in each coarse cell that has fine ones, and nowhere else.
TEST(CoarsenedRivers, AreTrees) {
    EXPECT_TRUE(rc::check("coarse rivers are trees", [] {
        TerrainLevel const level = any_level();
        std::int64_t const width = (level.width - 1) / 2 + 2;
        std::int64_t const height = (level.height - 1) / 2 + 2;
        RiverCells const coarse = coarsened(level.rivers, level.width, width, height);
        std::set<std::uint32_t> covered;
        for (std::uint32_t const cell : level.rivers.cell) {
            std::int64_t const row = (cell / level.width - 1) / 2 + 1;
            std::int64_t const col = (cell % level.width - 1) / 2 + 1;
            covered.insert(static_cast<std::uint32_t>(row * width + col));
        }
        std::set<std::uint32_t> const cells(coarse.cell.begin(), coarse.cell.end());
        RC_ASSERT(cells == covered);
        RC_ASSERT(cells.size() == coarse.cell.size());
        for (std::size_t n = 0; n < coarse.cell.size(); ++n) {
            RC_ASSERT(coarse.receiver[n] < static_cast<std::int32_t>(n));
            RC_ASSERT((coarse.receiver[n] < 0) == (coarse.direction[n] < 0));
        }
    }));
}

// The heights are what sweeps over all cells come to that lower each as far as any neighbour asks for.
TEST(SlideLand, IsTheGreatestThatMayStand) {
    ASSERT_TRUE(rc::check("the greatest heights that may stand", [] {
        TerrainLevel level = any_land();
        TerrainLevel plain = level;
        slide_terrain(level, {});
        auto const offsets = plain.offsets();
        for (bool more = true; more;) {
            more = false;
            each_inner(plain, [&](std::size_t i) {
                for (std::size_t k = 0; k < 8 && plain.type[i] == CellType::land; ++k) {
                    float const most =
                        plain.z[moved(i, offsets[k])] + 1.5F * plain.rock.cap(i) * plain.side * step_lengths[k];
                    more = more || plain.z[i] > most;
                    plain.z[i] = std::min(plain.z[i], most);
                }
            });
        }
        each_inner(plain, [&](std::size_t i) { RC_ASSERT(level.z[i] == plain.z[i]); });
    }));
}

// Land rises only, rivers fall only and stay above their receivers; nothing is perched above land any more.
TEST(Perched, IsLoweredOrHeldUp) {
    ASSERT_TRUE(rc::check("lowered or held up", [] {
        TerrainLevel level = any_land();
        RiverCells const& rivers = level.rivers;
        float const tangent = 0.5F;
        float const step = 0.002F;
        for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
            if (rivers.receiver[n] >= 0) {
                float const rise = random_word(7, n) % 8 == 0 ? 3.0F : 0.01F;
                level.z[rivers.cell[n]] = level.z[rivers.cell[static_cast<std::size_t>(rivers.receiver[n])]] + rise;
            }
        }
        Cells<float> const before = level.z;
        lower_perched(level, tangent, step);
        Cells<float> const lowered = level.z;
        raise_below_perched(level, tangent);
        for (std::size_t n = 0; n < rivers.cell.size(); ++n) {
            std::uint32_t const i = rivers.cell[n];
            RC_ASSERT(level.z[i] <= before[i]);
            RC_ASSERT(level.z[i] == lowered[i]);
            if (rivers.receiver[n] >= 0) {
                RC_ASSERT(level.z[i] >=
                          level.z[rivers.cell[static_cast<std::size_t>(rivers.receiver[n])]] + 0.5F * step);
            }
        }
        each_inner(level, [&](std::size_t i) {
            if (level.type[i] != CellType::river) {
                RC_ASSERT(lowered[i] == before[i]);
                RC_ASSERT(level.z[i] >= lowered[i]);
            }
        });
        for (std::int64_t const number : walled_cells(level, tangent * 1.0001F)) {
            auto const n = static_cast<std::size_t>(
                std::distance(rivers.number.begin(), std::find(rivers.number.begin(), rivers.number.end(), number)));
            // what it stands above is a river
            std::int64_t const col = rivers.cell[n] % level.width;
            std::int64_t const row = rivers.cell[n] / level.width;
            float lowest_land = std::numeric_limits<float>::infinity();
            for (std::int64_t r = row - 2; r <= row + 2; ++r) {
                for (std::int64_t c = col - 2; c <= col + 2; ++c) {
                    auto const i = static_cast<std::size_t>(r * level.width + c);
                    bool const on_ring = std::abs(r - row) == 2 || std::abs(c - col) == 2;
                    lowest_land =
                        on_ring && level.type[i] == CellType::land ? std::min(lowest_land, level.z[i]) : lowest_land;
                }
            }
            RC_ASSERT(level.z[rivers.cell[n]] <= lowest_land + tangent * 1.0001F * level.side);
        }
    }));
}

/// A straight river of even slope, from a head that stands by a height above a hollow two cells beyond.
TerrainLevel with_hollow(float tangent, float height) {
    constexpr std::int64_t row = 5;
    TerrainLevel level = level_of(80, 9, 100.0F);
    for (std::int64_t col = 80; col > 9; --col) {
        auto const n = static_cast<std::int32_t>(level.rivers.cell.size());
        add_spring(level, static_cast<std::size_t>(row * level.width + col));
        level.rivers.receiver.back() = n - 1;
        level.rivers.direction.back() = n == 0 ? no_direction : std::int8_t{0};
        level.z[level.rivers.cell.back()] = static_cast<float>(n) * tangent;
    }
    level.z[level.rivers.cell.back() - 2] = level.z[level.rivers.cell.back()] - height;
    return level;
}

// To be lowered to the hollow, a gentle river would have to lie in a trench far downstream.
TEST(Trenched, IsTheHeadOfAGentleRiver) {
    constexpr float tangent = 0.2F;
    TerrainLevel gentle = with_hollow(0.01F, 0.5F);
    auto const head = static_cast<std::int64_t>(gentle.rivers.cell.size()) - 1;
    std::size_t const cell = gentle.rivers.cell.back();
    EXPECT_EQ(remove_trenched_tips(gentle, tangent), std::vector<std::int64_t>{head});
    EXPECT_EQ(gentle.type[cell], CellType::bank);
    EXPECT_TRUE(remove_trenched_tips(gentle, tangent).empty());
    TerrainLevel steep = with_hollow(0.1F, 0.5F);
    EXPECT_TRUE(remove_trenched_tips(steep, tangent).empty());
    TerrainLevel shallow = with_hollow(0.01F, 0.25F);
    EXPECT_TRUE(remove_trenched_tips(shallow, tangent).empty());
}

TEST(LowerBanks, LeavesThemAboveRivers) {
    ASSERT_TRUE(rc::check("no bank stands higher above its river, or is lower than another one", [] {
        TerrainLevel level = any_flood_level();
        flood_terrain(level);
        float const rise = *rc::gen::element(0.5F, 2.0F).as("rise");
        float const step = 0.01F;
        auto const offsets = level.offsets();
        Cells<float> plain = level.z;
        each_inner(level, [&](std::size_t i) {
            if (is_bank(level.type[i])) {
                float const most = level.z[moved(i, offsets[static_cast<std::size_t>(level.direction[i])])] + rise;
                float const least = highest_river(level, i, offsets) + step;
                plain[i] = std::min(plain[i], std::max(most, least));
            }
        });
        lower_banks(level, rise, step);
        RC_ASSERT(level.z == plain);
    }));
}

// The land's edge is as high as the nearest river, also when heads have been given up and the others are counted anew.
TEST(EdgeHeights, AskNoNumbers) {
    ASSERT_TRUE(rc::check("edges keep their heights when rivers are counted anew", [] {
        TerrainLevel level = any_open_land();
        BoundaryCells const edge = boundary_cells(level, nearest_river(level), Beyond::rivers);
        RC_ASSERT(edge.ring.cell.size() == static_cast<std::size_t>(2 * (level.width + level.height) - 4));
        set_boundary_heights(level, edge);
        Cells<float> const before = level.z;
        level.rivers = {};
        set_boundary_heights(level, edge);
        RC_ASSERT(level.z == before);
    }));
}

// Valleys beyond the edge lie nowhere higher than rivers would, and above the lowest river or what touches them.
TEST(EdgeHeights, ValleysLieLowerThanRivers) {
    ASSERT_TRUE(rc::check("valleys lie lower", [] {
        TerrainLevel level = any_open_land();
        set_boundary_heights(level, boundary_cells(level, nearest_river(level), Beyond::rivers));
        Cells<float> const as_rivers = level.z;
        BoundaryCells const edge = boundary_cells(level, nearest_river(level), Beyond::valleys);
        set_boundary_heights(level, edge);
        float lowest = std::numeric_limits<float>::infinity();
        for (std::uint32_t const river : level.rivers.cell) {
            lowest = std::min(lowest, level.z[river]);
        }
        for (std::uint32_t const i : edge.ring.cell) {
            RC_ASSERT(level.z[i] <= as_rivers[i] + 1e-3F);
            RC_ASSERT(level.z[i] >= lowest - 1e-3F);
        }
    }));
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

/// flood_terrain() cell by cell, for land without banks and crests whose nodes lie at the centres of cells.
void flood_cell_by_cell(TerrainLevel& level) {
    constexpr std::size_t last_bucket = 65535;
    constexpr std::int8_t unreached = -2;
    float low = infinitely_high;
    float high = -infinitely_high;
    for (std::size_t i = 0; i < level.z.size(); ++i) {
        if (level.type[i] != CellType::outside) {
            low = std::min(low, level.z[i]);
            high = std::max(high, level.z[i]);
        }
    }
    std::vector<std::vector<std::size_t>> buckets(last_bucket + 1);
    std::size_t lowest = 0;
    auto const push = [&](std::size_t i) {
        float const place = high > low ? (level.z[i] - low) * (static_cast<float>(last_bucket) / (high - low)) : 0.0F;
        buckets[std::max(lowest, static_cast<std::size_t>(std::min(place, 65535.0F)))].push_back(i);
    };
    level.direction.assign(level.z.size(), no_direction);
    for (std::size_t i = 0; i < level.z.size(); ++i) {
        if (is_land(level.type[i])) {
            level.direction[i] = unreached;
        } else if (level.type[i] != CellType::outside) {
            push(i);
        }
    }
    for (; lowest <= last_bucket; ++lowest) {
        while (!buckets[lowest].empty()) {
            std::size_t const from = buckets[lowest].back();
            buckets[lowest].pop_back();
            each_beside(level, from, [&](std::size_t n, std::size_t k) {
                if (level.direction[n] == unreached) {
                    level.direction[n] = static_cast<std::int8_t>((k + 4) % 8);
                    level.z[n] = std::max(level.z[n], level.z[from] + level.least * level.side * step_lengths[k]);
                    push(n);
                }
            });
        }
    }
    for (std::size_t i = 0; i < level.z.size(); ++i) {
        if (level.direction[i] == unreached) {
            level.direction[i] = no_direction;
            level.type[i] = CellType::outside;
            level.z[i] = infinitely_high;
        }
    }
}

// A high peak makes buckets so wide that cells come to the bucket from which others are being taken.
TEST(FloodLand, IsTheFloodCellByCell) {
    ASSERT_TRUE(rc::check("the same directions and heights", [] {
        TerrainLevel level = *rc::gen::arbitrary<bool>().as("open") ? any_open_land() : any_flood_level();
        for (std::size_t i = 0; i < level.type.size(); ++i) {
            level.type[i] = is_land(level.type[i]) ? CellType::land : level.type[i];
            level.z[i] = level.type[i] == CellType::boundary ? static_cast<float>(i % 7) : level.z[i];
        }
        level.rivers.direction.assign(level.rivers.cell.size(), no_direction);
        auto const peak = *rc::gen::inRange<std::size_t>(0, level.z.size()).as("peak");
        if (is_land(level.type[peak])) {
            level.z[peak] = *rc::gen::element(10.0F, 1000.0F, 100000.0F).as("height");
        }
        TerrainLevel expected = level;
        flood_terrain(level);
        flood_cell_by_cell(expected);
        RC_ASSERT(level.direction == expected.direction);
        RC_ASSERT(level.z == expected.z);
        RC_ASSERT(level.type == expected.type);
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

} // namespace steps_test
