// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <thalweg/make/internal/terrain.hpp>

#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include <thalweg/core/cells.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/kept.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/raster/raster_files.hpp>
#include <thalweg/make/blend_into.hpp>
#include <thalweg/make/internal/features.hpp>
#include <thalweg/make/river_claims.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/made_from.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/midpoint_inverse.hpp>
#include <thalweg/skeleton/ridges.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/equilibrium/features.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

namespace thalweg::make {
namespace {

std::vector<Vec3> in_space(std::vector<Vec2> const& line, std::vector<double> const& z) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < line.size(); ++i) {
        out.push_back({line[i].x, line[i].y, z[i]});
    }
    return out;
}

/// Ridges between the streams, where the recipe asks for them.
RidgeLines ridges_between(recipe::Plan const& plan, Rivers const& rivers, Grid const& grid, StageLog& stage_log,
                          Run const& run) {
    if (!recipe::has_ridges(plan.recipe)) {
        return {};
    }
    recipe::SkeletonRecipe const& wanted = *plan.recipe.skeleton;
    skeleton::RidgesParams params;
    params.method = wanted.ridges == recipe::Ridges::voronoi ? skeleton::RidgesParams::Method::voronoi
                                                             : skeleton::RidgesParams::Method::segments;
    params.gain = wanted.ridge_gain;
    params.farthest_m = wanted.ridge_farthest_m;
    RidgeLines ridges = stage_log.stage("ridge", [&] {
        return skeleton::ridges(rivers.network, network::streams(rivers.network.planform, rivers.orders), grid, params,
                                run);
    });
    stage_log.say(fmt::format("{} ridges", ridges.lines.size()));
    return ridges;
}

/// Random points between the rivers.
skeleton::Scattered scattered(recipe::Plan const& plan, Valley const& valley, Mask const& inside, StageLog& stage_log,
                              Run const& run) {
    recipe::SkeletonRecipe const& wanted = *plan.recipe.skeleton;
    skeleton::ScatterBetweenParams params;
    params.seed = plan.recipe.seed;
    params.count = wanted.scatter;
    params.spacing_cells = wanted.spacing_cells;
    params.gain = wanted.ridge_gain;
    params.farthest_m = wanted.ridge_farthest_m;
    params.law = wanted.law;
    skeleton::Scattered points =
        stage_log.stage("scatter", [&] { return skeleton::scatter_between(valley, inside, params, run); });
    stage_log.say(fmt::format("{} points", points.points.points.size()));
    return points;
}

/// The triangles of points, rivers and ridges, whose lines are breaklines, where the recipe needs them.
std::optional<Tin> triangulated(recipe::Plan const& plan, ElevatedNetwork const& network, RidgeLines const& ridges,
                                FeaturePoints const& points, StageLog& stage_log, Run const& run) {
    if (!recipe::needs_tin(plan.recipe)) {
        return std::nullopt;
    }
    std::vector<std::vector<Vec3>> breaklines;
    for (ArcId a = 0; a < network.planform.arc_count(); ++a) {
        breaklines.push_back(in_space(network.planform.arc(a).line, network.arc_z[a]));
    }
    for (RidgeLine const& ridge : ridges.lines) {
        breaklines.push_back(ridge.line);
    }
    Tin tin = stage_log.stage("tin", [&] { return geometry::triangulate(points.points, breaklines, run).tin; });
    stage_log.say(fmt::format("{} triangles of {} vertices", tin.triangles.size(), tin.vertices.size()));
    return tin;
}

/// The cells of the terrain: those of the recipe's mask, or all; without the sea.
Mask inside_of(recipe::Recipe const& recipe, Mask const& land, Valley const& valley, Run const& run) {
    if (recipe.surface->mask.empty()) {
        return land.values().empty() ? Mask(valley.z.grid(), 1) : land;
    }
    Grid const& grid = valley.z.grid();
    Mask inside = recipe::read_mask_of_land(recipe::file_in(recipe, recipe.surface->mask), grid, run);
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        inside[i] = inside[i] != 0 && (land.values().empty() || land[i] != 0) ? 1 : 0;
        if (inside[i] == 0 && !std::isnan(valley.z[i])) {
            Cell const c = grid.at(i);
            Vec2 const at = grid.centre(c);
            throw BadInput(fmt::format("surface.mask = \"{}\" leaves out cell ({}, {}) at ({:.1f}, {:.1f}), where a "
                                       "river runs",
                                       recipe.surface->mask, c.col, c.row, at.x, at.y));
        }
    }
    return inside;
}

