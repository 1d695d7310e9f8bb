// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/condition.hpp>

#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <support.hpp>

#include <thalweg/recipe/recipe_keys.hpp>
#include <thalweg/recipe/stages.hpp>

namespace condition_test {

using namespace thalweg;
using namespace thalweg::recipe;

namespace {

Condition const diffused_or_tin = ask::is(&SurfaceRecipe::method, {Method::diffuse, Method::tin});
Condition const with_points = ask::given(&SkeletonRecipe::points);

/// A recipe with some sections, and some keys that conditions ask for.
Recipe any_recipe() {
    Recipe recipe;
    if (*rc::gen::arbitrary<bool>()) {
        NetworkRecipe& network = recipe.network.emplace();
        network.source = *rc::gen::element(Source::dla, Source::tokunaga, Source::forest, Source::lines);
        network.heights = *rc::gen::element(Heights::automatic, Heights::graded, Heights::rosgen, Heights::file);
        network.meander = *rc::gen::element(std::optional<double>(), std::optional(0.0), std::optional(1.0));
        network.fill_space = *rc::gen::arbitrary<bool>();
        network.tokunaga.strokes = *rc::gen::element<std::string>("", "strokes.gpkg");
    }
    if (*rc::gen::arbitrary<bool>()) {
        SurfaceRecipe& surface = recipe.surface.emplace();
        surface.method =
            *rc::gen::element(Method::equilibrium, Method::dilate, Method::diffuse, Method::tin, Method::raster);
        surface.base = *rc::gen::element(Base::harmonic, Base::tin);
        surface.drain = *rc::gen::element(std::optional<flow::Conditioning>(), std::optional(flow::Conditioning::carve),
                                          std::optional(flow::Conditioning::none));
        surface.dilate.relief_m = *rc::gen::element(0.0, 300.0);
    }
    if (*rc::gen::arbitrary<bool>()) {
        SkeletonRecipe& skeleton = recipe.skeleton.emplace();
        skeleton.ridges = *rc::gen::element(Ridges::none, Ridges::voronoi, Ridges::segments);
        skeleton.scatter = *rc::gen::element(0, 20);
        skeleton.points = *rc::gen::element<std::string>("", "points.csv");
    }
    recipe.patches.resize(*rc::gen::inRange<std::size_t>(0, 3));
    return recipe;
}

/// Every condition that the program has.
std::vector<Condition> all_conditions() {
    std::vector<Condition> all;
    for (Key const& key : all_keys()) {
        all.push_back(key.use);
    }
    for (Stage const* const stage : all_stages()) {
        all.push_back(stage->when);
    }
    return all;
}

} // namespace

TEST(Condition, OfNothingHoldsForEveryRecipe) {
    EXPECT_TRUE(Condition()(Recipe{}));
    EXPECT_EQ(Condition().text(), "");
    EXPECT_EQ(Condition().lacks(Recipe{}), "");
    EXPECT_EQ((Condition() && with_rivers).text(), "[network]");
    EXPECT_EQ((with_rivers && Condition()).text(), "[network]");
    EXPECT_TRUE((Condition() || with_rivers)(Recipe{}));
    EXPECT_EQ((with_rivers || Condition()).text(), "");
}

TEST(Condition, SaysItselfWithBracketsWhereTheyAreNeeded) {
    EXPECT_EQ((with_rivers && diffused_or_tin).text(), R"([network] and surface.method = "diffuse" or "tin")");
    EXPECT_EQ((with_rivers || (diffused_or_tin && !with_points)).text(),
              R"([network] or (surface.method = "diffuse" or "tin" and no skeleton.points))");
    EXPECT_EQ((with_rivers && (with_points || ask::above(&SkeletonRecipe::scatter, 0))).text(),
              "[network] and (skeleton.points or skeleton.scatter > 0)");
    EXPECT_EQ(((with_rivers && with_points) && diffused_or_tin).text(),
              R"([network] and skeleton.points and surface.method = "diffuse" or "tin")");
    EXPECT_EQ(ask::is(&fractal::MidpointParams::stencil,
                      {fractal::Stencil::four, fractal::Stencil::twelve, fractal::Stencil::sixteen})
                  .text(),
              "detail.stencil = 4, 12 or 16");
    EXPECT_EQ(ask::is(&EquilibriumRecipe::edge, {std::nullopt, surface::Edge::open}).text(),
              R"(surface.edge = "auto" or "open")");
    EXPECT_EQ(ask::is(&NetworkRecipe::fill_space, {true}).text(), "network.fill_space = true");
    EXPECT_EQ(ask::is(&surface::DilateParams::relief_m, {0.0}).text(), "surface.relief = 0");
    EXPECT_EQ(ask::below(&growth::DlaParams::sticking, 1).text(), "network.dla.sticking < 1");
    EXPECT_EQ(ask::has(&Recipe::patches).text(), "[patch]");
    EXPECT_EQ(ask::writes(OutputFiles::areas).text(), R"(output.files with "areas")");
}

TEST(Condition, SaysItsOppositeToo) {
    EXPECT_EQ((!(with_rivers && (diffused_or_tin || with_points))).text(),
              R"(no [network] or (surface.method other than "diffuse" or "tin" and no skeleton.points))");
    EXPECT_EQ((!ask::above(&SkeletonRecipe::scatter, 0)).text(), "skeleton.scatter <= 0");
    EXPECT_EQ((!ask::below(&growth::DlaParams::sticking, 1)).text(), "network.dla.sticking >= 1");
    EXPECT_EQ((!ask::writes(OutputFiles::areas)).text(), R"(output.files without "areas")");
}

TEST(Condition, SaysWhatARecipeLacksAndWhatItHasInstead) {
    Recipe recipe;
    Condition const both = with_rivers && diffused_or_tin;
    EXPECT_EQ(both.lacks(recipe), R"([network] and surface.method = "diffuse" or "tin")");
    recipe.surface.emplace().method = Method::dilate;
    EXPECT_EQ(both.lacks(recipe), R"([network] and surface.method = "diffuse" or "tin" (here it is "dilate"))");
    recipe.network.emplace();
    EXPECT_EQ((both || with_points).lacks(recipe),
              R"(surface.method = "diffuse" or "tin" (here it is "dilate"), or skeleton.points)");
    recipe.surface->method = Method::tin;
    EXPECT_EQ(both.lacks(recipe), "");
    EXPECT_EQ(ask::is(&NetworkRecipe::fill_space, {true}).lacks(recipe),
              "network.fill_space = true (here it is false)");
    recipe.detail.emplace().midpoint.stencil = fractal::Stencil::exact;
    EXPECT_EQ(
        ask::is(&fractal::MidpointParams::stencil, {fractal::Stencil::four, fractal::Stencil::twelve}).lacks(recipe),
        R"(detail.stencil = 4 or 12 (here it is "exact"))");
    EXPECT_EQ(both.told_as("a TIN").text(), "a TIN");
    EXPECT_EQ(with_points.told_as("points of your own").lacks(recipe), "points of your own");
}

TEST(Condition, OfASectionThatIsNotThereHoldsForNoValue) {
    EXPECT_FALSE(ask::is(&SurfaceRecipe::method, {SurfaceRecipe{}.method})(Recipe{}));
    EXPECT_FALSE(ask::below(&growth::DlaParams::sticking, 2)(Recipe{}));
    EXPECT_TRUE((!with_points)(Recipe{}));
}

TEST(Condition, HoldsAsItsPartsDo) {
    EXPECT_TRUE(rc::check("and, or, not and lacks agree", [] {
        Recipe const recipe = any_recipe();
        std::vector<Condition> const all = all_conditions();
        std::size_t const one = *rc::gen::inRange<std::size_t>(0, all.size());
        std::size_t const two = *rc::gen::inRange<std::size_t>(0, all.size());
        RC_PRE(!all[one].text().empty() && !all[two].text().empty());
        Condition const& a = all[one];
        Condition const& b = all[two];
        RC_ASSERT((a && b)(recipe) == (a(recipe) && b(recipe)));
        RC_ASSERT((a || b)(recipe) == (a(recipe) || b(recipe)));
        RC_ASSERT((!a)(recipe) == !a(recipe));
        RC_ASSERT(a.lacks(recipe).empty() == a(recipe));
        RC_ASSERT((a && b).lacks(recipe).empty() == (a && b)(recipe));
    }));
}

TEST(Condition, AsksForKeysOfTheTableOnly) {
    EXPECT_THROW(std::ignore = ask::given(&fractal::MidpointParams::seed).text(), std::logic_error);
}

TEST(Stages, EachSaysWhenItRuns) {
    for (Stage const* const stage : all_stages()) {
        EXPECT_NE(stage->runs_if(), "") << stage->name;
        EXPECT_GT(stage->seconds_a_million, 0.0) << stage->name;
        EXPECT_GT(stage->bytes_a_cell, 0.0) << stage->name;
    }
    EXPECT_EQ(stage::sea.runs_if(),
              R"(network.source = "lines" and network.lines.coastlines = "sea" and its file has coastlines)");
    EXPECT_EQ(stage::fill.runs_if(),
              R"([network] and [surface] and surface.method other than "equilibrium" or "dilate")");
}

} // namespace condition_test
