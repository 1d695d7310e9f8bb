// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/surface/equilibrium/match_texture.hpp>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace match_texture_test {

namespace {

using namespace thalweg;
using surface::TextureMatch;

} // namespace

TEST(MatchTexture, ATerrainThatFitsIsTheLast) {
    int made = 0;
    TextureMatch const found = surface::match_texture({0.55, 0.305}, 0.3, [&](double) { return ++made, 0.0; });
    EXPECT_EQ(made, 0);
    EXPECT_EQ(found.roughness, 0.55);
    EXPECT_EQ(found.correlation, 0.305);
}

TEST(MatchTexture, FindsTheRoughnessOfALineWithinItsRange) {
    ASSERT_TRUE(rc::check("the correlation falls evenly with the roughness", [] {
        double const fall = static_cast<double>(*rc::gen::inRange(10, 60)) / 100.0;
        double const there = static_cast<double>(*rc::gen::inRange(5, 83)) / 100.0;
        auto const line = [&](double roughness) { return 0.6 - fall * roughness; };
        int made = 0;
        TextureMatch const found = surface::match_texture({0.44, line(0.44)}, line(there), [&](double roughness) {
            RC_ASSERT(roughness >= 0.0 && roughness <= 0.88);
            return ++made, line(roughness);
        });
        RC_ASSERT(made <= 3);
        RC_ASSERT(std::fabs(found.correlation - line(there)) <= 0.01);
        RC_ASSERT(found.correlation == line(found.roughness));
    }));
}

TEST(MatchTexture, EndsWhereRoughnessReachesNoFurther) {
    std::vector<double> tried;
    TextureMatch const found = surface::match_texture({0.5, 0.4}, -0.9, [&](double roughness) {
        tried.push_back(roughness);
        return 0.6 - 0.2 * roughness;
    });
    EXPECT_EQ(tried, std::vector<double>{0.88});
    EXPECT_EQ(found.roughness, 0.88);
}

} // namespace match_texture_test
