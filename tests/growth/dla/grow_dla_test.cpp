// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the growth must look like: the measured laws of specification and literature, on means over several seeds.
#include <thalweg/growth/dla/grow_dla.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <growth/chi_squared.hpp>
#include <growth/unit_step_dla.hpp>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace grow_dla_test {

using namespace thalweg::growth;
using thalweg::BadInput;
using thalweg::BadParameter;
using thalweg::Cancelled;
using thalweg::Cell;

namespace {

using test::on_threads;

DlaParams dla(std::int64_t particles, double sticking, int visits, std::uint64_t seed) {
    DlaParams params;
    params.particles = particles;
    params.sticking = sticking;
    params.visits = visits;
    params.seed = seed;
    return params;
}

/// Touching pairs and the box of a cluster: what its shape shows without its place and turn.
using Shape = std::array<std::int64_t, 3>;

Shape shape(std::vector<Cell> const& cells) {
    std::int64_t touching = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            touching += std::abs(cells[i].col - cells[k].col) + std::abs(cells[i].row - cells[k].row) == 1;
        }
    }
    auto const [west, east] = std::ranges::minmax(cells, {}, &Cell::col);
    auto const [north, south] = std::ranges::minmax(cells, {}, &Cell::row);
    std::int64_t const width = east.col - west.col;
    std::int64_t const height = south.row - north.row;
    return {touching, std::min(width, height), std::max(width, height)};
}

Cluster grown(std::int64_t particles, double sticking, int visits, std::uint64_t seed,
              VisitRule rule = VisitRule::count_first) {
    DlaParams params = dla(particles, sticking, visits, seed);
    params.rule = rule;
    return grow_dla(params);
}

double distance_to_seed(Cell c) {
    return std::sqrt(static_cast<double>(c.col * c.col + c.row * c.row));
}

/// Exponent of N(r) ~ r^D by least squares over r in [0.1 Rg, Rg], 40 radii in geometric progression.
double dimension(Cluster const& cluster) {
    std::vector<double> r;
    double squares = 0.0;
    for (Cell const c : cluster.cells) {
        r.push_back(distance_to_seed(c));
        squares += r.back() * r.back();
    }
    std::ranges::sort(r);
    double const gyration = std::sqrt(squares / static_cast<double>(r.size()));
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (int i = 0; i < 40; ++i) {
        double const radius = 0.1 * gyration * std::pow(10.0, i / 39.0);
        double const log_r = std::log(radius);
        double const log_n = std::log(static_cast<double>(std::ranges::upper_bound(r, radius) - r.begin()));
        n += 1.0;
        x += log_r;
        y += log_n;
        xx += log_r * log_r;
        xy += log_r * log_n;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

/// Share of particles that are the north-west corner of a full 2 x 2 block.
double block_share(Cluster const& cluster) {
    std::vector<std::pair<std::int64_t, std::int64_t>> places;
    for (Cell const c : cluster.cells) {
        places.emplace_back(c.row, c.col);
    }
    std::ranges::sort(places);
    auto const has = [&](std::int64_t row, std::int64_t col) {
        return std::ranges::binary_search(places, std::pair{row, col});
    };
    double corners = 0.0;
    for (auto const& [row, col] : places) {
        corners += has(row, col + 1) && has(row + 1, col) && has(row + 1, col + 1) ? 1.0 : 0.0;
    }
    return corners / static_cast<double>(places.size());
}

/// Mean of path steps to the seed over |x| + |y|, of the particles beyond 0.8 R.
double tortuosity(Cluster const& cluster) {
    std::vector<double> steps(cluster.cells.size(), 0.0);
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t p = 1; p < steps.size(); ++p) {
        steps[p] = steps[static_cast<std::size_t>(cluster.parent[p])] + 1.0;
        Cell const c = cluster.cells[p];
        if (distance_to_seed(c) > 0.8 * cluster.radius) {
            sum += steps[p] / static_cast<double>(std::abs(c.col) + std::abs(c.row));
            count += 1.0;
        }
    }
    return sum / count;
}

/// Mean of cos 4 theta over the particles beyond 0.5 R: 1 when all lie on the axes.
double axis_order(Cluster const& cluster) {
    double sum = 0.0;
    double count = 0.0;
    for (Cell const c : cluster.cells) {
        if (distance_to_seed(c) > 0.5 * cluster.radius) {
            double const theta = std::atan2(static_cast<double>(c.row), static_cast<double>(c.col));
            sum += std::cos(4.0 * theta);
            count += 1.0;
        }
    }
    return sum / count;
}

template <class Measure> double mean_of_three(double sticking, int visits, Measure measure) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        sum += measure(grown(20000, sticking, visits, seed));
    }
    return sum / 3.0;
}