/// What a surface is drawn through.
struct Ground {
    Valley const& valley;
    RidgeLines const& ridges; ///< midway between streams
    std::optional<Tin> const& tin;
    FeaturePoints const& points; ///< given or random, with those of given ridges
    FeaturePoints const& given;  ///< of these, those that are not random
    Mask const& inside;          ///< cells that get heights
    bool whole;                  ///< all of them
};

/// A surface with the heights of valley cells.
Raster<float> with_valley(Raster<float> dem, Valley const& valley) {
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        dem[i] = std::isnan(valley.z[i]) ? dem[i] : valley.z[i];
    }
    return dem;
}

/// A surface over the skeleton's triangles. Valley cells keep their heights.
Raster<float> over_triangles(Ground const& ground, Run const& run) {
    return with_valley(surface::rasterise_tin(*ground.tin, ground.valley.z.grid(),
                                              {surface::RasteriseTinParams::Outside::nearest}, run),
                       ground.valley);
}

void warn_of_jumps(surface::Dilated const& surface, surface::IncrementParams const& params, StageLog& stage_log) {
    auto const jumps = surface::increment_jumps(surface.levels, params);
    if (!jumps.empty()) {
        stage_log.find(
            {.kind = "jumping_increment",
             .amount = jumps[0].to - jumps[0].from,
             .text = fmt::format("surface.increment = \"{}\" jumps from {:.3g} to {:.3g} at x = {:.4g}{}: slopes break "
                                 "there",
                                 params.increment, jumps[0].from, jumps[0].to, jumps[0].x,
                                 jumps.size() > 1 ? fmt::format(", and {} times more", jumps.size() - 1) : ""),
             .key = "surface.increment",
             .numbers = {{"jumps", static_cast<double>(jumps.size())}, {"x", jumps[0].x}}});
    }
}

/// A surface that passes through given points between rivers; random ones shape only what it rises from.
Raster<float> through_points(Raster<float> dem, Ground const& ground, Run const& run) {
    if (ground.given.points.empty()) {
        return dem;
    }
    Grid const& grid = dem.grid();
    std::map<std::int64_t, float> highest;
    for (Vec3 const& p : ground.given.points) {
        auto const [place, is_new] = highest.try_emplace(grid.index(grid.cell_of(in_plan(p))), static_cast<float>(p.z));
        place->second = std::max(place->second, static_cast<float>(p.z));
    }
    std::vector<surface::FeatureCell> cells;
    for (auto const& [cell, z] : highest) {
        cells.push_back({cell, z});
    }
    std::vector<std::int64_t> rivers;
    for (std::int64_t i = 0; i < grid.cells(); ++i) {
        if (!std::isnan(ground.valley.z[i])) {
            rivers.push_back(i);
        }
    }
    return surface::through_heights(std::move(dem), rivers, cells, run);
}

surface::Dilated dilated_on(recipe::Plan const& plan, Ground const& ground, Run const& run) {
    recipe::SurfaceRecipe const& wanted = *plan.recipe.surface;
    Valley const& valley = ground.valley;
    if (wanted.base == recipe::Base::paper) { // without a mask by the closed form
        return ground.whole ? surface::dilate(valley, wanted.dilate, run)
                            : surface::dilate(valley, ground.inside, wanted.dilate, run);
    }
    surface::HarmonicParams params;
    params.tolerance = wanted.tolerance.value_or(params.tolerance);
    Raster<float> const base = wanted.base == recipe::Base::tin ? over_triangles(ground, run)
                                                                : surface::harmonic(valley, ground.inside, params, run);
    return ground.whole ? surface::dilate_over(valley, base, wanted.dilate, run)
                        : surface::dilate_over(valley, base, ground.inside, wanted.dilate, run);
}

