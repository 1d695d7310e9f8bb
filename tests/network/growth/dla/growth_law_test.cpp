// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the growth must look like: the measured laws of specification and literature, on means over several seeds.
#include <thalweg/network/growth/dla/grow_dla.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace growth_law_test {

using namespace thalweg::network;
using thalweg::Cell;

namespace {

Cluster grown(std::int64_t particles, double sticking, int visits, std::uint64_t seed,
              VisitRule rule = VisitRule::count_first) {
    DlaParams params;
    params.particles = particles;
    params.sticking = sticking;
    params.visits = visits;
    params.seed = seed;
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

} // namespace

TEST(GrowthLaw, mass_radius_dimension) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        sum += dimension(grown(50000, 1.0, 1, seed));
    }
    EXPECT_GE(sum / 10.0, 1.64);
    EXPECT_LE(sum / 10.0, 1.74);
    RecordProperty("dimension", std::to_string(sum / 10.0));
}

TEST(GrowthLaw, weaker_sticking_makes_thicker_branches) {
    double last = 1.0;
    for (auto const& [sticking, share] :
         {std::pair{0.1, 0.927}, {0.3, 0.548}, {0.5, 0.315}, {0.85, 0.130}, {1.0, 0.087}}) {
        double const measured = mean_of_three(sticking, 1, block_share);
        EXPECT_LT(measured, last);
        EXPECT_NEAR(measured, share, 0.01) << sticking;
        RecordProperty("share_" + std::to_string(std::lround(100.0 * sticking)), std::to_string(measured));
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
        RecordProperty("tortuosity_" + std::to_string(visits), std::to_string(path));
        RecordProperty("axis_order_" + std::to_string(visits), std::to_string(order));
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

} // namespace growth_law_test
