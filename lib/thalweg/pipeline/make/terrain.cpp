// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/pipeline/make/internal/terrain.hpp>

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/gdal/access.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/pipeline/make/blend_into.hpp>
#include <thalweg/pipeline/make/internal/river_claims.hpp>
#include <thalweg/pipeline/plan/internal/plan.hpp>
#include <thalweg/pipeline/plan/internal/read_inputs.hpp>
#include <thalweg/pipeline/recipe/internal/check_recipe.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/midpoint_inverse.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

namespace thalweg::pipeline {
namespace {

std::vector<Vec3> in_space(std::vector<Vec2> const& line, std::vector<double> const& z) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < line.size(); ++i) {
        out.push_back({line[i].x, line[i].y, z[i]});
    }
    return out;
}

/// Adds ridges between the terrain's streams.
Terrain with_ridges(Plan const& plan, Terrain terrain, Diary& diary, Run const& run) {
    SkeletonRecipe const& wanted = *plan.recipe.skeleton;
    skeleton::RidgesParams params;
    params.method = wanted.ridges == Ridges::voronoi ? skeleton::RidgesParams::Method::voronoi
                                                     : skeleton::RidgesParams::Method::segments;
    params.gain = wanted.ridge_gain;
    params.farthest_m = wanted.ridge_farthest_m;
    terrain.ridges = diary.stage("ridge", [&] {
        return skeleton::ridges(terrain.network, network::streams(terrain.network.plan, terrain.orders), terrain.grid,
                                params, run);
    });
    diary.say(fmt::format("{} ridges", terrain.ridges.lines.size()));
    return terrain;
}

/// Scatters random points between the rivers, if the recipe requests them.
skeleton::Scattered scattered(Plan const& plan, Terrain const& terrain, Mask const& inside, Diary& diary,
                              Run const& run) {
    SkeletonRecipe const& wanted = *plan.recipe.skeleton;
    skeleton::ScatterBetweenParams params;
    params.seed = plan.recipe.seed;
    params.count = wanted.scatter;
    params.spacing_cells = wanted.spacing_cells;
    params.gain = wanted.ridge_gain;
    params.farthest_m = wanted.ridge_farthest_m;
    params.law = wanted.law;
    skeleton::Scattered points =
        diary.stage("scatter", [&] { return skeleton::scatter_between(terrain.valley, inside, params, run); });
    diary.say(fmt::format("{} points", points.points.points.size()));
    return points;
}

/// Triangulates points, rivers and ridges, whose lines are breaklines.
Terrain with_tin(Terrain terrain, FeaturePoints const& points, Diary& diary, Run const& run) {
    std::vector<std::vector<Vec3>> breaklines;
    for (ArcId a = 0; a < terrain.network.plan.arc_count(); ++a) {
        breaklines.push_back(in_space(terrain.network.plan.arc(a).line, terrain.network.arc_z[a]));
    }
    for (RidgeLine const& ridge : terrain.ridges.lines) {
        breaklines.push_back(ridge.line);
    }
    terrain.tin = diary.stage("tin", [&] { return geometry::triangulate(points.points, breaklines, run).tin; });
    diary.say(fmt::format("{} triangles of {} vertices", terrain.tin->triangles.size(), terrain.tin->vertices.size()));
    return terrain;
}

/// The cells of the terrain: those of the recipe's mask, or all; without the sea.
Mask inside_of(Recipe const& recipe, Mask const& land, Valley const& valley) {
    if (recipe.surface->mask.empty()) {
        return land.values().empty() ? Mask(valley.z.grid(), 1) : land;
    }
    Grid const& grid = valley.z.grid();
    Mask inside = read_mask_of_land(file_in(recipe, recipe.surface->mask), grid);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        inside[i] = inside[i] != 0 && (land.values().empty() || land[i] != 0) ? 1 : 0;
        if (inside[i] == 0 && !std::isnan(valley.z[i])) {
            Cell const c = grid.at(i);
            throw BadInput(fmt::format("surface.mask = \"{}\" leaves out cell ({}, {}), where a river runs",
                                       recipe.surface->mask, c.col, c.row));
        }
    }
    return inside;
}

/// Terrain over the skeleton's triangles. Valley cells keep their heights.
Raster<float> over_triangles(Terrain const& terrain, Run const& run) {
    Raster<float> land =
        surface::rasterise_tin(*terrain.tin, terrain.grid, {surface::RasteriseTinParams::Outside::nearest}, run);
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] = std::isnan(terrain.valley.z[i]) ? land[i] : terrain.valley.z[i];
    }
    return land;
}