surface::Dilated dilated(recipe::Plan const& plan, Ground const& ground, Run const& run) {
    try {
        return dilated_on(plan, ground, run);
    } catch (BadParameter const& fault) { // how many levels there are is known only now
        bool const is_increment = std::string_view(fault.where()) == "surface.increments";
        throw BadParameter(fmt::format("{}{}", is_increment ? "[surface] increment: " : "", fault.what()));
    }
}

/// What a surface is diffused from: rivers, ridges, points, and what follows from them beside them.
Skeleton gathered_skeleton(recipe::Plan const& plan, Ground const& ground, Run const& run) {
    recipe::SkeletonRecipe const wanted = plan.recipe.skeleton.value_or(recipe::SkeletonRecipe{});
    skeleton::DrawSkeletonParams params;
    params.noise.amplitude_m = wanted.ridge_noise_m;
    params.noise.wavelength_m = wanted.ridge_wavelength_m;
    params.noise.seed = plan.recipe.seed;
    Skeleton skeleton = skeleton::draw_skeleton(ground.valley, ground.ridges, ground.points, params, run).skeleton;
    if (wanted.midpoint_inverse_cells > 0.0) {
        skeleton = skeleton::midpoint_inverse(skeleton, {wanted.midpoint_inverse_cells}, run);
    }
    return skeleton;
}

surface::Dilated surface_of(Raster<float> dem) {
    surface::Dilated surface;
    surface.dem = std::move(dem);
    return surface;
}

/// A surface, and how it was solved for where it was.
struct Filled {
    surface::Dilated surface;
    std::optional<SolverStatistics> diffusion = {};
};

Filled diffused(recipe::Plan const& plan, Ground const& ground, Run const& run) {
    surface::DiffuseParams params = plan.recipe.surface->diffuse;
    params.seed = plan.recipe.seed;
    params.tolerance = plan.recipe.surface->tolerance.value_or(params.tolerance);
    surface::Diffused solved = surface::diffuse(gathered_skeleton(plan, ground, run), ground.inside, params, run);
    return {surface_of(std::move(solved.dem)), SolverStatistics{solved.iterations, solved.residual}};
}

Filled by_method(recipe::Plan const& plan, Ground const& ground, Run const& run) {
    recipe::SurfaceRecipe const& wanted = *plan.recipe.surface;
    if (wanted.method == recipe::Method::tin || wanted.method == recipe::Method::raster) {
        Raster<float> dem = wanted.method == recipe::Method::tin ? over_triangles(ground, run)
                                                                 : with_valley(plan.raster, ground.valley);
        for (std::int64_t i = 0; i < ground.inside.cells(); ++i) {
            dem[i] = ground.inside[i] != 0 ? dem[i] : std::numeric_limits<float>::quiet_NaN();
        }
        return {surface_of(std::move(dem))};
    }
    if (wanted.method == recipe::Method::diffuse) {
        return diffused(plan, ground, run);
    }
    Filled made{dilated(plan, ground, run)};
    made.surface.dem = through_points(std::move(made.surface.dem), ground, run);
    return made;
}

std::string about(recipe::Plan const& plan, Filled const& filled) {
    recipe::SurfaceRecipe const& wanted = *plan.recipe.surface;
    switch (wanted.method) {
    case recipe::Method::dilate:
        return fmt::format("{}, {} levels", wanted.dilate.increment.increment, filled.surface.levels);
    case recipe::Method::diffuse: return fmt::format("diffused, {} iterations", filled.diffusion->iterations);
    case recipe::Method::raster: return "of the DEM";
    case recipe::Method::equilibrium:
    case recipe::Method::tin:
    case recipe::Method::regress: break;
    }
    return "over triangles";
}

