// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_keys.hpp>

namespace recipe_keys_test {

using namespace thalweg;
using namespace thalweg::pipeline;

TEST(RecipeKeys, PathsDiffer) {
    std::set<std::string> paths;
    for (Key const& key : all_keys()) {
        EXPECT_TRUE(paths.insert(key.help.path).second) << key.help.path;
        EXPECT_EQ(find_key(key.help.path), &key);
    }
}

TEST(RecipeKeys, DefaultsGoThroughTheirOwnChecks) {
    Recipe const standard = with_all_sections();
    for (Key const& key : all_keys()) {
        if (auto const value = key.take(standard)) {
            Recipe recipe = standard;
            EXPECT_NO_THROW(key.put(recipe, *value)) << key.help.path;
            EXPECT_EQ(key.take(recipe), value) << key.help.path;
        }
    }
}

TEST(RecipeKeys, NumbersHaveARange) {
    for (Key const& key : all_keys()) {
        bool const is_number = key.help.type == "number" || key.help.type == "integer";
        EXPECT_EQ(key.range.has_value(), is_number) << key.help.path;
        EXPECT_FALSE(key.help.range.empty()) << key.help.path;
    }
}

TEST(RecipeKeys, WordsStandInTheOrderOfTheirEnumeration) {
    struct Case {
        char const* path;
        char const* last;
        bool (*holds)(Recipe const&);
    };
    Case const cases[] = {
        {"network.source", "lines", [](Recipe const& r) { return r.network->source == Source::lines; }},
        {"network.heights", "ends", [](Recipe const& r) { return r.network->heights == Heights::ends; }},
        {"network.inland", "coast", [](Recipe const& r) { return r.network->inland == InlandEnds::coast; }},
        {"network.rosgen", "G", [](Recipe const& r) { return r.network->rosgen == network::Rosgen::g; }},
        {"network.rosgen", "by_order", [](Recipe const& r) { return !r.network->rosgen; }},
        {"network.rosgen_slope", "uniform",
         [](Recipe const& r) { return r.network->rosgen_slope == network::SlopeDraw::uniform; }},
        {"network.dla.rule", "stick_then_count",
         [](Recipe const& r) { return r.network->dla.rule == network::VisitRule::stick_then_count; }},
        {"network.dla.branch", "all", [](Recipe const& r) { return r.network->branch == network::BranchChoice::all; }},
        {"network.tokunaga.rule", "plane",
         [](Recipe const& r) { return r.network->tokunaga.rule == network::SideRule::plane; }},
        {"network.tokunaga.mouth", "west", [](Recipe const& r) { return r.network->tokunaga.mouth == Side::west; }},
        {"network.forest.shape", "island",
         [](Recipe const& r) { return r.network->forest.shape == LandShape::island; }},
        {"network.lines.orientation", "topology",
         [](Recipe const& r) { return r.network->lines.orientation == network::Orientation::topology; }},
        {"network.lines.divergences", "error",
         [](Recipe const& r) { return r.network->lines.divergences == network::Divergences::error; }},
        {"network.lines.filter", "none",
         [](Recipe const& r) { return r.network->lines.filter == io::LineFilter::none; }},
        {"network.lines.coastlines", "none",
         [](Recipe const& r) { return r.network->lines.coastlines == Coastlines::none; }},
        {"skeleton.ridges", "segments", [](Recipe const& r) { return r.skeleton->ridges == Ridges::segments; }},
        {"skeleton.law", "normal", [](Recipe const& r) { return r.skeleton->law == skeleton::HeightLaw::normal; }},
        {"skeleton.deviation", "printed",
         [](Recipe const& r) { return r.skeleton->deviation == skeleton::Deviation::printed; }},
        {"skeleton.falloff", "literal",
         [](Recipe const& r) { return r.skeleton->falloff == skeleton::Falloff::literal; }},
        {"surface.method", "regress", [](Recipe const& r) { return r.surface->method == Method::regress; }},
        {"surface.base", "tin", [](Recipe const& r) { return r.surface->base == Base::tin; }},
        {"surface.metric", "euclid",
         [](Recipe const& r) { return r.surface->dilate.metric == surface::Metric::euclid; }},
        {"surface.edge", "mainland",
         [](Recipe const& r) { return r.surface->equilibrium.edge == surface::Edge::mainland; }},
        {"surface.uplift_pattern", "folds",
         [](Recipe const& r) { return r.surface->equilibrium.uplift_pattern == surface::UpliftPattern::folds; }},
        {"surface.drain", "fill", [](Recipe const& r) { return r.surface->drain == flow::Conditioning::fill; }},
        {"surface.drain", "auto", [](Recipe const& r) { return !r.surface->drain; }},
        {"surface.diffusion", "explicit",
         [](Recipe const& r) { return r.surface->diffuse.mode == surface::Diffusion::explicit_sweeps; }},
        {"surface.start", "zero",
         [](Recipe const& r) { return r.surface->diffuse.start == surface::DiffusionStart::zero; }},
        {"surface.interpolation", "natural",
         [](Recipe const& r) { return r.surface->interpolation == Interpolation::natural; }},
        {"surface.slope_mode", "mean",
         [](Recipe const& r) { return r.surface->regress.slope == skeleton::SlopeMode::mean; }},
        {"surface.eighth_term", "x3y",
         [](Recipe const& r) { return r.surface->regress.eighth == skeleton::EighthTerm::x3y; }},
        {"statistics.skeleton", "points", [](Recipe const& r) { return r.statistics->skeleton == Prior::points; }},
        {"statistics.falloff", "literal",
         [](Recipe const& r) { return r.statistics->falloff == skeleton::Falloff::literal; }},
        {"detail.method", "none", [](Recipe const& r) { return r.detail->method == DetailMethod::none; }},
        {"detail.stencil", "exact",
         [](Recipe const& r) { return r.detail->midpoint.stencil == fractal::Stencil::exact; }},
        {"detail.noise", "uniform",
         [](Recipe const& r) { return r.detail->midpoint.noise == fractal::Noise::uniform; }},
        {"detail.adaptation", "local",
         [](Recipe const& r) { return r.detail->midpoint.adaptation == fractal::Adaptation::local; }},
        {"patch.rivers", "replace", [](Recipe const& r) { return r.patches[0].rivers == PatchRivers::replace; }},
        {"output.units", "ft", [](Recipe const& r) { return r.output.units == HeightUnit::foot; }},
        {"output.schema", "grass", [](Recipe const& r) { return r.output.schema == io::Schema::grass; }},
    };
    Recipe recipe = with_all_sections();
    for (Case const& one : cases) {
        find_key(one.path)->put(recipe, std::string(one.last));
        EXPECT_TRUE(one.holds(recipe)) << one.path;
    }
}

TEST(RecipeKeys, AValueThatIsRefusedChangesNothing) {
    Recipe recipe;
    EXPECT_THROW(find_key("statistics.std")->put(recipe, -1.0), BadParameter);
    EXPECT_FALSE(recipe.statistics);
    EXPECT_THROW(find_key("patch.gain")->put(recipe, std::string("much")), BadParameter);
    EXPECT_TRUE(recipe.patches.empty());
}

TEST(RecipeKeys, ThoseOfAnArrayReachEachItem) {
    Recipe recipe;
    Key const& gain = *find_key("patch.gain");
    EXPECT_EQ(gain.take(recipe), std::nullopt);
    gain.put(recipe, 2.0);
    gain.put(recipe, 3.0, 1);
    gain.put(recipe, 4.0); // the last
    EXPECT_EQ(gain.take(recipe, 0), Value(2.0));
    EXPECT_EQ(gain.take(recipe, 1), Value(4.0));
    EXPECT_EQ(gain.place(1), "patch.2.gain");
    EXPECT_EQ(find_key("network.slope")->place(0), "network.slope");
}

TEST(RecipeKeys, FilesAreThoseOfEverySectionAndItem) {
    Recipe recipe;
    recipe.network.emplace().lines.path = "a.gpkg";
    recipe.network->lines.layer = "rivers";
    recipe.patches = {{.source = "b.tif"}, {.source = "c.tif", .mask = "d.gpkg"}};
    std::vector<std::string> found;
    for (NamedFile const& file : files_of(recipe)) {
        found.push_back(file.key->place(file.item) + " " + file.name + " " + file.layer);
    }
    EXPECT_EQ(found, (std::vector<std::string>{"network.lines.path a.gpkg rivers", "patch.1.source b.tif ",
                                               "patch.2.source c.tif ", "patch.2.mask d.gpkg "}));
}

} // namespace recipe_keys_test