/// By the definition: every subtree is counted on its own.
std::vector<Cell> best_subtree(Cluster const& cluster, BranchChoice choice) {
    auto const inside = [choice](Cell c) {
        std::int64_t const along = choice == BranchChoice::north   ? -c.row
                                   : choice == BranchChoice::south ? c.row
                                   : choice == BranchChoice::east  ? c.col
                                                                   : -c.col;
        std::int64_t const across =
            choice == BranchChoice::north || choice == BranchChoice::south ? std::abs(c.col) : std::abs(c.row);
        return choice == BranchChoice::largest || (along > 0 && across <= along);
    };
    std::vector<Cell> best;
    std::ptrdiff_t most = 0;
    for (std::size_t root = 1; root < cluster.cells.size(); ++root) {
        if (choice == BranchChoice::largest && cluster.parent[root] != 0) {
            continue;
        }
        std::vector<Cell> tree;
        for (std::size_t p = root; p < cluster.cells.size(); ++p) {
            std::size_t at = p;
            while (at > root) {
                at = static_cast<std::size_t>(cluster.parent[at]);
            }
            if (at == root) {
                tree.push_back(cluster.cells[p]);
            }
        }
        std::ptrdiff_t const there = std::ranges::count_if(tree, inside);
        if (there > most && 4 * there >= 3 * static_cast<std::ptrdiff_t>(tree.size())) {
            most = there;
            best = tree;
        }
    }
    return best;
}

BranchParams choosing(BranchChoice choice) {
    BranchParams params;
    params.choice = choice;
    return params;
}

} // namespace

TEST(GrowDla, refuses_parameters_out_of_range_and_what_would_not_end) {
    DlaParams backwards;
    backwards.max_radius = -1;
    double const nan = std::numeric_limits<double>::quiet_NaN();
    for (DlaParams const& wrong :
         {dla(10, 0.0, 1, 7), dla(10, 1.0000001, 1, 7), dla(10, nan, 1, 7), dla(10, 1.0, 0, 7), dla(10, 1.0, 256, 7),
          dla(0, 1.0, 1, 7), dla(-3, 1.0, 1, 7), backwards, dla(1000, 1e-300, 1, 7), dla(2, 1e-6, 1, 7)}) {
        EXPECT_TRUE(test::refused<BadParameter>("growth.grow_dla", [&] { grow_dla(wrong); })) << wrong.sticking;
    }
    EXPECT_EQ(grow_dla(dla(1, 1e-300, 255, 7)).cells.size(), 1U) << "the seed alone";
    DlaParams narrow = dla(std::int64_t{1} << 40, 0.001, 1, 7);
    EXPECT_THROW(thalweg::growth::require_growth(narrow), BadParameter);
    narrow.max_radius = 30;
    EXPECT_NO_THROW(thalweg::growth::require_growth(narrow));
}

TEST(GrowDla, stops_at_the_radius) {
    DlaParams params = dla(100000, 1.0, 1, 7);
    params.max_radius = 50;
    Cluster const c = grow_dla(params);
    EXPECT_EQ(c.stop, GrowthStop::radius);
    EXPECT_GE(c.radius, 50.0);
    EXPECT_LT(c.radius, 51.0);
    Cell const last = c.cells.back();
    EXPECT_EQ(std::sqrt(static_cast<double>(last.col * last.col + last.row * last.row)), c.radius);
}