/// The surface between the rivers.
Filled filled(recipe::Plan const& plan, Ground const& ground, StageLog& stage_log, Run const& run) {
    Filled result = stage_log.stage("fill", [&] { return by_method(plan, ground, run); });
    Grid const& grid = ground.valley.z.grid();
    stage_log.say(fmt::format("{}x{}, {}", grid.width, grid.height, about(plan, result)));
    recipe::SurfaceRecipe const& wanted = *plan.recipe.surface;
    if (wanted.method == recipe::Method::dilate) {
        warn_of_jumps(result.surface, wanted.dilate.increment, stage_log);
    }
    return result;
}

/// Checks that slopes rise as high above their rivers as the recipe asks.
std::vector<Check> relief_checks(recipe::Plan const& plan, surface::Dilated const& surface) {
    constexpr double allowed = 0.01;
    double const asked = plan.recipe.surface->dilate.relief_m;
    if (plan.recipe.surface->method != recipe::Method::dilate || !(asked > 0.0)) {
        return {};
    }
    double const error = std::fabs(surface.rise_m / asked - 1.0);
    return {{"relief_error", error, allowed, error <= allowed}};
}

/// Adds fractal detail: none in the valleys, all of it some cells away.
DetailedTerrain with_detail_beside_rivers(recipe::Plan const& plan, Raster<float> dem, Valley const& valley,
                                          Run const& run) {
    constexpr double near_cells = 8.0; // within which detail grows from nothing to two thirds
    DetailedTerrain const detail = detail_alone(plan, dem.grid(), run);
    Raster<float> result = std::move(dem);
    surface::Expansion const expansion = surface::expand(valley, run);
    for (std::int64_t i = 0; i < result.cells(); ++i) {
        double const share = 1.0 - portable::exp(-static_cast<double>(expansion.level[i]) / near_cells);
        result[i] = static_cast<float>(static_cast<double>(result[i]) + share * static_cast<double>(detail.dem[i]));
    }
    return {detail.statistics, std::move(result)};
}

/// A surface before patches and drainage, with what it was drawn through.
struct UndrainedTerrain {
    Rivers rivers = {};
    Valley valley = {};
    surface::Dilated surface = {};
    RidgeLines ridges = {};
    std::optional<Tin> tin = {};
    Channels channels = {};
    std::int64_t lakes = 0;
    HeightsStatistics heights = {};
    std::optional<EquilibriumStatistics> equilibrium = {};
    std::optional<SolverStatistics> diffusion = {};
    std::optional<DetailStatistics> detail = {};
    std::optional<fractal::MatchedDem> projection = {};
    double fine_forms_cells = 0.0;
    std::vector<Check> checks = {};
};

RidgeLines joined(RidgeLines some, RidgeLines const& others) {
    append(some.lines, others.lines);
    return some;
}

