// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/recipe/forecast.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/flow/conditioning/condition.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/network/read_rivers.hpp>
#include <thalweg/io/raster/read_polygons.hpp>
#include <thalweg/network/growth/dla/grow_dla.hpp>
#include <thalweg/network/growth/tokunaga/grow_tokunaga.hpp>
#include <thalweg/pipeline/make/frame.hpp>
#include <thalweg/pipeline/make/internal/land.hpp>
#include <thalweg/pipeline/make/internal/land_in_equilibrium.hpp>
#include <thalweg/pipeline/make/internal/plan_rivers.hpp>
#include <thalweg/pipeline/make/terrain.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace thalweg::pipeline {

namespace {

/// What is known before a run.
struct KnownBefore {
    std::optional<Grid> grid;
    std::int64_t cells = 0; ///< about, where the grid is unknown
    bool lines_have_z = false;
    bool lines_have_coast = false;
};

void require_files(Recipe const& recipe) {
    for (NamedFile const& file : files_of(recipe)) {
        std::error_code ignored;
        if (!std::filesystem::exists(file_in(recipe, file.name), ignored)) {
            throw BadInput(fmt::format("pipeline.forecast: {} = \"{}\": there is no such file",
                                       file.key->place(file.item), file.name));
        }
    }
}

/// About as many cells as a network grown from this many particles takes with its margin: the radius of a cluster of
/// dimension 1.71, of which one arm is kept.
std::int64_t cells_of_cluster(std::int64_t particles) {
    double const radius = 0.8 * portable::pow(static_cast<double>(particles), 1.0 / 1.71);
    return std::max<std::int64_t>(1, std::llround(1.2 * radius * radius));
}

std::int64_t links_of(Recipe const& recipe, Run const& run) {
    return static_cast<std::int64_t>(network::grow_tokunaga(tree_of(recipe), run).links.size());
}

KnownBefore known_of_grid(Grid const& grid) {
    return {grid, grid.cells(), false, false};
}

KnownBefore known_of_lines(Recipe const& recipe, Run const& run) {
    RiverLines const lines = read_lines(recipe, run);
    KnownBefore known = known_of_grid(frame_lines(lines, settle_on_lines(recipe, lines, run).recipe.grid));
    known.lines_have_z = lines.has_z;
    known.lines_have_coast =
        recipe.network->lines.coastlines == Coastlines::sea &&
        std::any_of(lines.secondary.begin(), lines.secondary.end(), [](SecondaryLine const& l) { return l.is_coast; });
    return known;
}

KnownBefore known_of_strokes(Recipe const& recipe, Run const& run) {
    TokunagaRecipe const& wanted = recipe.network->tokunaga;
    std::string const crs = recipe.grid.crs.empty() ? "" : io::projected_crs(recipe.grid.crs);
    return known_of_grid(
        frame_lines(io::read_rivers({.path = file_in(recipe, wanted.strokes), .layer = wanted.layer, .crs = crs}, run),
                    recipe.grid));
}

/// usual_crs: where the recipe names none.
KnownBefore known_of_polygons(Recipe const& recipe, std::string const& path, std::string const& usual_crs,
                              Run const& run) {
    GridRecipe wanted = recipe.grid;
    wanted.crs = wanted.crs.empty() ? usual_crs : io::projected_crs(wanted.crs);
    return known_of_grid(frame_polygons(io::read_polygons(path, wanted.crs, run), wanted));
}

/// The grid that a recipe gives, or a square one for so many links.
KnownBefore known_of_tree(Recipe const& recipe, std::int64_t links) {
    GridRecipe wanted = recipe.grid;
    wanted.crs = io::projected_crs(wanted.crs.empty() ? "EPSG:32631" : wanted.crs);
    return known_of_grid(frame_tree(links, wanted));
}

KnownBefore known_of_rivers(Recipe const& recipe, Run const& run) {
    NetworkRecipe const& rivers = *recipe.network;
    switch (rivers.source) {
    case Source::lines: return known_of_lines(recipe, run);
    case Source::tokunaga:
        if (!rivers.tokunaga.strokes.empty()) {
            return known_of_strokes(recipe, run);
        }
        return rivers.tokunaga.region.empty()
                   ? known_of_tree(recipe, links_of(recipe, run))
                   : known_of_polygons(recipe, file_in(recipe, rivers.tokunaga.region), "EPSG:32631", run);
    case Source::forest:
        if (!rivers.forest.region.empty()) {
            std::string const path = file_in(recipe, rivers.forest.region);
            return known_of_polygons(recipe, path, io::crs_for_polygons(path), run);
        }
        return known_of_tree(recipe, 1); // its size is given: check_recipe demands it
    case Source::dla: break;
    }
    check_memory_of_cluster(rivers.dla.particles);
    network::require_growth(rivers.dla);
    if (recipe.grid.width > 0) {
        return known_of_tree(recipe, 1);
    }
    return {std::nullopt, cells_of_cluster(rivers.dla.particles), false, false};
}

KnownBefore known_of_points(Recipe recipe, Run const& run) {
    FeaturePoints const points = given_points(recipe, run);
    recipe.grid.crs = points.crs;
    return known_of_grid(frame_land(points, recipe.grid));
}

/// The stages in which rivers are made, as make_rivers() runs them.
std::vector<std::string> stages_of_rivers(Recipe const& recipe, KnownBefore const& known) {
    NetworkRecipe const& rivers = *recipe.network;
    std::vector<std::string> stages;
    switch (rivers.source) {
    case Source::dla: stages = {"grow", "thin", "trace"}; break;
    case Source::lines: stages = {"read", "adopt"}; break;
    case Source::forest: stages = {"shape", "grow"}; break;
    case Source::tokunaga:
        stages = rivers.tokunaga.strokes.empty() ? std::vector<std::string>{"grow", "embed"}
                                                 : std::vector<std::string>{"read", "grow"};
        break;
    }
    if (known.lines_have_coast) {
        stages.emplace_back("sea");
    }
    stages.emplace_back("prune");
    bool const has_coast =
        rivers.source == Source::forest && (!rivers.forest.region.empty() || rivers.forest.shape == LandShape::island);
    bool const grown_for_land = rivers.source != Source::lines && in_equilibrium(recipe) && !has_coast;
    if (grown_for_land || rivers.meander.value_or(0.0) != 0.0) {
        stages.emplace_back("meander");
    }
    bool const graded = rivers.heights == Heights::graded || (rivers.heights == Heights::automatic &&
                                                              !(rivers.source == Source::lines && known.lines_have_z));
    if (!(in_equilibrium(recipe) && graded)) {
        stages.emplace_back("raise");
    }
    return stages;
}

std::vector<std::string> stages_of_surface(Recipe const& recipe) {
    std::vector<std::string> stages;
    if (!recipe.network) {
        stages = {"land"};
        if (levels_of(recipe) > 0) {
            stages.emplace_back("detail");
        }
        if (recipe.statistics) {
            stages.emplace_back("project");
        }
        return stages;
    }
    SurfaceRecipe const& wanted = *recipe.surface;
    if (in_equilibrium(recipe)) {
        stages = {"channels", "fill"};
    }
    if (recipe.skeleton && recipe.skeleton->scatter > 0) {
        stages.emplace_back("scatter");
    }
    if (recipe.skeleton && recipe.skeleton->ridges != Ridges::none) {
        stages.emplace_back("ridge");
    }
    bool const over_tin = wanted.method == Method::tin || (wanted.method == Method::dilate && wanted.base == Base::tin);
    if (over_tin || (recipe.skeleton && recipe.skeleton->tin)) {
        stages.emplace_back("tin");
    }
    if (!in_equilibrium(recipe)) {
        stages.emplace_back("fill");
    }
    return stages;
}

std::vector<std::string> stages_after(Recipe const& recipe) {
    std::vector<std::string> stages(recipe.patches.size(), "blend");
    flow::Conditioning const usual = recipe.network ? flow::Conditioning::carve : flow::Conditioning::none;
    if (recipe.surface && recipe.surface->drain.value_or(usual) != flow::Conditioning::none) {
        stages.emplace_back("carve");
    }
    stages.emplace_back("drain");
    if (recipe.network && recipe.network->fill_space) {
        stages.emplace_back("valleys");
    }
    stages.emplace_back("measure");
    if (recipe.network && recipe.output.catchments) {
        stages.emplace_back("catchments");
    }
    if (recipe.network) {
        stages.emplace_back("certify");
    }
    if (recipe.network && recipe.skeleton && recipe.skeleton->ridges != Ridges::none) {
        stages.emplace_back("ridges");
    }
    if (recipe.output.accumulation) {
        stages.emplace_back("areas");
    }
    stages.insert(stages.end(), {"laws", "relief"});
    return stages;
}

std::vector<std::string> stages_of(Recipe const& recipe, KnownBefore const& known) {
    std::vector<std::string> stages;
    auto const append = [&](std::vector<std::string> const& more) {
        stages.insert(stages.end(), more.begin(), more.end());
    };
    if (recipe.network) {
        append(stages_of_rivers(recipe, known));
    }
    if (recipe.surface || !recipe.network) {
        append(stages_of_surface(recipe));
        append(stages_after(recipe));
    }
    if (recipe.network) {
        stages.emplace_back("check");
    }
    return stages;
}

/// Seconds a million cells, by stage; what is not named takes a tenth.
double seconds_a_million(std::string const& stage, Method method) {
    if (stage == "fill") {
        return method == Method::equilibrium ? 2.0 : method == Method::dilate ? 1.0 : 0.8;
    }
    if (stage == "project") {
        return 20.0;
    }
    if (stage == "carve" || stage == "relief" || stage == "meander" || stage == "blend") {
        return 0.7;
    }
    return 0.1;
}

/// Most memory [bytes] of the whole program; measured on the samples, of 0.01 to 1 million cells.
std::int64_t memory_of(Recipe const& recipe, std::int64_t cells) {
    constexpr std::int64_t program = 80'000'000; // with its libraries
    constexpr std::int64_t a_particle = 60;
    bool const has_cluster = recipe.network && recipe.network->source == Source::dla;
    constexpr std::int64_t a_cell_of_exact_detail = 120; // transforms on a torus of up to seven cells a cell
    bool const exact = levels_of(recipe) > 0 && recipe.detail->midpoint.stencil == fractal::Stencil::exact;
    return program + bytes_needed(cells) * 5 / 4 + (exact ? cells * a_cell_of_exact_detail : 0) +
           (has_cluster ? recipe.network->dla.particles * a_particle : 0);
}

double seconds_of(Recipe const& recipe, Forecast const& found) {
    Method const method = recipe.surface ? recipe.surface->method : Method::tin;
    double const millions = static_cast<double>(found.cells) / 1e6;
    double seconds = 1.5 * millions; // files and the page
    for (std::string const& stage : found.stages) {
        seconds += millions * seconds_a_million(stage, method);
    }
    if (recipe.network && recipe.network->source == Source::dla) {
        seconds += 2.5e-6 * static_cast<double>(recipe.network->dla.particles) +
                   8e-8 * network::least_arrivals(recipe.network->dla);
    }
    return seconds;
}

} // namespace

Forecast forecast(Recipe const& recipe, Run const& run) {
    io::RecipeFiles const confined;
    check_recipe(recipe);
    require_files(recipe);
    KnownBefore const known = recipe.network ? known_of_rivers(recipe, run) : known_of_points(recipe, run);
    Forecast found;
    found.grid = known.grid;
    found.cells = known.cells;
    found.stages = stages_of(recipe, known);
    found.memory_bytes = memory_of(recipe, known.cells);
    found.seconds = seconds_of(recipe, found);
    if (known.grid) {
        check_memory(known.grid->width, known.grid->height);
        check_detail(recipe, known.grid->width, known.grid->height);
    }
    return found;
}

} // namespace thalweg::pipeline
