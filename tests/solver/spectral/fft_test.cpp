// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/solver/spectral/fft.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/error.hpp>

namespace fft_test {

using namespace thalweg;
using solver::Complex;
using solver::Direction;
using solver::fft;

namespace {

using test::on_threads;

Raster<Complex> noise(std::int64_t width, std::int64_t height, std::uint64_t seed) {
    Raster<Complex> values(Grid{width, height, 1.0, 0.0, 0.0, ""});
    for (std::int64_t i = 0; i < values.cells(); ++i) {
        auto const words = random_block(seed, static_cast<std::uint64_t>(i));
        values[i] = {unit(words[0]) - 0.5, unit(words[1]) - 0.5};
    }
    return values;
}

/// The sum of the definition, with libm.
Raster<Complex> oracle(Raster<Complex> const& values, Direction direction) {
    Raster<Complex> sums(values.grid());
    double const turn = (direction == Direction::forward ? -2.0 : 2.0) * 3.14159265358979323846;
    for (std::int64_t i = 0; i < sums.cells(); ++i) {
        Cell const u = sums.grid().at(i);
        for (std::int64_t j = 0; j < values.cells(); ++j) {
            Cell const x = values.grid().at(j);
            double const cycles =
                static_cast<double>(u.col * x.col % values.width()) / static_cast<double>(values.width()) +
                static_cast<double>(u.row * x.row % values.height()) / static_cast<double>(values.height());
            sums[i] += values[j] * std::polar(1.0, turn * cycles);
        }
    }
    return sums;
}

double furthest(Raster<Complex> const& a, Raster<Complex> const& b) {
    double distance = 0.0;
    for (std::int64_t i = 0; i < a.cells(); ++i) {
        distance = std::max(distance, std::abs(a[i] - b[i]));
    }
    return distance;
}

} // namespace

TEST(Fft, NothingAndOneNumber) {
    EXPECT_EQ(fft(Raster<Complex>{}, Direction::forward).cells(), 0);
    Raster<Complex> one(Grid{1, 1, 1.0, 0.0, 0.0, ""});
    one[0] = {3.0, -2.0};
    EXPECT_EQ(fft(one, Direction::inverse)[0], (Complex{3.0, -2.0}));
}

TEST(Fft, GoodSizes) {
    EXPECT_EQ(solver::good_size(0), 2);
    EXPECT_EQ(solver::good_size(7), 8);
    EXPECT_EQ(solver::good_size(30), 30);
    EXPECT_EQ(solver::good_size(799), 800);
    EXPECT_EQ(solver::good_size(7201), 7290);
}

TEST(Fft, IsTheSumOfTheDefinition) {
    ASSERT_TRUE(rc::check("any size, primes among them", [] {
        auto const width = *rc::gen::inRange<std::int64_t>(1, 24);
        auto const height = *rc::gen::inRange<std::int64_t>(1, 24);
        auto const values = noise(width, height, *rc::gen::arbitrary<std::uint64_t>());
        for (auto const direction : {Direction::forward, Direction::inverse}) {
            RC_ASSERT(furthest(fft(values, direction), oracle(values, direction)) < 1e-12);
        }
    }));
}

TEST(Fft, ThereAndBackMultipliesByTheNumberOfCells) {
    auto const values = noise(360, 125, 3);
    auto back = fft(fft(values, Direction::forward), Direction::inverse);
    for (Complex& value : back.values()) {
        value /= static_cast<double>(values.cells());
    }
    EXPECT_LT(furthest(values, back), 1e-14);
}

TEST(Fft, SameBitsForAnyNumberOfThreads) {
    auto const values = noise(210, 147, 5);
    thalweg::Run run = on_threads(1);
    auto const one = fft(values, Direction::forward, run);
    for (int const threads : {2, 5}) {
        run.threads = threads;
        EXPECT_EQ(furthest(one, fft(values, Direction::forward, run)), 0.0);
    }
}

TEST(Fft, StopsWhenAsked) {
    std::stop_source source;
    source.request_stop();
    thalweg::Run run;
    run.stop = source.get_token();
    EXPECT_THROW(fft(noise(8, 8, 1), Direction::forward, run), Cancelled);
}

} // namespace fft_test