/// Draws the surface that the plan asks for through the rivers' cells, which keep their heights, and through points; in
/// equilibrium rivers have their heights from it.
UndrainedTerrain draw_around_rivers(recipe::Plan const& plan, Planform const& planform, StageLog& stage_log,
                                    Run const& run) {
    recipe::Recipe const& recipe = plan.recipe;
    if (!plan.grid) { // else it was checked before the rivers were grown
        recipe::check_detail(recipe, planform.grid.width, planform.grid.height);
        recipe::require_skeleton_on_grid(plan, planform.grid);
    }
    bool const balanced = recipe::in_equilibrium(recipe);
    EquilibriumResult solved = balanced ? draw_in_equilibrium(plan, planform, stage_log, run) : EquilibriumResult{};
    RaisedRivers raised = balanced ? RaisedRivers{} : raise_rivers(plan, planform, stage_log, run);
    Rivers rivers =
        balanced ? std::move(solved.rivers) : rivers_of(std::move(raised.network), planform.types, planform.file.clues);
    Valley valley = balanced ? std::move(solved.valley) : std::move(raised.valley);
    std::vector<Check> checks = std::move(solved.checks);
    stage_log.find(raised.findings);
    Mask const inside = balanced ? Mask{} : inside_of(recipe, planform.land, valley, run);
    std::optional<FeaturePoints> own;
    if (recipe::scatters_points(recipe)) {
        skeleton::Scattered found = scattered(plan, valley, inside, stage_log, run);
        checks.push_back(points_missing(found, *recipe.skeleton, stage_log));
        own = std::move(found.points);
    }
    FeaturePoints points = own ? std::move(*own) : FeaturePoints{};
    RidgeLines ridges = ridges_between(plan, rivers, planform.grid, stage_log, run);
    RidgeLines given = balanced                         ? ridges_on(plan, solved.dem)
                       : plan.ridge_lines.lines.empty() ? RidgeLines{}
                                                        : ridges_with_heights(plan, valley, run);
    append(points.points, plan.points.points);
    std::optional<Tin> tin = triangulated(plan, rivers.network, joined(ridges, given), points, stage_log, run);
    FeaturePoints through = plan.points;
    append(through.points, as_points(given, planform.grid).points);
    append(points.points, as_points(given, planform.grid).points);
    bool const whole = recipe.surface->mask.empty() && planform.land.values().empty();
    Filled made = balanced ? Filled{surface_of(std::move(solved.dem))}
                           : filled(plan, {valley, ridges, tin, points, through, inside, whole}, stage_log, run);
    append(checks, balanced ? std::vector<Check>{} : relief_checks(plan, made.surface));
    std::optional<DetailStatistics> detail;
    if (recipe::levels_of(recipe) > 0) {
        DetailedTerrain detailed = with_detail_beside_rivers(plan, std::move(made.surface.dem), valley, run);
        made.surface.dem = std::move(detailed.dem);
        detail = detailed.statistics;
    }
    return {.rivers = std::move(rivers),
            .valley = std::move(valley),
            .surface = std::move(made.surface),
            .ridges = joined(std::move(ridges), given),
            .tin = std::move(tin),
            .channels = balanced ? std::move(solved.channels) : std::move(raised.channels),
            .lakes = balanced ? solved.lakes : raised.lakes,
            .heights = balanced ? solved.heights : raised.statistics,
            .equilibrium = balanced ? std::optional(std::move(solved.statistics)) : std::nullopt,
            .diffusion = made.diffusion,
            .detail = detail,
            .checks = std::move(checks)};
}

/// A surface from numbers and points.
UndrainedTerrain draw_alone(recipe::Plan const& plan, StageLog& stage_log, Run const& run) {
    stage_log.find(recipe::conversions(plan.recipe, *plan.grid));
    SurfaceAlone alone = draw_without_rivers(plan, stage_log, run);
    return {.surface = surface_of(std::move(alone.dem)),
            .tin = std::move(alone.tin),
            .diffusion = alone.diffusion,
            .detail = alone.detail,
            .projection = std::move(alone.projection),
            .fine_forms_cells = alone.fine_forms_cells,
            .checks = std::move(alone.checks)};
}

