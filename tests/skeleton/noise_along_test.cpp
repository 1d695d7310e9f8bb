// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/skeleton/draw_skeleton.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stop_token>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/core/run/error.hpp>

namespace noise_along_test {

using namespace thalweg;
using skeleton::noise_along;
using skeleton::NoiseAlongParams;
using skeleton::PlaceOnLine;

namespace {

using test::has;
using test::message_of;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Places in the middle of lines, along a parallel.
std::vector<PlaceOnLine> parallel(int count, double apart_m) {
    std::vector<PlaceOnLine> places;
    for (int i = 0; i < count; ++i) {
        places.push_back({{500000.0 + apart_m * i, 4000000.0}, 0.5});
    }
    return places;
}

/// Mean square of a - b for values so many apart.
double rise(std::vector<double> const& values, std::size_t lag) {
    double sum = 0.0;
    for (std::size_t i = lag; i < values.size(); ++i) {
        sum += (values[i] - values[i - lag]) * (values[i] - values[i - lag]);
    }
    return sum / static_cast<double>(values.size() - lag);
}

} // namespace

TEST(NoiseAlong, RefusesWhatIsNoNoiseOrNoLine) {
    EXPECT_TRUE(noise_along({}, {}).empty());
    EXPECT_THROW(noise_along({}, {}, {.amplitude_m = -1.0}), BadParameter);
    EXPECT_THROW(noise_along({}, {}, {.amplitude_m = not_a_number}), BadParameter);
    EXPECT_THROW(noise_along({}, {}, {.wavelength_m = 0.0}), BadParameter);
    EXPECT_THROW(noise_along({}, {}, {.wavelength_m = not_a_number}), BadParameter);
    for (PlaceOnLine const& bad : {PlaceOnLine{{not_a_number, 0.0}, 0.5},
                                   {{0.0, not_a_number}, 0.5},
                                   {{0.0, 0.0}, -0.1},
                                   {{0.0, 0.0}, 1.1},
                                   {{0.0, 0.0}, not_a_number}}) {
        EXPECT_THROW(noise_along({bad}, {}), BadInput);
    }
    EXPECT_THROW(noise_along({{{2e6, 0.0}, 0.5}}, {}, {.wavelength_m = 1.0}), BadInput);
    EXPECT_THROW(noise_along({{{2.0, 0.0}, 0.5}}, {}, {.amplitude_m = 1.0, .wavelength_m = 1e-308}), BadInput);
    EXPECT_TRUE(has(message_of<BadInput>([&] {
                        noise_along({{{1.0, 2.0}, 0.5}, {{3.0, 4.0}, 2.0}}, {});
                    }),
                    "place 1 at (3, 4)"));
    std::stop_source stop;
    stop.request_stop();
    thalweg::Run run;
    run.stop = stop.get_token();
    EXPECT_THROW(noise_along(parallel(3, 1.0), {}, {}, run), Cancelled);
}

TEST(NoiseAlong, IsZeroInTheEndsAndWithinTheAmplitude) {
    ASSERT_TRUE(rc::check([] {
        auto const seed = *rc::gen::arbitrary<std::uint64_t>();
        double const amplitude = *rc::gen::element(0.0, 0.5, 30.0, 1000.0);
        Vec2 const at{static_cast<double>(*rc::gen::inRange(-1000000, 1000000)) / 7.0,
                      static_cast<double>(*rc::gen::inRange(-1000000, 1000000)) / 7.0};
        std::vector<PlaceOnLine> places;
        for (int i = 0; i <= 16; ++i) {
            places.push_back({at, i / 16.0});
        }
        auto const noise = noise_along(places, {}, {seed, amplitude, 300.0});
        RC_ASSERT(noise.front() == 0.0);
        RC_ASSERT(noise.back() == 0.0);
        for (int i = 0; i <= 16; ++i) {
            // At one place the noise follows the share alone.
            double const here = noise[static_cast<std::size_t>(i)];
            RC_ASSERT(std::fabs(here) <= amplitude);
            RC_ASSERT(std::fabs(here - noise[8] * 4.0 * (i / 16.0) * (1.0 - i / 16.0)) <= 1e-12 * amplitude);
        }
    }));
}

TEST(NoiseAlong, CountsFromTheOrigin) {
    auto const places = parallel(200, 32.0);
    auto moved = places;
    for (PlaceOnLine& place : moved) {
        place.at = {place.at.x + 65536.0, place.at.y - 4096.0};
    }
    NoiseAlongParams const params{7, 40.0, 1024.0};
    Vec2 const origin{500000.0, 4000000.0};
    EXPECT_EQ(noise_along(places, origin, params), noise_along(moved, {origin.x + 65536.0, origin.y - 4096.0}, params));
    EXPECT_NE(noise_along(places, origin, params), noise_along(moved, origin, params));
}

TEST(NoiseAlong, IsAFieldOfFourOctaves) {
    for (std::uint64_t const seed : {1U, 2U, 3U}) {
        // 1024 places a wavelength, 40 wavelengths.
        auto const f = noise_along(parallel(40 * 1024, 1.0), {500000.0, 4000000.0}, {seed, 100.0, 1024.0});
        EXPECT_GT(*std::max_element(f.begin(), f.end()), 15.0);
        EXPECT_LT(*std::min_element(f.begin(), f.end()), -15.0);
        // A fractal down to an eighth of the wavelength: each doubling of the lag less than doubles the rise's root;
        // smooth below: it doubles it.
        EXPECT_NEAR(std::sqrt(rise(f, 4) / rise(f, 2)), 2.0, 0.02);
        EXPECT_NEAR(std::sqrt(rise(f, 8) / rise(f, 4)), 2.0, 0.05);
        EXPECT_LT(std::sqrt(rise(f, 256) / rise(f, 128)), 1.8);
        EXPECT_LT(std::sqrt(rise(f, 4096) / rise(f, 2048)), 1.25);
    }
}

TEST(NoiseAlong, EverySeedHasItsOwn) {
    auto const places = parallel(64, 100.0);
    std::vector<std::vector<double>> all;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        all.push_back(noise_along(places, {500000.0, 4000000.0}, {seed, 1.0, 1000.0}));
        all.push_back(noise_along(places, {500000.0, 4000000.0}, {seed << 40U, 1.0, 1000.0}));
    }
    all.erase(all.begin() + 1); // 0 << 40
    std::sort(all.begin(), all.end());
    EXPECT_EQ(std::unique(all.begin(), all.end()), all.end());
}

} // namespace noise_along_test
