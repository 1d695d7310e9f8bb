// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/condition.hpp>

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/fractal/estimate_fractal.hpp>
#include <thalweg/recipe/recipe_keys.hpp>
#include <thalweg/solver/spectral/circulant.hpp>

namespace thalweg::recipe {

bool replaces_rivers(Recipe const& recipe) {
    return std::any_of(recipe.patches.begin(), recipe.patches.end(),
                       [](PatchRecipe const& p) { return p.rivers == PatchRivers::replace; });
}

int levels_of(Recipe const& recipe) {
    return recipe.detail && recipe.detail->method == DetailMethod::midpoint ? recipe.detail->midpoint.levels : 0;
}

Grid coarse_grid(Grid const& grid, int levels) {
    std::int64_t const step = std::int64_t{1} << levels;
    Grid coarse = grid;
    coarse.width = (grid.width - 1 + step - 1) / step + 1;
    coarse.height = (grid.height - 1 + step - 1) / step + 1;
    coarse.cell_m = grid.cell_m * static_cast<double>(step);
    double const shift = 0.5 * (coarse.cell_m - grid.cell_m);
    coarse.west = grid.west - shift;
    coarse.north = grid.north + shift;
    return coarse;
}

void check_detail(Recipe const& recipe, std::int64_t width, std::int64_t height) {
    int const levels = levels_of(recipe);
    if (levels == 0 || recipe.detail->midpoint.stencil != fractal::Stencil::exact) {
        return;
    }
    auto const coarse_at = [&](int halved) { return coarse_grid({width, height, 1.0, 0.0, 0.0, ""}, halved); };
    auto const coarse_cells = [&](int halved) { return coarse_at(halved).cells(); };
    if (coarse_cells(levels) <= fractal::most_conditioning_cells) {
        Grid const coarse = coarse_at(levels);
        solver::check_fractional_surface(((coarse.width - 1) << levels) + 1, ((coarse.height - 1) << levels) + 1,
                                         recipe.detail->midpoint.hurst.value_or(fractal::least_hurst));
        return;
    }
    constexpr int most_levels = 12;
    int enough = levels;
    while (enough <= most_levels && coarse_cells(enough) > fractal::most_conditioning_cells) {
        ++enough;
    }
    throw BadParameter("recipe.check_detail",
                       fmt::format("detail.stencil = \"exact\" takes up to {} coarse cells, and {} x {} cells at "
                                   "detail.levels = {} have {}; set {}detail.stencil = 16",
                                   fractal::most_conditioning_cells, width, height, levels, coarse_cells(levels),
                                   enough <= most_levels ? fmt::format("detail.levels = {}, or ", enough) : ""));
}

namespace {

bool is_default(Key const& key, Value const& value, bool set_by_someone) {
    static Recipe const standard = with_all_sections();
    static std::array<Recipe, 2> const built_in = {default_recipe(), cluster_recipe()};
    auto const* const number = std::get_if<double>(&value);
    auto const& earlier = key.row->extra.earlier;
    bool const was_default = number != nullptr && std::count(earlier.begin(), earlier.end(), *number) > 0;
    return key.take(standard) == value || was_default ||
           (!set_by_someone && std::any_of(built_in.begin(), built_in.end(),
                                           [&](Recipe const& recipe) { return key.take(recipe) == value; }));
}

std::string words_for_unused(std::string const& path, Value const& value, std::string const& place,
                             std::string const& lacks) {
    return fmt::format("{} = {}{} has no effect in this recipe: it needs {}. Remove it, or change that.", path,
                       toml_text(value), place.empty() ? "" : " (" + place + ")", lacks);
}

/// What does not fit together, for people.
using Faults = std::vector<std::string>;

void add_if(bool is_wrong, Faults& faults, std::string const& words) {
    if (is_wrong) {
        faults.push_back(words);
    }
}

/// What goes with a land in equilibrium only, and what does not.
void check_equilibrium(Recipe const& recipe, Faults& faults) {
    NetworkRecipe const& n = *recipe.network;
    if (!in_equilibrium(recipe)) {
        add_if(n.heights == Heights::soft, faults, R"(network.heights = "soft" needs surface.method = "equilibrium")");
        add_if(n.heights == Heights::fixed, faults,
               R"(network.heights = "fixed" needs surface.method = "equilibrium")");
        add_if(n.heights == Heights::ends, faults, R"(network.heights = "ends" needs surface.method = "equilibrium")");
        add_if(n.inland == InlandEnds::sink && !on_raster(recipe), faults,
               R"(network.inland = "sink" needs surface.method = "equilibrium" or "raster")");
        add_if(n.inland == InlandEnds::coast, faults,
               R"(network.inland = "coast" needs surface.method = "equilibrium")");
        add_if(
            n.fill_space, faults,
            R"(network.fill_space needs surface.method = "equilibrium": only equilibrium terrain grows side valleys)");
        return;
    }
    add_if(n.inland == InlandEnds::coast && n.source != Source::lines, faults,
           "network.inland = \"coast\" needs network.source = \"lines\"; rivers that grow from a coast "
           "are network.source = \"forest\"");
    EquilibriumRecipe const& e = recipe.surface->equilibrium;
    double const usual_slope_deg = surface::EquilibriumParams{}.mean_slope_deg;
    add_if(n.concavity < 0.1 || n.concavity > 0.9, faults,
           fmt::format("network.concavity = {}: equilibrium terrain needs 0.1 to 0.9", n.concavity));
    add_if(e.mean_slope_deg.value_or(usual_slope_deg) != usual_slope_deg && recipe.surface->dilate.relief_m > 0.0,
           faults, "surface.relief and surface.mean_slope do not go together: one follows from the other");
    add_if(!e.lakes.empty() && e.lake_share > 0.0, faults,
           "surface.lakes and surface.lake_share do not go together: lakes come from a file or are chosen at random");
    add_if(recipe.skeleton && recipe.skeleton->ridges != Ridges::none, faults,
           "skeleton.ridges does not go with surface.method = \"equilibrium\": its ridges follow from the rivers");
}

void check_forest(Recipe const& recipe, Faults& faults) {
    NetworkRecipe const& n = *recipe.network;
    ForestRecipe const& f = n.forest;
    bool const is_forest = n.source == Source::forest;
    add_if(!is_forest && !(f.region.empty() && f.outlets.empty()), faults,
           "network.forest names a file but source is not \"forest\"");
    add_if(is_forest && f.shape == LandShape::island && !f.region.empty(), faults,
           "network.forest.shape and region do not go together: the region is the land");
    add_if(is_forest && n.rotate_deg.value_or(0.0) != 0.0, faults,
           "network.rotate does not go with source = \"forest\": its rivers fill the land as it lies");
}

void check_network(Recipe const& recipe, Faults& faults) {
    NetworkRecipe const& n = *recipe.network;
    add_if(n.source == Source::lines && n.lines.path.empty(), faults,
           "network.lines.path is missing: source = \"lines\" needs a file");
    add_if(!n.tokunaga.strokes.empty() && !n.tokunaga.region.empty(), faults,
           "network.tokunaga.strokes and region do not go together: strokes fill the grid");
    add_if((n.source == Source::lines || n.source == Source::tokunaga) && n.rotate_deg.value_or(0.0) != 0.0, faults,
           "network.rotate turns a cluster: it needs source = \"dla\"");
    add_if(n.source != Source::lines && n.heights == Heights::file, faults,
           R"(network.heights = "file" needs source = "lines")");
    add_if(recipe.statistics.has_value(), faults,
           "[statistics] and [network] do not go together: statistics would move the rivers");
    add_if(recipe.detail && recipe.detail->method == DetailMethod::midpoint && !recipe.detail->midpoint.sigma, faults,
           "detail.sigma is missing: with rivers it cannot be estimated");
    add_if(recipe.detail && !recipe.surface, faults, "[detail] needs [surface]");
    add_if(recipe.surface && recipe.surface->method == Method::regress, faults,
           "surface.method = \"regress\" does not keep rivers: use tin or dilate");
    check_forest(recipe, faults);
    check_equilibrium(recipe, faults);
}

void check_land(Recipe const& recipe, bool has_points, Faults& faults) {
    Method const method = recipe.surface ? recipe.surface->method : Method::tin;
    add_if(recipe.statistics && recipe.statistics->skeleton == Prior::points && !has_points, faults,
           "statistics.skeleton = \"points\" needs skeleton.points or skeleton.scatter");
    add_if(recipe.statistics && recipe.statistics->skeleton != Prior::points && has_points, faults,
           "[skeleton] gives points: set statistics.skeleton = \"points\"");
    add_if(!recipe.statistics && !has_points && !on_raster(recipe), faults,
           "the recipe describes no terrain: give [network], [statistics], skeleton.points, "
           "skeleton.scatter or surface.source");
    bool const is_drawn =
        !recipe.statistics || recipe.statistics->skeleton == Prior::points || recipe.set_at.contains("surface.method");
    add_if(is_drawn && (method == Method::dilate || method == Method::equilibrium) && recipe.surface, faults,
           fmt::format("surface.method = \"{}\" needs [network]: use diffuse, tin or regress",
                       method == Method::dilate ? "dilate" : "equilibrium"));
    add_if(recipe.skeleton && recipe.skeleton->ridges != Ridges::none, faults,
           "skeleton.ridges lie between rivers: they need [network]");
}

bool has_file_of_points(Recipe const& recipe) {
    return recipe.skeleton && !recipe.skeleton->points.empty();
}

bool has_random_points(Recipe const& recipe) {
    return recipe.skeleton && recipe.skeleton->scatter > 0;
}

void check_surface(Recipe const& recipe, Faults& faults) {
    add_if(recipe.surface && recipe.surface->dilate.increment.function, faults,
           "surface.increment is a function, which no recipe can hold: write it as an expression in x, "
           "or call surface::dilate with it");
}

void check_raster(Recipe const& recipe, Faults& faults) {
    if (!on_raster(recipe)) {
        return;
    }
    add_if(recipe.surface->source.empty(), faults,
           "surface.source is missing: surface.method = \"raster\" needs a DEM");
    add_if(recipe.statistics.has_value(), faults,
           "[statistics] and surface.method = \"raster\" do not go together: statistics would move the DEM's heights");
    constexpr std::array heights{Heights::straight, Heights::straight_repaired, Heights::along_stream, Heights::rosgen,
                                 Heights::graded};
    add_if(recipe.network && std::ranges::count(heights, recipe.network->heights) > 0, faults,
           "network.heights does not go with surface.method = \"raster\": rivers take the heights of the DEM (auto) or "
           "those of their file (file)");
}

void check_patches(Recipe const& recipe, Faults& faults) {
    for (std::size_t i = 0; i < recipe.patches.size(); ++i) {
        if (recipe.patches[i].source.empty()) {
            faults.push_back(fmt::format("patch {}: source is missing: name the relief to paste", i + 1));
        }
    }
    add_if(!recipe.patches.empty() && recipe.network && !recipe.surface, faults,
           "[[patch]] needs [surface]: there is no surface to paste into");
}

void check_strata(Recipe const& recipe, Faults& faults) {
    add_if(recipe.strata && recipe.layers.empty(), faults,
           "[strata] tells how layers lie, but there are none: add tables [[layer]], the lowest first");
    if (!in_layers(recipe)) {
        return;
    }
    constexpr std::size_t most = 255; // numbers in strata.tif
    add_if(recipe.layers.size() > most, faults,
           fmt::format("{} tables [[layer]]: {} at most; strata.repeat = true lays them again and again",
                       recipe.layers.size(), most));
    if (recipe.strata && recipe.strata->cap_share) {
        add_if(recipe.surface->dilate.relief_m > 0.0, faults,
               "strata.cap_share and surface.relief do not go together: either says how high the land is");
        bool const has_cap = std::adjacent_find(recipe.layers.begin(), recipe.layers.end(),
                                                [](surface::RockLayer const& lower, surface::RockLayer const& upper) {
                                                    return lower.strength > upper.strength;
                                                }) != recipe.layers.end();
        add_if(!has_cap, faults,
               "strata.cap_share needs a cap rock: a [[layer]] with a greater strength than the one upon it");
    }
    constexpr char const* with = "[[layer]] does not go with {} yet: {}";
    Heights const heights = recipe.network->heights;
    add_if(heights != Heights::automatic && heights != Heights::graded, faults,
           fmt::format(with, "heights of rivers", R"(give network.heights = "graded")"));
    add_if(recipe.skeleton && !(recipe.skeleton->points.empty() && recipe.skeleton->ridge_lines.empty()), faults,
           fmt::format(with, "skeleton.points and skeleton.ridge_lines", "leave them out"));
}

void check_output(OutputRecipe const& output, bool makes_tin, Faults& faults) {
    add_if(output.files && output.has(OutputFiles::areas) && !output.accumulation, faults,
           "output.files names areas, which are measured with output.accumulation = true");
    add_if(output.files && output.has(OutputFiles::tin) && !makes_tin, faults,
           "output.files names tin, which is written with skeleton.tin = true");
}

void check_frame(Recipe const& recipe, Faults& faults) {
    add_if((recipe.grid.width > 0) != (recipe.grid.height > 0), faults,
           "grid.width and grid.height go together: give both or neither");
    bool const fills_a_frame = from_forest(recipe) && recipe.network->forest.region.empty();
    bool const is_framed = on_raster(recipe) || ((recipe.network || has_file_of_points(recipe)) && !fills_a_frame);
    add_if(recipe.grid.width == 0 && !is_framed, faults,
           "grid.width and grid.height are missing: nothing else gives the size of the grid");
}

/// Keys without an effect that no fault speaks of.
void check_use(Recipe const& recipe, Faults& faults) {
    for (UnusedKey const& key : unused_keys(recipe)) {
        std::string const section = fmt::format("[{}]", key.path.substr(0, key.path.find('.')));
        bool const is_told = std::any_of(faults.begin(), faults.end(), [&](std::string const& fault) {
            return fault.find(key.path) != std::string::npos || fault.find(section) == 0;
        });
        if (!is_told) {
            faults.push_back(key.words);
        }
    }
}

void check_cells_of_detail(Recipe const& recipe, Faults& faults) {
    if (recipe.grid.width > 0 && recipe.grid.height > 0) {
        try {
            check_detail(recipe, recipe.grid.width, recipe.grid.height);
        } catch (BadParameter const& fault) {
            faults.emplace_back(fault.what());
        }
    }
}

} // namespace

std::vector<UnusedKey> unused_keys(Recipe const& recipe) {
    std::vector<UnusedKey> found;
    for (Key const& key : all_keys()) {
        std::size_t const count = key.use(recipe) ? 0 : key.part->count(recipe);
        for (std::size_t item = 0; item < count; ++item) {
            std::string const path = key.place(item);
            auto const value = key.take(recipe, item);
            auto const place = recipe.set_at.find(path);
            bool const is_set = place != recipe.set_at.end();
            if (value && !is_default(key, *value, is_set)) {
                found.push_back(
                    {path, words_for_unused(path, *value, is_set ? place->second : "", key.use.lacks(recipe))});
            }
        }
    }
    return found;
}

void refuse_unused_keys(Recipe const& resolved) {
    std::vector<std::string> faults;
    for (UnusedKey const& key : unused_keys(resolved)) {
        if (resolved.set_at.contains(key.path)) {
            faults.push_back(key.words);
        }
    }
    if (!faults.empty()) {
        throw BadParameter("recipe.refuse_unused_keys", fmt::format("recipe: {}", fmt::join(faults, "\nrecipe: ")));
    }
}

void check_recipe(Recipe const& recipe) {
    Faults faults;
    if (recipe.network) {
        check_network(recipe, faults);
    } else {
        check_land(recipe, has_file_of_points(recipe) || has_random_points(recipe), faults);
    }
    add_if(has_file_of_points(recipe) && has_random_points(recipe), faults,
           "skeleton.points and skeleton.scatter do not go together: points come from a file or are "
           "drawn at random");
    check_surface(recipe, faults);
    check_raster(recipe, faults);
    check_strata(recipe, faults);
    check_patches(recipe, faults);
    check_frame(recipe, faults);
    check_output(recipe.output, recipe.skeleton && recipe.skeleton->tin, faults);
    check_use(recipe, faults);
    check_cells_of_detail(recipe, faults);
    if (!faults.empty()) {
        throw BadParameter("recipe.check_recipe", fmt::format("{}", fmt::join(faults, "\n")));
    }
}

} // namespace thalweg::recipe
