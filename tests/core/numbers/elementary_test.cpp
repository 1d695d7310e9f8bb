// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/elementary.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <thalweg/core/numbers/elementary_rows.hpp>
#include <thalweg/core/numbers/random.hpp>
#include <thalweg/core/run/lanes.hpp>

namespace elementary_test {

namespace portable = thalweg::portable;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t trials = 400000;

/// Error of a value in units of the last place of the true one, which long double gives to 2^-11 of that unit.
double ulps(double value, long double truth) {
    if (value == static_cast<double>(truth)) {
        return 0.0;
    }
    double const near = std::max(std::fabs(static_cast<double>(truth)), std::numeric_limits<double>::min());
    double const unit = std::nextafter(near, inf) - near;
    return static_cast<double>(std::fabs((static_cast<long double>(value) - truth) / static_cast<long double>(unit)));
}

double between(double low, double high, std::uint64_t stage, std::uint64_t i) {
    return low + (high - low) * thalweg::unit(thalweg::random_word(11, stage, i));
}

/// Any positive normal number, every binade as likely.
double any_positive(std::uint64_t stage, std::uint64_t i) {
    std::uint64_t const word = thalweg::random_word(12, stage, i);
    return std::bit_cast<double>((word >> 12) | ((word % 2046 + 1) << 52));
}

/// FNV-1a over the bits of a row of values.
struct BitHash {
    std::uint64_t value = 0xcbf29ce484222325ULL;
    void add(double x) { value = (value ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3ULL; }
};

} // namespace

TEST(Elementary, special_values_of_exp_log_and_pow) {
    EXPECT_EQ(portable::exp(0.0), 1.0);
    EXPECT_EQ(portable::exp(-0.0), 1.0);
    EXPECT_EQ(portable::exp(inf), inf);
    EXPECT_EQ(portable::exp(-inf), 0.0);
    EXPECT_EQ(portable::exp(710.0), inf);
    EXPECT_EQ(portable::exp(-746.0), 0.0);
    EXPECT_TRUE(std::isnan(portable::exp(no_number)));

    EXPECT_EQ(portable::log(1.0), 0.0);
    EXPECT_EQ(portable::log(0.0), -inf);
    EXPECT_EQ(portable::log(inf), inf);
    EXPECT_TRUE(std::isnan(portable::log(-1.0)));
    EXPECT_TRUE(std::isnan(portable::log(no_number)));

    EXPECT_EQ(portable::pow(1.0, no_number), 1.0);
    EXPECT_EQ(portable::pow(no_number, 0.0), 1.0);
    EXPECT_EQ(portable::pow(0.0, 0.0), 1.0);
    EXPECT_EQ(portable::pow(0.0, 2.0), 0.0);
    EXPECT_EQ(portable::pow(0.0, -2.0), inf);
    EXPECT_EQ(portable::pow(inf, 0.5), inf);
    EXPECT_EQ(portable::pow(inf, -0.5), 0.0);
    EXPECT_EQ(portable::pow(2.0, inf), inf);
    EXPECT_EQ(portable::pow(2.0, -inf), 0.0);
    EXPECT_EQ(portable::pow(0.5, inf), 0.0);
    EXPECT_EQ(portable::pow(2.0, 1e300), inf);
    EXPECT_EQ(portable::pow(2.0, -1e300), 0.0);
    EXPECT_TRUE(std::isnan(portable::pow(-2.0, 2.0)));
    EXPECT_TRUE(std::isnan(portable::pow(2.0, no_number)));
    for (int k = -1074; k < 1024; ++k) {
        ASSERT_EQ(portable::pow(2.0, k), std::ldexp(1.0, k)) << k;
    }
}

TEST(Elementary, special_values_of_angles) {
    EXPECT_EQ(portable::sin(0.0), 0.0);
    EXPECT_EQ(portable::cos(0.0), 1.0);
    EXPECT_TRUE(std::isnan(portable::sin(inf)));
    EXPECT_TRUE(std::isnan(portable::cos(1.1e5)));
    EXPECT_TRUE(std::isnan(portable::sin(no_number)));

    for (double const y : {0.0, -0.0, 1.0, -1.0, inf, -inf}) {
        for (double const x : {0.0, -0.0, 1.0, -1.0, inf, -inf}) {
            EXPECT_EQ(portable::atan2(y, x), std::atan2(y, x)) << y << " " << x;
            EXPECT_EQ(std::signbit(portable::atan2(y, x)), std::signbit(y)) << y << " " << x;
        }
    }
    EXPECT_TRUE(std::isnan(portable::atan2(no_number, 1.0)));
    EXPECT_TRUE(std::isnan(portable::atan2(1.0, no_number)));
}

TEST(Elementary, exp_is_within_two_units_of_the_last_place) {
    double worst = 0.0;
    for (std::uint64_t i = 0; i < trials; ++i) {
        for (double const x : {between(-745.0, 709.7, 0, i), between(-2.0, 2.0, 1, i), between(-1e-6, 1e-6, 2, i)}) {
            worst = std::max(worst, ulps(portable::exp(x), std::exp(static_cast<long double>(x))));
        }
    }
    EXPECT_LE(worst, 2.0);
    RecordProperty("worst_ulps", std::to_string(worst));
}

TEST(Elementary, log_is_within_two_units_of_the_last_place) {
    double worst = 0.0;
    for (std::uint64_t i = 0; i < trials; ++i) {
        for (double const x : {any_positive(0, i), between(0.5, 2.0, 3, i), 1.0 + between(-1e-6, 1e-6, 4, i),
                               between(0.0, 1e-310, 5, i)}) {
            worst = std::max(worst, ulps(portable::log(x), std::log(static_cast<long double>(x))));
        }
    }
    EXPECT_LE(worst, 2.0);
    RecordProperty("worst_ulps", std::to_string(worst));
}

TEST(Elementary, pow_is_within_two_units_of_the_last_place) {
    double worst = 0.0;
    for (std::uint64_t i = 0; i < trials; ++i) {
        double const wide = any_positive(1, i);
        double const near_one = 1.0 + between(-1e-9, 1e-9, 6, i);
        double const tame = between(0.0, 20.0, 7, i);
        for (auto const& [x, y] : {std::pair{wide, between(-3.0, 3.0, 8, i)},
                                   {near_one, between(-6e11, 6e11, 9, i)},
                                   {tame, between(-20.0, 20.0, 10, i)},
                                   {tame, 0.5},
                                   {tame, 2.0}}) {
            long double const truth = std::pow(static_cast<long double>(x), static_cast<long double>(y));
            if (truth < static_cast<long double>(std::numeric_limits<double>::max())) {
                worst = std::max(worst, ulps(portable::pow(x, y), truth));
            }
        }
    }
    EXPECT_LE(worst, 2.0);
    RecordProperty("worst_ulps", std::to_string(worst));
}

TEST(Elementary, sin_and_cos_are_within_two_units_of_the_last_place) {
    double worst = 0.0;
    for (std::uint64_t i = 0; i < trials; ++i) {
        double const by_a_quarter = std::round(between(-63000.0, 63000.0, 11, i)) * (0.5 * portable::pi);
        for (double const x : {between(-1e5, 1e5, 12, i), between(-7.0, 7.0, 13, i), between(-1e-5, 1e-5, 14, i),
                               by_a_quarter, std::nextafter(by_a_quarter, 0.0)}) {
            worst = std::max(worst, ulps(portable::sin(x), std::sin(static_cast<long double>(x))));
            worst = std::max(worst, ulps(portable::cos(x), std::cos(static_cast<long double>(x))));
        }
    }
    EXPECT_LE(worst, 2.0);
    RecordProperty("worst_ulps", std::to_string(worst));
}

TEST(Elementary, atan2_row_has_the_bits_of_atan2) {
    std::vector<double> y = {0.0, 5e-324, 1e-300, 1e300, 1.0, no_number, std::numeric_limits<double>::infinity()};
    for (std::uint64_t i = 0; i < 100'000; ++i) {
        y.push_back(portable::exp(between(-3.0, 3.0, 27, i)));
        y.push_back(static_cast<double>(i % 1000) / 16.0);
    }
    using thalweg::Lanes;
    y.push_back(2.5); // their number is not a multiple of four
    for (double const x : {1.0, 30.0, 5e-324, 1e-3, 1e300}) {
        for (Lanes const lanes : {Lanes::plain, thalweg::widest_lanes()}) {
            std::vector<double> angles(y.size());
            portable::atan2_row(y, x, angles, lanes);
            for (std::size_t i = 0; i < y.size(); ++i) {
                double const wanted = portable::atan2(y[i], x);
                ASSERT_TRUE(angles[i] == wanted || (std::isnan(angles[i]) && std::isnan(wanted))) << y[i] << " " << x;
            }
        }
    }
}

TEST(Elementary, atan2_is_within_two_units_of_the_last_place) {
    double worst = 0.0;
    for (std::uint64_t i = 0; i < trials; ++i) {
        double const far = any_positive(2, i);
        double const near = any_positive(3, i);
        double const x = between(-1.0, 1.0, 15, i);
        double const y = between(-1.0, 1.0, 16, i);
        for (auto const& [b, a] : {std::pair{far, near}, {-far, near}, {y, x}, {y, 1e-3 * x}, {1e-3 * y, x}}) {
            worst = std::max(worst, ulps(portable::atan2(b, a),
                                         std::atan2(static_cast<long double>(b), static_cast<long double>(a))));
        }
    }
    EXPECT_LE(worst, 2.0);
    RecordProperty("worst_ulps", std::to_string(worst));
}

TEST(Elementary, has_the_same_bits_everywhere) {
    BitHash hash;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        hash.add(portable::exp(between(-700.0, 700.0, 20, i)));
        hash.add(portable::log(any_positive(4, i)));
        hash.add(portable::pow(between(0.0, 20.0, 21, i), between(-20.0, 20.0, 22, i)));
        hash.add(portable::sin(between(-1e5, 1e5, 23, i)));
        hash.add(portable::cos(between(-1e5, 1e5, 24, i)));
        hash.add(portable::atan2(between(-1.0, 1.0, 25, i), between(-1.0, 1.0, 26, i)));
    }
    EXPECT_EQ(hash.value, 0xb35ab6d3889225bfULL) << std::hex << hash.value;
}

} // namespace elementary_test