void warn_of_jumps(surface::Dilated const& surface, surface::IncrementParams const& params, Run const& run) {
    auto const jumps = surface::increment_jumps(surface.levels, params);
    if (!jumps.empty()) {
        run.say(fmt::format("warning: surface.increment = \"{}\" jumps from {:.3g} to {:.3g} at x = {:.4g}{}: slopes "
                            "break there",
                            params.increment, jumps[0].from, jumps[0].to, jumps[0].x,
                            jumps.size() > 1 ? fmt::format(", and {} times more", jumps.size() - 1) : ""));
    }
}

surface::Dilated dilated(Plan const& plan, Terrain const& terrain, Mask const& inside, Run const& run) {
    SurfaceRecipe const& wanted = *plan.recipe.surface;
    bool const whole = wanted.mask.empty() && terrain.land.values().empty();
    if (wanted.base == Base::paper) { // without a mask by the closed form
        return whole ? surface::dilate(terrain.valley, wanted.dilate, run)
                     : surface::dilate(terrain.valley, inside, wanted.dilate, run);
    }
    surface::HarmonicParams params;
    params.tolerance = wanted.tolerance.value_or(params.tolerance);
    Raster<float> const base = wanted.base == Base::tin ? over_triangles(terrain, run)
                                                        : surface::harmonic(terrain.valley, inside, params, run);
    return whole ? surface::dilate_over(terrain.valley, base, wanted.dilate, run)
                 : surface::dilate_over(terrain.valley, base, inside, wanted.dilate, run);
}

/// The skeleton of a diffusion: rivers, ridges, points, and cells derived from them.
Skeleton gathered(Plan const& plan, Terrain const& terrain, FeaturePoints const& points, Run const& run) {
    SkeletonRecipe const wanted = plan.recipe.skeleton.value_or(SkeletonRecipe{});
    skeleton::DrawSkeletonParams params;
    params.noise.amplitude_m = wanted.ridge_noise_m;
    params.noise.wavelength_m = wanted.ridge_wavelength_m;
    params.noise.seed = plan.recipe.seed;
    Skeleton skeleton = skeleton::draw_skeleton(terrain.valley, terrain.ridges, points, params, run).skeleton;
    if (wanted.midpoint_inverse_cells > 0.0) {
        skeleton = skeleton::midpoint_inverse(skeleton, {wanted.midpoint_inverse_cells}, run);
    }
    return skeleton;
}

/// A surface, and the statistics of its solver, if any.
struct Surface {
    surface::Dilated drawn;
    std::optional<SolverStory> diffusion = {};
};

Surface diffused(Plan const& plan, Terrain const& terrain, FeaturePoints const& points, Mask const& inside,
                 Run const& run) {
    surface::DiffuseParams params = plan.recipe.surface->diffuse;
    params.seed = plan.recipe.seed;
    params.tolerance = plan.recipe.surface->tolerance.value_or(params.tolerance);
    surface::Diffused land = surface::diffuse(gathered(plan, terrain, points, run), inside, params, run);
    Surface made;
    made.drawn.dem = std::move(land.dem);
    made.diffusion = SolverStory{land.iterations, land.residual};
    return made;
}

/// Adds fractal detail to terrain with rivers: none in the valleys, all of it some cells away.
Terrain with_detail_beside_rivers(Plan const& plan, Terrain terrain, Run const& run) {
    constexpr double near_cells = 8.0; // distance over which detail grows from nothing to two thirds
    if (levels_of(plan.recipe) == 0) {
        return terrain;
    }
    Detailed const detail = detail_alone(plan, terrain.grid, run);
    terrain.detail = detail.story;
    Raster<float> const& noise = detail.land;
    Raster<float>& dem = terrain.surface->dem;
    surface::Expansion const expansion = surface::expand(terrain.valley, run);
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        double const share = 1.0 - portable::exp(-static_cast<double>(expansion.level[i]) / near_cells);
        dem[i] = static_cast<float>(static_cast<double>(dem[i]) + share * static_cast<double>(noise[i]));
    }
    return terrain;
}

Surface surface_of(Plan const& plan, Terrain const& terrain, FeaturePoints const& points, Mask const& inside,
                   Run const& run) {
    SurfaceRecipe const& wanted = *plan.recipe.surface;
    if (wanted.method == Method::tin) {
        Surface made;
        made.drawn.dem = over_triangles(terrain, run);
        for (std::int64_t i = 0; i < inside.cells(); ++i) {
            if (inside[i] == 0) {
                made.drawn.dem[i] = std::numeric_limits<float>::quiet_NaN();
            }
        }
        return made;
    }
    return wanted.method == Method::diffuse ? diffused(plan, terrain, points, inside, run)
                                            : Surface{dilated(plan, terrain, inside, run)};
}