TEST(GrowDla, is_cancelled_by_the_token_and_by_progress) {
    EXPECT_THROW(grow_dla(dla(1000000, 1.0, 1, 7), test::stopped_run()), Cancelled);

    // Almost no arrival sticks: the growth must be stoppable while nothing grows.
    int calls = 0;
    thalweg::Run refused;
    refused.progress = [](double share, char const*, void* arg) {
        EXPECT_GE(share, 0.0);
        EXPECT_LE(share, 1.0);
        return ++*static_cast<int*>(arg) < 3 ? 1 : 0;
    };
    refused.progress_arg = &calls;
    EXPECT_THROW(grow_dla(dla(1000, 1e-5, 1, 7), refused), Cancelled);
    EXPECT_EQ(calls, 3);
}

// Laws: cells differ; each particle hangs on a 4-neighbour that arrived before it; every particle took a walker.
TEST(GrowDla, laws_of_a_cluster) {
    ASSERT_TRUE(rc::check([] {
        DlaParams params = dla(*rc::gen::inRange<std::int64_t>(1, 600), *rc::gen::element(1.0, 0.85, 0.3),
                               *rc::gen::inRange(1, 6), *rc::gen::arbitrary<std::uint64_t>());
        params.rule = *rc::gen::element(VisitRule::count_first, VisitRule::stick_then_count);
        Cluster const c = grow_dla(params);
        RC_ASSERT(c.stop == GrowthStop::particles);
        RC_ASSERT(static_cast<std::int64_t>(c.cells.size()) == params.particles);
        RC_ASSERT(c.parent.size() == c.cells.size());
        RC_ASSERT(c.cells[0] == Cell{});
        std::set<std::pair<std::int64_t, std::int64_t>> places;
        double radius = 0.0;
        for (std::size_t p = 0; p < c.cells.size(); ++p) {
            Cell const cell = c.cells[p];
            RC_ASSERT(places.emplace(cell.col, cell.row).second);
            radius = std::max(radius, std::sqrt(static_cast<double>(cell.col * cell.col + cell.row * cell.row)));
            if (p == 0) {
                RC_ASSERT(c.parent[p] == -1);
                continue;
            }
            RC_ASSERT((c.parent[p] >= 0 && c.parent[p] < static_cast<std::int64_t>(p)));
            Cell const on = c.cells[static_cast<std::size_t>(c.parent[p])];
            RC_ASSERT(std::abs(cell.col - on.col) + std::abs(cell.row - on.row) == 1);
        }
        RC_ASSERT(c.radius == radius);
        RC_ASSERT(c.walkers >= params.particles - 1);
        if (params.visits == 1) {
            RC_ASSERT(c.walkers == params.particles - 1);
        }
    }));
}

// Law: no field of Run changes a result. The memory has been widened several times at this size.
TEST(GrowDla, same_cells_for_any_number_of_threads_and_any_run) {
    DlaParams const params = dla(20000, 0.85, 3, 7);
    Cluster const first = grow_dla(params, on_threads(1));
    for (Cluster const& again : {grow_dla(params, on_threads(2)), grow_dla(params)}) {
        EXPECT_EQ(again.cells, first.cells);
        EXPECT_EQ(again.parent, first.parent);
        EXPECT_EQ(again.walkers, first.walkers);
    }
    EXPECT_NE(grow_dla(dla(20000, 0.85, 3, 8)).cells, first.cells);
}

TEST(GrowDla, a_longer_growth_continues_a_shorter) {
    Cluster const whole = grow_dla(dla(3000, 0.5, 2, 7));
    Cluster const part = grow_dla(dla(1000, 0.5, 2, 7));
    EXPECT_TRUE(std::equal(part.cells.begin(), part.cells.end(), whole.cells.begin()));
    EXPECT_TRUE(std::equal(part.parent.begin(), part.parent.end(), whole.parent.begin()));
}

