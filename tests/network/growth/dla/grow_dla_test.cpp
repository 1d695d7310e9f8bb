// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/network/growth/dla/grow_dla.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <stop_token>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <network/chi_squared.hpp>
#include <network/unit_step_dla.hpp>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace grow_dla_test {

using namespace thalweg::network;
using thalweg::BadParameter;
using thalweg::Cancelled;
using thalweg::Cell;

namespace {

using test::full_message_of;
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

} // namespace

TEST(GrowDla, one_particle_is_the_seed) {
    Cluster const c = grow_dla(dla(1, 0.85, 3, 7));
    EXPECT_EQ(c.cells, std::vector<Cell>{Cell{}});
    EXPECT_EQ(c.parent, std::vector<std::int64_t>{-1});
    EXPECT_EQ(c.walkers, 0);
    EXPECT_EQ(c.radius, 0.0);
    EXPECT_EQ(c.stop, GrowthStop::particles);
}

TEST(GrowDla, refuses_parameters_out_of_range) {
    for (double const s :
         {0.0, -0.5, 1.0000001, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(grow_dla(dla(10, s, 1, 7)), BadParameter) << s;
    }
    EXPECT_THROW(grow_dla(dla(10, 1.0, 0, 7)), BadParameter);
    EXPECT_THROW(grow_dla(dla(10, 1.0, 256, 7)), BadParameter);
    EXPECT_THROW(grow_dla(dla(0, 1.0, 1, 7)), BadParameter);
    EXPECT_THROW(grow_dla(dla(-3, 1.0, 1, 7)), BadParameter);
    DlaParams params;
    params.max_radius = -1;
    EXPECT_THROW(grow_dla(params), BadParameter);
    EXPECT_EQ(full_message_of<BadParameter>([&] { grow_dla(dla(10, 2.0, 1, 7)); }),
              "network.grow_dla: sticking is 2; it must be greater than 0 and at most 1");
}

TEST(GrowDla, most_visits_make_a_cross) {
    Cluster const c = grow_dla(dla(40, 1.0, 255, 7));
    EXPECT_EQ(c.cells.size(), 40U);
    EXPECT_GE(c.walkers, 39 * 255);
    EXPECT_TRUE(
        std::ranges::all_of(c.cells, [](Cell cell) { return std::min(std::abs(cell.col), std::abs(cell.row)) <= 1; }));
}

// S^2 = 1e-6: the second particle alone takes about a million arrivals.
TEST(GrowDla, weak_sticking_makes_a_blob) {
    Cluster const c = grow_dla(dla(60, 0.02, 1, 7));
    EXPECT_EQ(c.cells.size(), 60U);
    EXPECT_LT(c.radius, 8.0);
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
    std::stop_source source;
    source.request_stop();
    thalweg::Run stopped;
    stopped.stop = source.get_token();
    EXPECT_THROW(grow_dla(dla(1000000, 1.0, 1, 7), stopped), Cancelled);

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
    thalweg::Run const one = on_threads(1);
    thalweg::Run const two = on_threads(2);
    Cluster const first = grow_dla(params, one);
    for (Cluster const& again : {grow_dla(params, two), grow_dla(params)}) {
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

TEST(GrowDla, what_would_not_end_is_refused_before_it_begins) {
    for (double const sticking : {1e-300, 1e-100, 1e-6}) {
        EXPECT_THROW(grow_dla(dla(1000, sticking, 1, 7)), BadParameter) << sticking;
        EXPECT_THROW(grow_dla(dla(2, sticking, 1, 7)), BadParameter) << sticking;
    }
    EXPECT_EQ(grow_dla(dla(1, 1e-300, 1, 7)).cells.size(), 1U) << "the seed alone";
    DlaParams narrow = dla(std::int64_t{1} << 40, 0.001, 1, 7);
    EXPECT_THROW(thalweg::network::require_growth(narrow), BadParameter);
    narrow.max_radius = 30;
    EXPECT_NO_THROW(thalweg::network::require_growth(narrow));
}

} // namespace grow_dla_test
