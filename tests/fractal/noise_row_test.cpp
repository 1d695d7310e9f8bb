// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/midpoint.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Random123/philox.h>
#include <gtest/gtest.h>

namespace noise_row_test {

using namespace thalweg::fractal;
using thalweg::Lanes;
using thalweg::widest_lanes;

namespace {

std::vector<float> row_of(Noise noise, NoisePlace const& place, std::size_t count, Lanes lanes = widest_lanes()) {
    std::vector<float> out(count);
    for (std::size_t i = 0; i < count; i += 4096) {
        std::size_t const part = std::min<std::size_t>(4096, count - i);
        noise_row(noise, place, static_cast<std::int64_t>(i), std::span(out).subspan(i, part), lanes);
    }
    return out;
}

/// 32-bit words of a place in the order the numbers take them, by the reference implementation.
std::vector<std::uint32_t> words_of(NoisePlace const& place, std::uint32_t blocks) {
    std::vector<std::uint32_t> words;
    for (std::uint32_t group = 0; group < blocks; group += 4) {
        std::array<r123::Philox4x32::ctr_type, 4> out;
        for (std::uint32_t k = 0; k < 4; ++k) {
            r123::Philox4x32::ctr_type const counter = {{group + k, static_cast<std::uint32_t>(place.row),
                                                         static_cast<std::uint32_t>(place.row >> 32),
                                                         static_cast<std::uint32_t>(2 * place.level + place.odd)}};
            r123::Philox4x32::key_type const key = {
                {static_cast<std::uint32_t>(place.seed), static_cast<std::uint32_t>(place.seed >> 32)}};
            out[k] = r123::Philox4x32{}(counter, key);
        }
        for (std::size_t half = 0; half < 4; half += 2) {
            for (auto const& block : out) {
                words.push_back(block[half]);
                words.push_back(block[half + 1]);
            }
        }
    }
    return words;
}

NoisePlace const places[] = {
    {1, 1, 0, 0}, {~std::uint64_t{0}, 30, (std::int64_t{1} << 39) + 5, 1}, {0x123456789abcdefULL, 7, 4711, 1}};

} // namespace

TEST(NoiseRow, UniformNumbersAreSlicesOfPhilox) {
    for (NoisePlace const& place : places) {
        auto const words = words_of(place, 24);
        auto const numbers = row_of(Noise::uniform, place, 2 * words.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            auto const slice = static_cast<std::int16_t>(words[i / 2] >> (16 * (i % 2)));
            EXPECT_EQ(numbers[i], (static_cast<float>(slice) + 0.5F) * (1.7320508F * 0x1p-15F));
        }
    }
}

TEST(NoiseRow, NormalNumbersAreThoseOfBoxAndMuller) {
    for (NoisePlace const& place : places) {
        auto const words = words_of(place, 400);
        auto const numbers = row_of(Noise::normal, place, words.size());
        for (std::size_t i = 0; i < numbers.size(); i += 16) {
            for (std::size_t k = i; k < i + 8; ++k) {
                double const u = (static_cast<double>(words[k] >> 1) + 0.5) * 0x1p-31;
                auto const turn = static_cast<std::int32_t>(words[k + 8]);
                double const angle = std::acos(-1.0) / 4.0 * (static_cast<double>(turn >> 2) + 0.5) * 0x1p-29;
                double const radius = std::sqrt(-2.0 * std::log(u)) * ((turn & 2) != 0 ? -1.0 : 1.0);
                bool const swapped = (turn & 1) != 0;
                double const near_one = 1e-7 / std::max(1e-3, std::fabs(radius)); // where u is rounded to 24 bits
                EXPECT_NEAR(static_cast<double>(numbers[k]), radius * (swapped ? std::sin(angle) : std::cos(angle)),
                            2e-6 + near_one);
                EXPECT_NEAR(static_cast<double>(numbers[k + 8]), radius * (swapped ? std::cos(angle) : std::sin(angle)),
                            2e-6 + near_one);
            }
        }
    }
}

TEST(NoiseRow, IsTheSameForAnySplitAndAnyInstructions) {
    for (Noise const noise : {Noise::normal, Noise::uniform}) {
        for (NoisePlace const& place : places) {
            auto const whole = row_of(noise, place, 320);
            EXPECT_EQ(row_of(noise, place, 320, Lanes::plain), whole);
            for (std::size_t first = 0; first < 320; first += 32) {
                for (std::size_t count = 32; first + count <= 320; count += 96) {
                    std::vector<float> part(count);
                    noise_row(noise, place, static_cast<std::int64_t>(first), part, widest_lanes());
                    EXPECT_TRUE(
                        std::equal(part.begin(), part.end(), whole.begin() + static_cast<std::ptrdiff_t>(first)));
                }
            }
        }
    }
}

} // namespace noise_row_test