TEST(GrowDla, golden) {
    Cluster const c = grow_dla(dla(30, 0.85, 3, 7));
    std::vector<Cell> const cells = {{0, 0},  {0, 1},  {1, 0},  {-1, 1},  {0, 2},  {-1, 2}, {0, -1}, {-2, 2},
                                     {-2, 1}, {0, -2}, {1, -1}, {1, 1},   {0, -3}, {-1, 3}, {-2, 3}, {-3, 1},
                                     {-3, 2}, {0, 3},  {1, -3}, {1, 2},   {0, -4}, {-2, 4}, {2, 1},  {2, 0},
                                     {0, -5}, {1, -4}, {0, 4},  {-1, -4}, {-2, 5}, {-3, 4}};
    std::vector<std::int64_t> const parent = {-1, 0,  0, 1,  1,  4,  0,  5,  7,  6,  6,  1,  9,  5,  13,
                                              8,  15, 4, 12, 11, 12, 14, 11, 22, 20, 20, 17, 20, 21, 21};
    EXPECT_EQ(c.cells, cells);
    EXPECT_EQ(c.parent, parent);
}

// Law: the growth by jumps makes each small shape as often as the rule written out over unit steps.
TEST(GrowDla, small_shapes_come_as_often_as_by_unit_steps) {
    for (VisitRule const rule : {VisitRule::count_first, VisitRule::stick_then_count}) {
        for (auto const& [sticking, visits] : {std::pair{0.4, 3}, {0.7, 1}, {1.0, 4}}) {
            std::vector<Shape> fast;
            std::vector<Shape> slow;
            std::int64_t fast_walkers = 0;
            std::int64_t slow_walkers = 0;
            for (std::uint64_t seed = 0; seed < 1500; ++seed) {
                DlaParams params = dla(9, sticking, visits, seed);
                params.rule = rule;
                Cluster const a = grow_dla(params);
                Cluster const b = unit_step::grow(params);
                fast.push_back(shape(a.cells));
                slow.push_back(shape(b.cells));
                fast_walkers += a.walkers;
                slow_walkers += b.walkers;
            }
            auto const test = chi_squared::two_samples(fast, slow);
            EXPECT_GT(test.freedom, 5.0);
            EXPECT_GT(test.p, 0.001) << sticking << " " << visits;
            EXPECT_NEAR(static_cast<double>(fast_walkers) / static_cast<double>(slow_walkers), 1.0, 0.02);
        }
    }
}

TEST(GrowthLaw, mass_radius_dimension) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        sum += dimension(grown(50000, 1.0, 1, seed));
    }
    EXPECT_GE(sum / 10.0, 1.64);
    EXPECT_LE(sum / 10.0, 1.74);
}

TEST(GrowthLaw, weaker_sticking_makes_thicker_branches) {
    double last = 1.0;
    for (auto const& [sticking, share] :
         {std::pair{0.1, 0.927}, {0.3, 0.548}, {0.5, 0.315}, {0.85, 0.130}, {1.0, 0.087}}) {
        double const measured = mean_of_three(sticking, 1, block_share);
        EXPECT_LT(measured, last);
        EXPECT_NEAR(measured, share, 0.01) << sticking;
        last = measured;
    }
}

TEST(GrowthLaw, more_visits_make_straighter_branches_along_the_axes) {
    double last = 2.0;
    for (int const visits : {1, 3, 10, 30}) {
        double path = 0.0;
        double order = 0.0;
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            Cluster const cluster = grown(20000, 1.0, visits, seed);
            path += tortuosity(cluster) / 3.0;
            order += axis_order(cluster) / 3.0;
        }
        EXPECT_LT(path, last);
        EXPECT_GE(path, 1.0);
        if (visits >= 3) {
            EXPECT_GT(order, 0.8) << visits;
        }
        last = path;
    }
}

TEST(GrowthLaw, walkers_for_each_particle) {
    EXPECT_NEAR(mean_of_three(0.85, 3,
                              [](Cluster const& c) {
                                  return static_cast<double>(c.walkers) / static_cast<double>(c.cells.size());
                              }),
                4.12, 0.05);
}