/// Checks whether the slopes rise as high above their rivers as requested.
std::vector<Check> relief_checks(Plan const& plan, Terrain const& terrain) {
    constexpr double allowed = 0.01;
    double const asked = plan.recipe.surface->dilate.relief_m;
    if (!(asked > 0.0)) {
        return {};
    }
    double const error = std::fabs(terrain.surface->rise_m / asked - 1.0);
    return {{"relief_error", error, allowed, error <= allowed}};
}

std::string about(Plan const& plan, Terrain const& terrain) {
    SurfaceRecipe const& wanted = *plan.recipe.surface;
    switch (wanted.method) {
    case Method::dilate:
        return fmt::format("{}, {} levels", wanted.dilate.increment.increment, terrain.surface->levels);
    case Method::diffuse: return fmt::format("diffused, {} iterations", terrain.diffusion->iterations);
    case Method::equilibrium:
    case Method::tin:
    case Method::regress: break;
    }
    return "over triangles";
}

/// Draws the terrain between the rivers, with its checks and findings.
Terrain filled(Plan const& plan, Terrain terrain, FeaturePoints const& points, Mask const& inside, Diary& diary,
               Run const& run) {
    Surface made = diary.stage("fill", [&] { return surface_of(plan, terrain, points, inside, run); });
    terrain.surface = std::move(made.drawn);
    terrain.diffusion = made.diffusion;
    diary.say(fmt::format("{}x{}, {}", terrain.grid.width, terrain.grid.height, about(plan, terrain)));
    SurfaceRecipe const& wanted = *plan.recipe.surface;
    if (wanted.method == Method::dilate) {
        std::vector<Check> const checks = relief_checks(plan, terrain);
        terrain.checks.insert(terrain.checks.end(), checks.begin(), checks.end());
        warn_of_jumps(*terrain.surface, wanted.dilate.increment, run);
    }
    return terrain;
}

// Makes a terrain of rivers without a surface.
Terrain without_land(Rivers const& rivers) {
    Terrain terrain;
    terrain.grid = rivers.grid;
    terrain.land = rivers.land;
    terrain.network = rivers.network;
    terrain.orders = rivers.orders;
    terrain.streams = rivers.streams;
    terrain.types = rivers.types;
    terrain.valley = rivers.valley;
    return terrain;
}

// Draws the planned terrain through the rivers' cells, which keep their heights, and through the points.
Terrain draw_around_rivers(Plan const& plan, Rivers const& rivers, Diary& diary, Run const& run) {
    Recipe const& recipe = plan.recipe;
    Terrain terrain = without_land(rivers);
    bool const balanced = in_equilibrium(recipe);
    Mask inside;
    if (balanced) { // the rivers take their heights from it
        terrain = draw_in_equilibrium(plan, std::move(terrain), diary, run);
    } else {
        inside = inside_of(recipe, terrain.land, terrain.valley);
    }
    std::optional<FeaturePoints> own;
    if (scatters(recipe)) {
        skeleton::Scattered found = scattered(plan, terrain, inside, diary, run);
        terrain.checks.push_back(points_missing(found.missing, recipe.skeleton->scatter, run));
        own = std::move(found.points);
    }
    FeaturePoints const& points = own ? *own : plan.points;
    if (has_ridges(recipe)) {
        terrain = with_ridges(plan, std::move(terrain), diary, run);
    }
    if (needs_tin(recipe)) {
        terrain = with_tin(std::move(terrain), points, diary, run);
    }
    if (!balanced) {
        terrain = filled(plan, std::move(terrain), points, inside, diary, run);
    }
    return with_detail_beside_rivers(plan, std::move(terrain), run);
}

MakeBlendParams params_of(Recipe const& recipe, PatchRecipe const& patch) {
    MakeBlendParams params;
    params.target = "the land";
    params.source = file_in(recipe, patch.source);
    params.mask = file_in(recipe, patch.mask);
    if (patch.at) {
        params.at = Vec2{(*patch.at)[0], (*patch.at)[1]};
    }
    if (patch.window) {
        auto const cells = [&](std::size_t i) { return static_cast<std::int64_t>((*patch.window)[i]); };
        params.window = blend::SourceWindow{cells(0), cells(1), cells(2), cells(3)};
    }
    params.rotate_deg = patch.rotate_deg;
    params.scale = patch.scale;
    params.gain = patch.gain;
    params.feather_cells = patch.feather_cells;
    return params;
}

