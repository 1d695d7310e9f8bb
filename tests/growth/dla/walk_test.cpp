// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/growth/dla/internal/walk.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <growth/chi_squared.hpp>
#include <growth/unit_step_dla.hpp>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/growth/dla/grow_dla.hpp>

namespace walk_test {

using namespace thalweg::growth;
using thalweg::Cell;
using thalweg::RandomStream;

namespace {

std::vector<Cell> small_cluster() {
    DlaParams params;
    params.particles = 250;
    params.sticking = 1.0;
    params.visits = 1;
    params.seed = 1;
    return grow_dla(params).cells;
}

using Bin = std::pair<std::int64_t, std::int64_t>;

std::vector<Bin> bins_of(std::vector<Cell> const& cells) {
    std::vector<Bin> bins;
    for (Cell const c : cells) {
        bins.emplace_back(c.col, c.row);
    }
    return bins;
}

std::vector<Bin> unit_step_hits(std::vector<Cell> const& cluster, std::int64_t walkers) {
    unit_step::Lattice lattice;
    for (Cell const c : cluster) {
        lattice.occupy({static_cast<std::int32_t>(c.col), static_cast<std::int32_t>(c.row)});
    }
    std::vector<Bin> bins;
    for (std::int64_t i = 0; i < walkers; ++i) {
        RandomStream random(1001, 2, static_cast<std::uint64_t>(i));
        unit_step::Steps steps(random);
        Site const hit = lattice.approach(lattice.launch_site(random), steps, random);
        bins.emplace_back(hit.x, hit.y);
    }
    return bins;
}

} // namespace

// Laws: a side has a quarter; x^4 - 6 x^2 y^2 + y^4 - x^2 - y^2 is harmonic on the lattice, so that its mean is 0.
TEST(ExitLaw, closed_form_keeps_means_of_harmonic_functions) {
    for (int const half : {1, 2, 7, 15, 31, 64, 248, 960, 3840}) {
        auto const p = exit_probabilities(half);
        double const l2 = static_cast<double>(half) * half;
        double side = 0.0;
        double mean = 0.0;
        for (std::size_t j = 0; j < p.size(); ++j) {
            double const weight = p[j] * (j == 0 ? 1.0 : 2.0);
            double const j2 = static_cast<double>(j) * static_cast<double>(j);
            side += weight;
            mean += weight * (l2 * l2 - 6.0 * l2 * j2 + j2 * j2 - l2 - j2);
        }
        EXPECT_NEAR(side, 0.25, 1e-12) << half;
        EXPECT_NEAR(mean / (l2 * l2), 0.0, 1e-12) << half;
    }
}

TEST(ExitLaw, takes_a_square_that_is_free) {
    ExitLaw law;
    law.prepare(5000);
    for (int free = 1; free < 10000; ++free) {
        ASSERT_LE(law.half_side(free), free);
        ASSERT_GE(law.half_side(free), std::min(free, 3840) * 4 / 5) << free;
    }
}

TEST(ExitLaw, tables_sample_the_closed_form) {
    ExitLaw law;
    law.prepare(64);
    for (int const half : {2, 7, 40}) {
        auto const p = exit_probabilities(half);
        int const along_side = 2 * half - 1;
        std::vector<std::int64_t> seen(static_cast<std::size_t>(4 * along_side), 0);
        RandomStream random(4, 1, static_cast<std::uint64_t>(half));
        for (int i = 0; i < 1000000; ++i) {
            auto const [x, y] = law.leave(half, random);
            ASSERT_EQ(std::max(std::abs(x), std::abs(y)), half);
            ASSERT_LT(std::min(std::abs(x), std::abs(y)), half);
            int const side = std::abs(x) == half ? (x > 0 ? 0 : 1) : (y > 0 ? 2 : 3);
            ++seen[static_cast<std::size_t>(side * along_side + (side < 2 ? y : x) + half - 1)];
        }
        std::vector<double> shares;
        for (int i = 0; i < 4 * along_side; ++i) {
            shares.push_back(p[static_cast<std::size_t>(std::abs(i % along_side - half + 1))]);
        }
        EXPECT_GT(chi_squared::against(seen, shares).p, 0.01) << half;
    }
}

// Laws: the square is free; up to distance 15 it is the largest; it is never smaller than 15 beyond.
TEST(FreeSquares, are_free_and_large) {
    ASSERT_TRUE(rc::check([] {
        auto const count = *rc::gen::inRange(1, 12);
        auto const spread = *rc::gen::element(20, 100, 700);
        FreeSquares squares;
        std::vector<Site> sites;
        for (int i = 0; i < count; ++i) {
            Site const s = {*rc::gen::inRange(-spread, spread + 1), *rc::gen::inRange(-spread, spread + 1)};
            sites.push_back(s);
            squares.reach(chebyshev(s));
            squares.occupy(s);
        }
        for (int i = 0; i < 300; ++i) {
            auto const half = 2 * squares.half();
            Site const s = {*rc::gen::inRange(-half, half), *rc::gen::inRange(-half, half)};
            std::int32_t distance = 1 << 20;
            for (Site const o : sites) {
                distance = std::min(distance, chebyshev({s.x - o.x, s.y - o.y}));
            }
            if (distance > 15) {
                RC_ASSERT(squares.free_half(s) >= 15);
                RC_ASSERT(squares.free_half(s) < distance);
            } else {
                RC_ASSERT(squares.occupied(s) == (distance == 0));
            }
            if (0 < distance && distance <= 15) {
                RC_ASSERT(squares.free_half(s) == distance - 1);
            }
        }
    }));
}

// Law: a stamp does what its sites do one by one.
TEST(FreeSquares, stamps_occupy_all_their_sites) {
    ASSERT_TRUE(rc::check([] {
        std::vector<Site> sites;
        for (int i = *rc::gen::inRange(1, 8); i > 0; --i) {
            sites.push_back({*rc::gen::inRange(-30, 31), *rc::gen::inRange(-30, 31)});
        }
        Stamp const stamp(sites);
        FreeSquares at_once;
        FreeSquares one_by_one;
        at_once.reach(200);
        one_by_one.reach(200);
        for (int i = 0; i < 3; ++i) {
            Site const middle{*rc::gen::inRange(-100, 101), *rc::gen::inRange(-100, 101)};
            at_once.occupy(middle, stamp);
            for (Site const s : sites) {
                one_by_one.occupy({middle.x + s.x, middle.y + s.y});
            }
        }
        for (std::int32_t y = -200; y <= 200; ++y) {
            for (std::int32_t x = -200; x <= 200; ++x) {
                RC_ASSERT(at_once.free_half({x, y}) == one_by_one.free_half({x, y}));
                RC_ASSERT(at_once.occupied({x, y}) == one_by_one.occupied({x, y}));
            }
        }
    }));
}

// Law: 1/z^k, k = 1 ... 4, is harmonic outside the circle and falls to 0, so that its mean over the hits is its value
// at the start, and 0 over births, which come from infinity. Rounding to the lattice shifts it by no more than
// 1/radius^2.
TEST(LaunchCircle, births_and_returns_keep_means_of_harmonic_functions) {
    LaunchCircle const circle = launch_circle(996.0);
    EXPECT_EQ(circle.radius, 1000.0);
    int const n = 400000;
    for (std::optional<Site> const from :
         {std::optional<Site>(), {Site{1100, 0}}, {Site{-800, 900}}, {Site{300, -4000}}}) {
        RandomStream random(6, 1, 1);
        std::array<std::complex<double>, 4> mean{};
        for (int i = 0; i < n; ++i) {
            Site const hit = from ? back_from_afar(circle, *from, random) : launch_site(circle, random);
            ASSERT_NEAR(std::sqrt(static_cast<double>(squared(hit))), circle.radius, 0.75);
            std::complex<double> const inverse = circle.radius / std::complex<double>(hit.x, hit.y);
            std::complex<double> power = 1.0;
            for (auto& m : mean) {
                power *= inverse;
                m += power / static_cast<double>(n);
            }
        }
        std::complex<double> const inverse = from ? circle.radius / std::complex<double>(from->x, from->y) : 0.0;
        std::complex<double> power = 1.0;
        for (auto const& m : mean) {
            power *= inverse;
            EXPECT_NEAR(std::abs(m - power), 0.0, 4.0 / std::sqrt(static_cast<double>(n)));
        }
    }
}

// Law: on a frozen cluster the fast walk and the walk by unit steps have one hit distribution; the test would see it if
// one hit in a hundred were displaced.
TEST(FirstArrivals, have_the_distribution_of_unit_steps) {
    EXPECT_THROW(first_arrivals({}, 1, 1), thalweg::BadInput);
    auto const cluster = small_cluster();
    auto const slow = unit_step_hits(cluster, 1000000);
    auto fast = bins_of(first_arrivals(cluster, 2000000, 501));
    auto const honest = chi_squared::two_samples(fast, slow);
    EXPECT_GT(honest.freedom, 100.0);
    EXPECT_GT(honest.p, 0.01) << "chi2 " << honest.x << " of " << honest.freedom;

    std::vector<Bin> sites = fast;
    std::ranges::sort(sites);
    sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
    for (std::size_t i = 0; i < fast.size(); i += 100) {
        auto const next = std::ranges::upper_bound(sites, fast[i]);
        fast[i] = next == sites.end() ? sites.front() : *next;
    }
    auto const planted = chi_squared::two_samples(fast, slow);
    EXPECT_LT(planted.p, 0.01) << "chi2 " << planted.x << " of " << planted.freedom;
}

} // namespace walk_test