// Counting only what sticks thickens: 0.54 against 0.31 at S = 0.5, M = 3.
TEST(GrowthLaw, sticking_before_counting_is_thicker) {
    EXPECT_NEAR(block_share(grown(20000, 0.5, 3, 1)), 0.31, 0.02);
    EXPECT_NEAR(block_share(grown(20000, 0.5, 3, 1, VisitRule::stick_then_count)), 0.54, 0.02);
}

TEST(PickBranch, refuses_what_is_no_cluster_and_has_no_arm) {
    Cluster lone;
    lone.cells = {{0, 0}};
    lone.parent = {-1};
    EXPECT_EQ(pick_branch(lone, choosing(BranchChoice::all)).cells, lone.cells);
    Cluster row;
    row.cells = {{0, 0}, {1, 0}, {2, 0}};
    row.parent = {-1, 0, 1};
    Cluster broken = row;
    broken.parent.pop_back();
    std::vector<std::pair<Cluster, BranchChoice>> cases{{{}, BranchChoice::largest},
                                                        {lone, BranchChoice::largest},
                                                        {lone, BranchChoice::south},
                                                        {row, BranchChoice::west},
                                                        {broken, BranchChoice::largest}};
    for (std::int64_t const parent : {2, -1}) {
        cases.emplace_back(row, BranchChoice::largest).first.parent[2] = parent;
    }
    for (auto const& [cluster, choice] : cases) {
        EXPECT_TRUE(test::refused("growth.pick_branch", [&] { pick_branch(cluster, choosing(choice)); }));
    }
    EXPECT_THROW(pick_branch(row, {.max_width = -1}), BadParameter);
}

// Laws: three in four particles of an arm lie in its quadrant, and no subtree of which that holds has more there; the
// largest hangs on the seed; an arm is 4-connected and keeps the order of arrival; a cut branch is the longest
// beginning of the uncut one that fits the box.
TEST(PickBranch, laws_of_arms) {
    ASSERT_TRUE(rc::check([] {
        Cluster const cluster = grown(200, 0.85, 1, *rc::gen::inRange<std::uint64_t>(0, 1000));
        for (auto const choice : {BranchChoice::largest, BranchChoice::north, BranchChoice::east, BranchChoice::south,
                                  BranchChoice::west}) {
            Branch const arm = pick_branch(cluster, choosing(choice));
            RC_ASSERT(arm.cells == best_subtree(cluster, choice));
            for (std::size_t i = 1; i < arm.cells.size(); ++i) {
                RC_ASSERT(
                    std::any_of(arm.cells.begin(), arm.cells.begin() + static_cast<std::ptrdiff_t>(i), [&](Cell c) {
                        return std::abs(c.col - arm.cells[i].col) + std::abs(c.row - arm.cells[i].row) == 1;
                    }));
            }
            BranchParams boxed = choosing(choice);
            boxed.max_width = *rc::gen::inRange<std::int64_t>(1, 30);
            boxed.max_height = *rc::gen::inRange<std::int64_t>(1, 30);
            Branch const cut = pick_branch(cluster, boxed);
            RC_ASSERT(cut.cut == (cut.cells.size() < arm.cells.size()));
            RC_ASSERT(std::equal(cut.cells.begin(), cut.cells.end(), arm.cells.begin()));
            for (std::size_t n = cut.cells.size(); n <= cut.cells.size() + 1 && n <= arm.cells.size(); ++n) {
                std::span<Cell const> const first(arm.cells.data(), n);
                auto const [west, east] = std::ranges::minmax(first, {}, &Cell::col);
                auto const [north, south] = std::ranges::minmax(first, {}, &Cell::row);
                bool const fits = east.col - west.col < boxed.max_width && south.row - north.row < boxed.max_height;
                RC_ASSERT(fits == (n == cut.cells.size()));
            }
        }
    }));
}

} // namespace grow_dla_test
