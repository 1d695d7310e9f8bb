// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/presets.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/run/messages.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/recipe/condition.hpp>
#include <thalweg/recipe/recipe_keys.hpp>

namespace thalweg::recipe {
namespace {

Preset const& preset_named(std::string const& name) {
    std::vector<std::string> names;
    for (Preset const& preset : presets()) {
        if (preset.name == name) {
            return preset;
        }
        names.push_back(preset.name);
    }
    throw BadParameter("recipe.with_preset", fmt::format("no preset is called '{}'; the presets are {}.{}", name,
                                                         fmt::join(names, ", "), did_you_mean(name, names)));
}

/// Whether another key of the recipe, which somebody chose, says the same or excludes it.
bool is_decided(Recipe const& recipe, std::string const& path) {
    SurfaceRecipe const& surface = *recipe.surface;
    EquilibriumRecipe const& land = surface.equilibrium;
    bool const has_slope = surface.dilate.relief_m > 0.0 || !land.like.empty();
    bool const of_layers = path.starts_with("layer.") || path.starts_with("strata.") || path == "surface.relief";
    return recipe.set_at.contains(path) || (path == "surface.mean_slope" && has_slope) ||
           (path == "surface.roughness" && !land.like.empty()) ||
           (path == "surface.lake_share" && !land.lakes.empty()) ||
           (path == "surface.relief" && (recipe.set_at.contains("surface.mean_slope") || !land.like.empty())) ||
           (path == "strata.cap_share" && (has_slope || recipe.set_at.contains("surface.mean_slope"))) ||
           (of_layers && !recipe.layers.empty());
}

/// A preset of land in layers of rock, from the lowest up.
Preset in_layers_of(std::vector<surface::RockLayer> const& layers, Preset preset) {
    std::vector<KeyValue> keys{{"surface.uplift_pattern", "none"}, {"surface.lake_share", "0"}};
    for (std::size_t k = 0; k < layers.size(); ++k) {
        auto const add = [&](char const* name, double value) {
            keys.push_back({fmt::format("layer.{}.{}", k + 1, name), fmt::format("{}", value)});
        };
        add("thickness", layers[k].thickness_m);
        add("strength", layers[k].strength);
        add("cliff", layers[k].cliff);
    }
    preset.keys.insert(preset.keys.begin(), keys.begin(),
                       keys.end()); // without layers those of [strata] have no effect
    return preset;
}

/// "layer.cliff" of "layer.2.cliff".
std::string without_number(std::string const& path) {
    std::size_t const first = path.find('.');
    std::size_t const last = path.rfind('.');
    return path.starts_with("layer.") && first != last ? path.substr(0, first) + path.substr(last) : path;
}

} // namespace

std::vector<Preset> const& presets() {
    // Chosen by eye beside the DEMs of samples/, and by measures of relief (docs/relief_measures.md), at seeds 7, 1, 2
    // and 3. A large hillslope asks for a large concavity: else rivers lie in trenches that creep cannot follow.
    static std::vector<Preset> const all{
        {"hills",
         "gentle rolling hills: round crests, wide valley floors, some lakes; the hills stand in groups of 8 km",
         "land that ice has shaped (drumlins, kettles), or a plain",
         {{"network.concavity", "0.46"},
          {"surface.mean_slope", "10"},
          {"surface.hillslope", "45"},
          {"surface.debris_area", "0.03"},
          {"surface.floor_width", "0.06"},
          {"surface.roughness", "0.3"},
          {"surface.grain", "3"},
          {"surface.uplift_pattern", "domes"},
          {"surface.uplift_contrast", "2"},
          {"surface.uplift_wave", "8000"},
          {"surface.lake_share", "0.1"}}},
        {"basin-and-range",
         "long parallel ranges, 10 km apart, steep on the side of their fault, with low land between",
         "basins filled with sediment: no fans, no playas, and every basin drains to the edge",
         {{"surface.mean_slope", "14"},
          {"surface.floor_width", "0.06"},
          {"surface.grain", "8"},
          {"surface.uplift_pattern", "blocks"},
          {"surface.uplift_contrast", "20"},
          {"surface.uplift_wave", "10000"},
          {"surface.lake_share", "0"}}},
        {"dissected-plateau",
         "a plateau that valleys have dissected: they branch like trees between crests of much the same height",
         "tablelands, mesas or canyons: nothing is left of the plateau's surface, and no rock makes steps",
         {{"network.concavity", "0.55"},
          {"surface.mean_slope", "12"},
          {"surface.hillslope", "12"},
          {"surface.debris_area", "0.14"},
          {"surface.roughness", "0.26"},
          {"surface.longest_wave", "5000"},
          {"surface.grain", "4"},
          {"surface.uplift_pattern", "none"},
          {"surface.lake_share", "0"}}},
        in_layers_of(
            {{160.0, 0.5, 0.5}, {110.0, 8.0, 5.0}, {170.0, 0.35, 0.5}, {130.0, 8.0, 5.0}, {100.0, 0.05, 0.15}},
            {"canyonlands",
             "a plateau on two beds of cap rock, with canyons in steps where rivers have cut through",
             "sand, arches or towers; layers are level but for gentle bends, and the rivers were there before them",
             {{"strata.cap_share", "0.6"},
              {"surface.roughness", "0.35"},
              {"strata.base", "-30"},
              {"strata.undulation", "40"}}}),
        in_layers_of({{60.0, 0.1, 0.3}, {160.0, 0.5, 0.55}, {80.0, 12.0, 6.0}, {60.0, 0.3, 0.5}, {100.0, 0.03, 0.12}},
                     {"mesa",
                      "table mountains: what a cap rock still protects above a wide plain, with ragged cliffs",
                      "a desert: no wind, no sand, and every valley drains to the edge",
                      {{"strata.cap_share", "0.35"},
                       {"surface.roughness", "0.45"},
                       {"strata.undulation", "30"},
                       {"strata.undulation_wave", "5000"}}}),
        in_layers_of(
            {{220.0, 0.45, 0.5},
             {70.0, 2.0, 4.0},
             {500.0, 0.15, 0.25},
             {120.0, 0.4, 0.5},
             {35.0, 1.5, 3.0},
             {260.0, 0.15, 0.25},
             {170.0, 0.45, 0.5},
             {50.0, 2.0, 4.0},
             {340.0, 0.15, 0.25}},
            {"cuesta",
             "scarps of three firm beds that dip 8 degrees, long even slopes down the bed behind them, and vales "
             "of soft rock between",
             "a plateau or hogbacks; backs are smooth planes, and rivers cross the ridges where they did before",
             {{"surface.mean_slope", "18"},
              {"surface.roughness", "0.45"},
              {"strata.repeat", "true"},
              {"strata.dip", "8"},
              {"strata.undulation", "80"},
              {"strata.undulation_wave", "8000"}}}),
        in_layers_of(
            {{100.0, 0.6, 0.7},
             {260.0, 0.14, 0.25},
             {170.0, 0.45, 0.5},
             {60.0, 1.3, 4.0},
             {350.0, 0.14, 0.25},
             {100.0, 0.45, 0.5},
             {35.0, 1.1, 3.0},
             {280.0, 0.14, 0.25},
             {190.0, 0.45, 0.5},
             {60.0, 1.6, 4.0},
             {330.0, 0.14, 0.25},
             {130.0, 0.45, 0.5},
             {45.0, 1.6, 3.0},
             {400.0, 0.14, 0.25}},
            {"dome",
             "an eroded dome: hills of old rock in the middle, rings of firm beds about it that dip outwards, and "
             "vales between",
             "a volcano or a crater: rings are nearly circular, and rivers take no notice of them",
             {{"surface.mean_slope", "20"},
              {"surface.roughness", "0.4"},
              {"strata.base", "-2330"},
              {"strata.dome", "3000"},
              {"strata.dome_radius", "6200"},
              {"strata.dip", "1.5"},
              {"strata.undulation", "100"},
              {"strata.undulation_wave", "7000"}}}),
        in_layers_of({{540.0, 0.45, 0.5}, {120.0, 8.0, 5.0}, {380.0, 0.3, 0.5}, {60.0, 6.0, 5.0}},
                     {"ridge-and-valley",
                      "long ridges of firm beds in folds that plunge: zigzags, and gaps where rivers cross them",
                      "folds that overturn, or thrusts; the rivers take no notice of the folds",
                      {{"surface.relief", "1000"},
                       {"strata.repeat", "true"},
                       {"strata.fold", "800"},
                       {"strata.fold_wave", "7000"},
                       {"strata.plunge", "5"}}})};
    return all;
}

Recipe with_preset(Recipe recipe, std::string const& name) {
    Preset const& preset = preset_named(name);
    refuse_if<BadParameter>(!in_equilibrium(recipe), "recipe.with_preset",
                            "preset '{}' is of equilibrium terrain: it needs {}", name, in_equilibrium.lacks(recipe));
    std::vector<std::string> given;
    Recipe const asked = recipe;
    for (KeyValue const& key : preset.keys) {
        if (!is_decided(asked, key.path)) {
            given.push_back(key.path);
            set_key(recipe, key.path, key.text.value_or(""));
            recipe.set_at.erase(key.path); // by nobody: it need not have an effect
        }
    }
    refuse_if<BadParameter>(given.empty(), "recipe.with_preset",
                            "preset '{}' has no effect: the recipe sets every key of it", name);
    for (std::string const& path : given) {
        if (!find_key(without_number(path))->use(recipe)) {
            unset_key(recipe, path);
        }
    }
    return recipe;
}

} // namespace thalweg::recipe
