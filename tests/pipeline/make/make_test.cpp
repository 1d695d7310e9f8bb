// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/make.hpp>

#include <string>

#include <gtest/gtest.h>
#include <support.hpp>

namespace make_test {

using namespace thalweg;
using namespace thalweg::pipeline;

namespace {

std::string const rivers_of = "[grid]\nwidth = 96\nheight = 96\n[network]\nsource = \"tokunaga\"\n"
                              "[network.tokunaga]\norder = 4\n";

Recipe recipe_of_text(std::string const& text) {
    return read_recipe(text, "r.toml");
}

/// Two terrains around rivers that are grown once, and as two runs make them.
void expect_rivers_serve_both(std::string const& one, std::string const& two) {
    Planform const rivers = make_planform(resolve(recipe_of_text(rivers_of + one)));
    for (std::string const& surface : {one, two}) {
        Recipe const recipe = recipe_of_text(rivers_of + surface);
        Made const whole = make(recipe);
        Plan const plan = resolve(recipe);
        Terrain const terrain = make_terrain(plan, rivers);
        Assessment const assessment = assess(plan, rivers, terrain);
        EXPECT_TRUE(test::same_bits(terrain.surface->dem, whole.terrain.surface->dem));
        EXPECT_EQ(terrain.rivers.network.arc_z, whole.terrain.rivers.network.arc_z);
        EXPECT_EQ(write_recipe(recipe_of(plan, terrain)), write_recipe(whole.recipe));
        EXPECT_EQ(assessment.passed(), whole.assessment.passed());
        EXPECT_EQ(terrain.areas.ds_area_m2, whole.terrain.areas.ds_area_m2);
    }
}

} // namespace

// Law: stages keep nothing, so values may be used again.
TEST(Make, RiversServeTwoTerrains) {
    expect_rivers_serve_both("[surface]\nmean_slope = 15\n", "[surface]\nmean_slope = 30\n");
    expect_rivers_serve_both("[surface]\nmethod = \"dilate\"\n", "[surface]\nmethod = \"diffuse\"\n");
}

TEST(Make, RiversAloneHaveNoTerrain) {
    Made const made = make(recipe_of_text(rivers_of));
    EXPECT_FALSE(made.terrain.surface);
    EXPECT_FALSE(made.terrain.drainage);
    EXPECT_FALSE(made.assessment.given);
    EXPECT_GT(made.terrain.rivers.network.planform.arc_count(), 0U);
    EXPECT_TRUE(made.assessment.passed());
}

TEST(Make, LandAloneHasNoRivers) {
    Made const made = make(recipe_of_text("[grid]\nwidth = 64\nheight = 48\n[statistics]\nmean = 100\nstd = 10\n"));
    EXPECT_EQ(made.planform.network.arc_count(), 0U);
    EXPECT_EQ(made.terrain.grid, made.plan.grid);
    EXPECT_TRUE(made.terrain.drainage);
}

// Each value has its own timings; together they are those of the run.
TEST(Make, TimingsAreThoseOfTheValues) {
    Made const made = make(recipe_of_text(rivers_of + "[surface]\n"));
    EXPECT_EQ(made.plan.timings_s.front().first, "grow");
    EXPECT_EQ(made.planform.timings_s.front().first, "embed");
    EXPECT_EQ(made.terrain.timings_s.front().first, "channels");
    EXPECT_EQ(made.assessment.timings_s.back().first, "check");
    EXPECT_EQ(timings_of(made).size(), made.plan.timings_s.size() + made.planform.timings_s.size() +
                                           made.terrain.timings_s.size() + made.assessment.timings_s.size());
}

} // namespace make_test
