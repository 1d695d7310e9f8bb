// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/core/numbers/ranks.hpp>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace ranks_test {

using thalweg::quantile;
using thalweg::rank_correlation;

TEST(Quantile, OfNothingIsUnknown) {
    EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
    EXPECT_TRUE(std::isnan(quantile({NAN, NAN}, 0.5)));
}

// In order 1, 2, 4, 8: 0.05 of the way is 0.15 of the first gap.
TEST(Quantile, IsLinearBetweenValues) {
    std::vector<double> const values = {4.0, NAN, 1.0, 8.0, 2.0};
    EXPECT_DOUBLE_EQ(quantile(values, 0.0), 1.0);
    EXPECT_DOUBLE_EQ(quantile(values, 0.05), 1.15);
    EXPECT_DOUBLE_EQ(quantile(values, 0.5), 3.0);
    EXPECT_DOUBLE_EQ(quantile(values, 0.95), 7.4);
    EXPECT_DOUBLE_EQ(quantile(values, 1.0), 8.0);
    EXPECT_DOUBLE_EQ(quantile({7.0}, 0.3), 7.0);
}

TEST(RankCorrelation, NeedsThreePlacesAndDifferences) {
    EXPECT_TRUE(std::isnan(rank_correlation({}, {})));
    EXPECT_TRUE(std::isnan(rank_correlation({1, 2, NAN}, {1, 2, 3})));
    EXPECT_TRUE(std::isnan(rank_correlation({1, 1, 1}, {1, 2, 3})));
}

// Ranks 1, 2.5, 2.5, 4, 5 and 1, 4, 2.5, 2.5, 5: covariance 7.25 over variances of 9.5.
TEST(RankCorrelation, EqualValuesHaveTheirMeanRank) {
    EXPECT_NEAR(rank_correlation({1, 2, 2, 4, 5}, {1, 3, 2, 2, 9}), 7.25 / 9.5, 1e-12);
    EXPECT_DOUBLE_EQ(rank_correlation({1, 2, NAN, 3}, {1, 10, 5, 1000}), 1.0);
    EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3}, {3, 2, 1}), -1.0);
}

TEST(RankCorrelation, IsThatOfAnyRisingFunction) {
    ASSERT_TRUE(rc::check([](std::vector<int> const& numbers) {
        std::vector<double> x;
        std::vector<double> y;
        std::vector<double> cubes;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            x.push_back(static_cast<double>(numbers[i] % 100));
            y.push_back(static_cast<double>((i * 7919) % 101));
            cubes.push_back(x.back() * x.back() * x.back());
        }
        double const plain = rank_correlation(x, y);
        RC_ASSERT((std::isnan(plain) && std::isnan(rank_correlation(cubes, y))) || plain == rank_correlation(cubes, y));
    }));
}

} // namespace ranks_test
