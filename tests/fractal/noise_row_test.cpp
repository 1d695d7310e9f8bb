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

namespace {

using namespace thalweg::fractal;
using thalweg::Lanes;
using thalweg::widest_lanes;

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

TEST(NoiseRow, EveryPartOfThePlaceMatters) {
    NoisePlace const here{5, 3, 9, 0};
    for (Noise const noise : {Noise::normal, Noise::uniform}) {
        auto const numbers = row_of(noise, here, 64);
        for (NoisePlace const& other : {NoisePlace{6, 3, 9, 0}, NoisePlace{5 + (std::uint64_t{1} << 32), 3, 9, 0},
                                        NoisePlace{5, 4, 9, 0}, NoisePlace{5, 3, 10, 0}, NoisePlace{5, 3, 9, 1}}) {
            EXPECT_NE(row_of(noise, other, 64), numbers);
        }
    }
}

/// Rows of noise as a field would have them.
std::vector<std::vector<float>> field(Noise noise, std::int64_t rows, std::size_t cols) {
    std::vector<std::vector<float>> out;
    for (std::int64_t row = 0; row < rows; ++row) {
        out.push_back(row_of(noise, {42, 6, row, row % 2}, cols));
    }
    return out;
}

/// Law: no correlation of numbers or of their squares along rows, along columns and within the vectors' width; five
/// standard errors.
void expect_independent(std::vector<std::vector<float>> const& noise, double fourth_moment) {
    for (auto const& [down, right] : {std::pair<std::size_t, std::size_t>{0, 1},
                                      {0, 2},
                                      {0, 4},
                                      {0, 8},
                                      {0, 16},
                                      {0, 32},
                                      {1, 0},
                                      {1, 1},
                                      {2, 0}}) {
        double products = 0.0;
        double squares = 0.0;
        double count = 0.0;
        for (std::size_t r = 0; r + down < noise.size(); ++r) {
            for (std::size_t c = 0; c + right < noise[r].size(); ++c) {
                auto const a = static_cast<double>(noise[r][c]);
                auto const b = static_cast<double>(noise[r + down][c + right]);
                products += a * b;
                squares += (a * a - 1.0) * (b * b - 1.0);
                count += 1.0;
            }
        }
        EXPECT_NEAR(products / count, 0.0, 5.0 / std::sqrt(count)) << down << " " << right;
        EXPECT_NEAR(squares / count, 0.0, 5.0 * (fourth_moment - 1.0) / std::sqrt(count)) << down << " " << right;
    }
}

TEST(NoiseRow, UniformNumbersAreUniform) {
    auto const noise = field(Noise::uniform, 512, 4096);
    std::vector<double> bins(1024);
    double squares = 0.0;
    for (auto const& row : noise) {
        for (float const z : row) {
            auto const u = static_cast<double>(z) / std::sqrt(3.0) * 0.5 + 0.5;
            bins[static_cast<std::size_t>(u * 1024.0)] += 1.0;
            squares += static_cast<double>(z) * static_cast<double>(z);
        }
    }
    double const each = 512.0 * 4096.0 / 1024.0;
    double chi_squared = 0.0;
    for (double const bin : bins) {
        chi_squared += (bin - each) * (bin - each) / each;
    }
    EXPECT_NEAR(chi_squared, 1023.0, 4.5 * std::sqrt(2.0 * 1023.0));
    EXPECT_NEAR(squares / (512.0 * 4096.0), 1.0, 5.0 * std::sqrt(0.8 / (512.0 * 4096.0)));
    expect_independent(noise, 1.8);
}

double beyond(double deviations) { // either side
    return std::erfc(deviations / std::sqrt(2.0));
}

TEST(NoiseRow, NormalNumbersAreNormalIntoTheTails) {
    auto const noise = field(Noise::normal, 4096, 4096);
    double const n = 4096.0 * 4096.0;
    std::array<double, 7> moments{};
    std::array<double, 5> tails{};
    std::array<double, 5> const limits = {2.0, 3.0, 4.0, 4.5, 5.0};
    std::vector<double> bins(64); // of an eighth of a deviation between -4 and 4
    for (auto const& row : noise) {
        for (float const number : row) {
            auto const z = static_cast<double>(number);
            double power = 1.0;
            for (double& moment : moments) {
                moment += power / n;
                power *= z;
            }
            for (std::size_t k = 0; k < limits.size(); ++k) {
                tails[k] += std::fabs(z) > limits[k] ? 1.0 : 0.0;
            }
            if (std::fabs(z) < 4.0) {
                bins[static_cast<std::size_t>((z + 4.0) * 8.0)] += 1.0;
            }
        }
    }
    // Variances of z^k: 1, 2, 15, 96, 945, 10170.
    std::array<double, 7> const truth = {1.0, 0.0, 1.0, 0.0, 3.0, 0.0, 15.0};
    std::array<double, 7> const variance = {1e-12, 1.0, 2.0, 15.0, 96.0, 945.0, 10170.0};
    for (std::size_t k = 0; k < moments.size(); ++k) {
        EXPECT_NEAR(moments[k], truth[k], 5.0 * std::sqrt(variance[k] / n)) << k;
    }
    for (std::size_t k = 0; k < limits.size(); ++k) {
        double const expected = n * beyond(limits[k]);
        EXPECT_NEAR(tails[k], expected, 4.5 * std::sqrt(expected)) << limits[k];
    }
    double chi_squared = 0.0;
    for (std::size_t k = 0; k < bins.size(); ++k) {
        double const low = -4.0 + static_cast<double>(k) / 8.0;
        double const expected = n * 0.5 * (std::erfc(low / std::sqrt(2.0)) - std::erfc((low + 0.125) / std::sqrt(2.0)));
        chi_squared += (bins[k] - expected) * (bins[k] - expected) / expected;
    }
    EXPECT_NEAR(chi_squared, 63.0, 4.5 * std::sqrt(2.0 * 63.0));
}

TEST(NoiseRow, NormalNumbersAreIndependent) {
    expect_independent(field(Noise::normal, 512, 4096), 3.0);
}

} // namespace

} // namespace noise_row_test