BlendIntoParams params_of(recipe::Recipe const& recipe, recipe::PatchRecipe const& patch) {
    BlendIntoParams params;
    params.target = "the land";
    params.source = recipe::file_in(recipe, patch.source);
    params.mask = recipe::file_in(recipe, patch.mask);
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

/// A surface with patches, and the valley cells that it honours.
struct Patched {
    Raster<float> dem;
    Valley valley;
    std::vector<PatchStatistics> patches;
};

/// Pastes the recipe's patches into the surface, in their order; rivers keep their cells' heights unless a patch says
/// otherwise.
Patched with_patches(recipe::Plan const& plan, Raster<float> dem, Valley valley, StreamNetwork const& network,
                     StageLog& stage_log, Run const& run) {
    Patched result{std::move(dem), std::move(valley), {}};
    for (recipe::PatchRecipe const& patch : plan.recipe.patches) {
        bool const keeps = patch.rivers == recipe::PatchRivers::keep && plan.recipe.network.has_value();
        BlendedDem made = stage_log.stage("blend", [&] {
            return blend_into(result.dem, keeps ? river_mask(result.valley) : Mask{}, params_of(plan.recipe, patch),
                              run);
        });
        stage_log.find(made.findings);
        result.dem = std::move(made.pasted.dem);
        result.patches.push_back({made.pasted.cells, made.pasted.kept, made.pasted.seam_max_m, made.pasted.seam_rms_m});
        stage_log.say(
            fmt::format("{} cells of {}, seam {:.2g} m", made.pasted.cells, patch.source, made.pasted.seam_rms_m));
    }
    if (plan.recipe.network && recipe::replaces_rivers(plan.recipe)) {
        result.valley = honoured_valley(std::move(result.valley), network, result.dem);
    }
    return result;
}

/// A surface after hydrological conditioning.
struct Conditioned {
    Raster<float> dem;
    std::optional<ConditioningChanges> statistics;
};

/// Cells in which rivers end inland, where the recipe keeps these ends.
std::vector<CellIndex> sinks_of(recipe::Plan const& plan, Raster<float> const& dem, StreamNetwork const& network) {
    bool const sinks = plan.recipe.network && plan.recipe.network->inland == recipe::InlandEnds::sink;
    return sinks ? cells_of(inland_ends(network, dem), network, dem.grid()) : std::vector<CellIndex>{};
}

/// Water leaves the land in sinks: while it is conditioned they are holes in it.
Conditioned conditioned(recipe::Plan const& plan, Raster<float> dem, Valley valley, StreamNetwork const& network,
                        StageLog& stage_log, Run const& run) {
    if (!recipe::conditions_dem(plan.recipe)) {
        return {std::move(dem), std::nullopt};
    }
    constexpr float hole = std::numeric_limits<float>::quiet_NaN();
    if (!plan.recipe.network) {
        valley.z = Raster<float>(dem.grid(), hole);
    }
    std::vector<CellIndex> const sinks = sinks_of(plan, dem, network);
    std::vector<float> heights;
    for (CellIndex const sink : sinks) {
        heights.push_back(std::exchange(dem[sink], hole));
        valley.z[sink] = hole;
    }
    flow::ConditionedDem result = stage_log.stage(
        "carve", [&] { return flow::condition(std::move(dem), valley, {*plan.recipe.surface->drain}, run); });
    Grid const grid = result.dem.grid();
    for (std::size_t i = 0; i < sinks.size(); ++i) {
        float lowest = std::numeric_limits<float>::infinity();
        for (Cell const step : d8_steps) {
            Cell const c{grid.at(sinks[i]).col + step.col, grid.at(sinks[i]).row + step.row};
            lowest = grid.contains(c) ? std::fmin(lowest, result.dem[c]) : lowest;
        }
        result.dem[sinks[i]] = std::min(heights[i], std::nextafterf(lowest, -std::numeric_limits<float>::infinity()));
    }
    stage_log.say(fmt::format("banks raised {:.0f} m3; depressions filled {:.0f} m3, cut {:.0f} m3",
                              result.banks.raised_m3, result.depressions.raised_m3, result.depressions.cut_m3));
    return {std::move(result.dem), ConditioningChanges{result.banks, result.depressions}};
}

flow::FlowField drainage_of(recipe::Plan const& plan, Raster<float> const& dem, StreamNetwork const& network,
                            StageLog& stage_log, Run const& run) {
    run.at(0.0, fmt::format("drain {} cells", dem.cells()).c_str());
    return stage_log.stage("drain", [&] { return flow::route(dem, sinks_of(plan, dem, network), run); });
}

/// Rivers that have heights of their own, where the recipe asks for no surface.
Terrain rivers_alone(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    StageLog stage_log(run);
    RaisedRivers raised = raise_rivers(plan, planform, stage_log, run);
    Terrain terrain;
    terrain.grid = planform.grid;
    terrain.land = planform.land;
    terrain.rivers = rivers_of(std::move(raised.network), planform.types, planform.file.clues);
    terrain.valley = std::move(raised.valley);
    terrain.areas = raised.areas ? std::move(*raised.areas) : flow::areas_nearest(planform.network, planform.grid, run);
    terrain.heights = raised.statistics;
    terrain.findings = std::move(raised.findings);
    terrain.timings_s = stage_log.take();
    return terrain;
}

} // namespace