// Pastes the recipe's patches into the terrain in order; rivers keep their cells' heights unless a patch overrides
// this.
Terrain with_patches(Plan const& plan, Terrain drawn, Diary& diary, Run const& run) {
    for (PatchRecipe const& patch : plan.recipe.patches) {
        bool const keeps = patch.rivers == PatchRivers::keep && plan.recipe.network.has_value();
        MadeBlend made = diary.stage("blend", [&] {
            return blend_into(drawn.surface->dem, keeps ? river_mask(drawn.valley) : Mask{},
                              params_of(plan.recipe, patch), run);
        });
        drawn.surface->dem = std::move(made.pasted.dem);
        drawn.patches.push_back({made.pasted.cells, made.pasted.kept, made.pasted.seam_max_m, made.pasted.seam_rms_m});
        diary.say(
            fmt::format("{} cells of {}, seam {:.2g} m", made.pasted.cells, patch.source, made.pasted.seam_rms_m));
    }
    if (plan.recipe.network && replaces_rivers(plan.recipe)) {
        drawn.valley = honoured_valley(std::move(drawn.valley), drawn.network.plan, drawn.surface->dem);
    }
    return drawn;
}

/// Terrain without rivers, with a note on each conversion.
Terrain land_alone(Plan const& plan, Diary& diary, Run const& run) {
    std::vector<Finding> notes = report_conversions(plan.recipe, *plan.grid, run);
    Terrain terrain = make_land(plan, diary, run);
    terrain.notes = std::move(notes);
    return terrain;
}

/// Rivers without terrain, or with the terrain around them.
Terrain land_with(Plan const& plan, Rivers const& rivers, Diary& diary, Run const& run) {
    if (!plan.grid) { // otherwise checked before the rivers were grown
        check_detail(plan.recipe, rivers.grid.width, rivers.grid.height);
        if (plan.recipe.skeleton) {
            require_on_grid(plan.points, rivers.grid, plan.recipe.skeleton->points);
        }
    }
    return plan.recipe.surface ? draw_around_rivers(plan, rivers, diary, run) : without_land(rivers);
}

/// Conditions the terrain hydrologically, if the plan requests it.
Terrain made_to_drain(Plan const& plan, Terrain terrain, Diary& diary, Run const& run) {
    if (!conditions(plan.recipe)) {
        return terrain;
    }
    Valley const none{Raster<float>(terrain.grid, std::numeric_limits<float>::quiet_NaN())};
    flow::ConditionedDem land = diary.stage("carve", [&] {
        return flow::condition(std::move(terrain.surface->dem), plan.recipe.network ? terrain.valley : none,
                               {*plan.recipe.surface->drain}, run);
    });
    terrain.surface->dem = std::move(land.dem);
    terrain.drained = {land.banks, land.depressions};
    diary.say(fmt::format("banks raised {:.0f} m3; depressions filled {:.0f} m3, cut {:.0f} m3", land.banks.raised_m3,
                          land.depressions.raised_m3, land.depressions.cut_m3));
    return terrain;
}

/// Adds the terrain's flow directions and areas.
Terrain with_drainage(Plan const& plan, Terrain terrain, Diary& diary, Run const& run) {
    Raster<float> const& dem = terrain.surface->dem;
    StreamNetwork const& network = terrain.network.plan;
    bool const sinks = plan.recipe.network && plan.recipe.network->inland == InlandEnds::sink;
    run.at(0.0, fmt::format("drain {} cells", terrain.grid.cells()).c_str());
    terrain.drainage = diary.stage("drain", [&] {
        return flow::route(
            dem, sinks ? cells_of(inland_ends(network, dem), network, terrain.grid) : std::vector<std::int64_t>{}, run);
    });
    return terrain;
}

} // namespace

Terrain make_terrain(Plan const& plan, Rivers const& rivers, Run const& run) {
    io::RecipeFiles const confined;
    Diary diary(run);
    Terrain terrain = plan.recipe.network ? land_with(plan, rivers, diary, run) : land_alone(plan, diary, run);
    if (terrain.surface) {
        terrain = with_patches(plan, std::move(terrain), diary, run);
        terrain = made_to_drain(plan, std::move(terrain), diary, run);
        terrain = with_drainage(plan, std::move(terrain), diary, run);
        terrain = with_side_valleys(plan, std::move(terrain), diary, run);
    }
    terrain.timings_s = diary.take();
    return terrain;
}

} // namespace thalweg::pipeline