namespace {

/// A surface before it drains, with what was found and the times of drawing it.
struct TimedSurface {
    UndrainedTerrain terrain;
    std::vector<Finding> findings;
    Timings timings_s;
};

TimedSurface undrained(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    return kept_or_made(
        run, "surface", [&] { return recipe::surface_made_from(plan); },
        [&] {
            StageLog stage_log(run);
            UndrainedTerrain drawn = plan.recipe.network ? draw_around_rivers(plan, planform, stage_log, run)
                                                         : draw_alone(plan, stage_log, run);
            return TimedSurface{std::move(drawn), stage_log.take_findings(), stage_log.take()};
        },
        [](TimedSurface const& made) {
            constexpr std::int64_t of_cell = 16; // heights, valley, levels
            return of_cell * made.terrain.surface.dem.cells();
        });
}

void show(Raster<float> const& dem, bool is_finished, Run const& run) {
    if (run.preview) {
        run.preview(dem, is_finished);
    }
}

Terrain terrain_with_surface(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    bool const has_rivers = plan.recipe.network.has_value();
    StageLog stage_log(run);
    TimedSurface timed = undrained(plan, planform, run);
    stage_log.add(timed.timings_s);
    stage_log.find(timed.findings);
    UndrainedTerrain& drawn = timed.terrain;
    if (!has_rivers || !recipe::in_equilibrium(plan.recipe)) { // in equilibrium it was seen, and drains as it is
        show(drawn.surface.dem, false, run);
    }
    Patched patched = with_patches(plan, std::move(drawn.surface.dem), std::move(drawn.valley),
                                   drawn.rivers.network.planform, stage_log, run);
    Conditioned drained =
        conditioned(plan, std::move(patched.dem), patched.valley, drawn.rivers.network.planform, stage_log, run);
    show(drained.dem, true, run);
    flow::FlowField drainage = drainage_of(plan, drained.dem, drawn.rivers.network.planform, stage_log, run);
    WithSideValleys made = with_side_valleys(plan, std::move(drawn.rivers), std::move(patched.valley), drawn.channels,
                                             drained.dem, drainage, stage_log, run);
    surface::Dilated surface = std::move(drawn.surface);
    surface.dem = std::move(drained.dem); // with which it was made
    flow::ContributingAreas areas =
        has_rivers ? flow::areas_d8(made.rivers.network.planform, drainage, run) : flow::ContributingAreas{};
    return {.grid = has_rivers ? planform.grid : *plan.grid,
            .land = recipe::on_raster(plan.recipe) ? Mask{} : planform.land, // what has no data need not be sea
            .rivers = std::move(made.rivers),
            .valley = std::move(made.valley),
            .areas = std::move(areas),
            .surface = std::move(surface),
            .drainage = std::move(drainage),
            .ridges = std::move(drawn.ridges),
            .tin = std::move(drawn.tin),
            .channels = std::move(drawn.channels),
            .lakes = drawn.lakes,
            .heights = drawn.heights,
            .equilibrium = std::move(drawn.equilibrium),
            .side_valleys = made.statistics,
            .diffusion = drawn.diffusion,
            .detail = drawn.detail,
            .patches = std::move(patched.patches),
            .drained = drained.statistics,
            .projection = std::move(drawn.projection),
            .fine_forms_cells = drawn.fine_forms_cells,
            .checks = std::move(drawn.checks),
            .findings = stage_log.take_findings(),
            .timings_s = stage_log.take()};
}

} // namespace

Terrain make_terrain(recipe::Plan const& plan, Planform const& planform, Run const& run) {
    bool const rivers_only = plan.recipe.network && !plan.recipe.surface;
    Terrain terrain = rivers_only ? rivers_alone(plan, planform, run) : terrain_with_surface(plan, planform, run);
    run.report(terrain.findings);
    return terrain;
}

} // namespace thalweg::make
