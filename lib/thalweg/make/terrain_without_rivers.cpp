// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include <thalweg/core/run/error.hpp>
#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/geometry/natural_neighbours.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/make/internal/terrain.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/random_fields.hpp>
#include <thalweg/skeleton/regress.hpp>
#include <thalweg/skeleton/scatter.hpp>
#include <thalweg/solver/spectral/circulant.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>
#include <thalweg/surface/diffusion/diffusion.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

namespace thalweg::make {
namespace {

constexpr double default_length_cells = 20.0;
constexpr double default_dimension = 2.4;
constexpr double default_std_m = 100.0;

// The targets of [statistics]; empty: there are none.
recipe::StatisticsRecipe const& asked(recipe::Recipe const& recipe) {
    static recipe::StatisticsRecipe const nothing_asked;
    return recipe.statistics ? *recipe.statistics : nothing_asked;
}

// The target mean, or the middle between the extremes.
double mean_of(recipe::StatisticsRecipe const& s) {
    if (s.mean) {
        return *s.mean;
    }
    return s.max && s.min ? 0.5 * ((*s.max)[0] + (*s.min)[0]) : 0.0;
}

// The covariance of terrain with these statistics, on cells larger by a factor.
solver::StableCovariance covariance_of(recipe::StatisticsRecipe const& s, double step) {
    solver::StableCovariance covariance;
    covariance.lx_cells = (s.length ? (*s.length)[0] : default_length_cells) / step;
    covariance.ly_cells = (s.length ? (*s.length)[1] : default_length_cells) / step;
    covariance.dimension = s.dimension.value_or(default_dimension);
    // Slopes are measured between neighbours: they do not apply to coarser cells.
    return s.slope && step == 1.0 ? solver::with_slope(covariance, s.std.value_or(default_std_m), *s.slope)
                                  : covariance;
}

Raster<float> drawn_to_extremes(Raster<float> land, recipe::StatisticsRecipe const& s, int levels) {
    double const step = static_cast<double>(std::int64_t{1} << levels);
    for (auto const& extreme : {s.max, s.min}) {
        if (!extreme || s.reach_cells <= 0.0) {
            continue;
        }
        auto const nearest = [&](double fine, std::int64_t side) {
            return std::min(side - 1, static_cast<std::int64_t>(std::floor(fine / step + 0.5)));
        };
        Cell const centre{nearest((*extreme)[1], land.width()), nearest((*extreme)[2], land.height())};
        land =
            skeleton::attract(std::move(land), {centre, (*extreme)[0], std::max(1.0, s.reach_cells / step), s.falloff});
    }
    return s.mean ? skeleton::shift_mean(std::move(land), *s.mean) : land;
}

// Random terrain with this prior, on cells that detail will halve this many times.
Raster<float> random_land(recipe::Recipe const& recipe, recipe::Prior prior, Grid const& coarse, int levels,
                          Run const& run) {
    recipe::StatisticsRecipe const& s = asked(recipe);
    double const step = static_cast<double>(std::int64_t{1} << levels);
    double const lx = (s.length ? (*s.length)[0] : default_length_cells) / step;
    double const ly = (s.length ? (*s.length)[1] : default_length_cells) / step;
    double const std = s.std.value_or(default_std_m);
    skeleton::FieldParams const field{mean_of(s), std, lx, ly, recipe.seed};
    switch (prior) {
    case recipe::Prior::separable: return drawn_to_extremes(skeleton::separable_ar(coarse, field, run), s, levels);
    case recipe::Prior::markov3: return drawn_to_extremes(skeleton::markov3(coarse, field, run), s, levels);
    default: break;
    }
    skeleton::GrfParams params;
    params.mean = mean_of(s);
    params.std = std;
    params.covariance = covariance_of(s, step);
    params.seed = recipe.seed;
    return skeleton::grf(coarse, params, run).dem;
}

/// The default [surface] for points.
recipe::SurfaceRecipe over_triangles() {
    recipe::SurfaceRecipe surface;
    surface.method = recipe::Method::tin;
    return surface;
}

// The points of the terrain: from the file, or random with the extremes among them.
skeleton::Scattered points_of(recipe::Recipe const& recipe, Grid const& grid, FeaturePoints const& given,
                              Run const& run) {
    if (!recipe.skeleton || recipe.skeleton->scatter == 0) {
        return {.points = given};
    }
    recipe::StatisticsRecipe const& s = asked(recipe);
    skeleton::ScatterParams params;
    params.seed = recipe.seed;
    params.count = recipe.skeleton->scatter;
    params.spacing_cells = recipe.skeleton->spacing_cells;
    params.law = recipe.skeleton->law;
    params.mean_m = mean_of(s);
    params.std_m = s.std.value_or(default_std_m);
    params.reach_cells = s.reach_cells;
    params.deviation = recipe.skeleton->deviation;
    params.falloff = recipe.skeleton->falloff;
    auto const place = [&](std::optional<std::array<double, 3>> const& e) -> std::optional<Vec3> {
        if (!e) {
            return std::nullopt;
        }
        Vec2 const at = grid.centre({static_cast<std::int64_t>((*e)[1]), static_cast<std::int64_t>((*e)[2])});
        return Vec3{at.x, at.y, (*e)[0]};
    };
    params.highest = place(s.max);
    params.lowest = place(s.min);
    return skeleton::scatter(grid, params, run);
}

// Terrain through points, and its parameters.
struct LandOfPoints {
    Raster<float> land;
    std::optional<Tin> tin = {};
    std::optional<SolverStatistics> diffusion = {};
    std::vector<Finding> findings = {};
};

// grid: of the terrain, whose cells may be coarser than the recipe's, of cell_m.
LandOfPoints land_of_points(recipe::Recipe const& recipe, double cell_m, FeaturePoints const& points, Grid const& grid,
                            Run const& run) {
    recipe::SurfaceRecipe const wanted = recipe.surface.value_or(over_triangles());
    recipe::StatisticsRecipe const& s = asked(recipe);
    if (wanted.method == recipe::Method::regress) {
        skeleton::RegressParams params = wanted.regress;
        double const step = grid.cell_m / cell_m;
        params.length_x = (s.length ? (*s.length)[0] : default_length_cells) / step;
        params.length_y = (s.length ? (*s.length)[1] : default_length_cells) / step;
        params.slope_rad = s.slope.value_or(0.0);
        skeleton::Regression regression = skeleton::regress(points, grid, params, run);
        LandOfPoints made{std::move(regression.surface)};
        if (regression.rank < regression.terms) {
            made.findings.push_back({.kind = "rank_deficient",
                                     .amount = static_cast<double>(regression.terms - regression.rank),
                                     .text = fmt::format("the points determine {} of {} terms of the regression",
                                                         regression.rank, regression.terms),
                                     .key = "surface.method"});
        }
        return made;
    }
    if (wanted.method == recipe::Method::diffuse) {
        Valley const no_rivers{Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
        surface::DiffuseParams params = wanted.diffuse;
        params.seed = recipe.seed;
        params.tolerance = wanted.tolerance.value_or(params.tolerance);
        surface::Diffused land =
            surface::diffuse(skeleton::draw_skeleton(no_rivers, {}, points, {}, run).skeleton, params, run);
        return {std::move(land.dem), {}, SolverStatistics{land.iterations, land.residual}};
    }
    Tin tin = geometry::triangulate(points.points, {}, run).tin;
    bool const natural = wanted.interpolation == recipe::Interpolation::natural;
    Raster<float> land = natural
                             ? geometry::natural_neighbours(points.points, grid,
                                                            {geometry::NaturalNeighboursParams::Outside::nearest}, run)
                             : surface::rasterise_tin(tin, grid, {surface::RasteriseTinParams::Outside::nearest}, run);
    return {std::move(land), std::move(tin)};
}

constexpr double most_fine_cells = 8.0;
constexpr double allowed_error = 0.01;
constexpr double allowed_dimension_error = 0.02;

// A terrain matched to the statistics.
struct MatchedTerrain {
    fractal::MatchedDem projection;
    double fine_forms_cells = 0.0; // [cells] as Terrain
};

fractal::Targets targets_of(recipe::StatisticsRecipe const& s) {
    fractal::Targets targets;
    targets.mean = s.mean;
    targets.std = s.std;
    auto const fixed = [](std::array<double, 3> const& e) {
        return fractal::FixedHeight{{static_cast<std::int64_t>(e[1]), static_cast<std::int64_t>(e[2])}, e[0]};
    };
    if (s.max) {
        targets.max = fixed(*s.max);
    }
    if (s.min) {
        targets.min = fixed(*s.min);
    }
    if (s.length) {
        targets.lx_cells = (*s.length)[0];
        targets.ly_cells = (*s.length)[1];
    }
    targets.slope_rad = s.slope;
    targets.dimension = s.dimension;
    return targets;
}

/// Names the keys of [statistics] in errors about wrong targets.
template <class Work> auto naming_keys(Work const& work) {
    try {
        return work();
    } catch (BadParameter const& fault) {
        static constexpr std::array<std::pair<char const*, char const*>, 7> keys{{{"mean", "mean"},
                                                                                  {"deviation", "std"},
                                                                                  {"highest", "max"},
                                                                                  {"lowest", "min"},
                                                                                  {"correlation length", "length"},
                                                                                  {"slope", "slope"},
                                                                                  {"dimension", "dimension"}}};
        std::string const words = fault.what();
        std::string names;
        for (auto const& [word, key] : keys) {
            if (words.find(word) != std::string::npos) {
                names += fmt::format("{}statistics.{}", names.empty() ? "" : ", ", key);
            }
        }
        throw BadParameter(fmt::format("{}: {}", names.empty() ? "[statistics]" : names, words));
    }
}

/// Shifts and scales terrain to the target mean and deviation, so that matching begins close to them.
Raster<float> standardised(Raster<float> land, recipe::StatisticsRecipe const& s, Run const& run) {
    measure::Statistics const now = measure::statistics(land, run);
    double const stretch = s.std && now.std > 0.0 ? *s.std / now.std : 1.0;
    double const mean = s.mean.value_or(now.mean);
    for (float& z : land.values()) {
        z = static_cast<float>(mean + (static_cast<double>(z) - now.mean) * stretch);
    }
    return land;
}

/// Heights of input points that matching must keep: the first of each cell, none at an extreme.
std::vector<fractal::FixedHeight> heights_to_keep(recipe::Recipe const& recipe, FeaturePoints const& given,
                                                  Grid const& grid) {
    std::vector<fractal::FixedHeight> kept;
    if (recipe.statistics->skeleton != recipe::Prior::points) {
        return kept;
    }
    std::set<std::int64_t> taken;
    for (auto const& e : {recipe.statistics->max, recipe.statistics->min}) {
        if (e) {
            taken.insert(grid.index({static_cast<std::int64_t>((*e)[1]), static_cast<std::int64_t>((*e)[2])}));
        }
    }
    for (Vec3 const& p : given.points) {
        Cell const cell = grid.cell_of({p.x, p.y});
        if (grid.contains(cell) && taken.insert(grid.index(cell)).second) {
            kept.push_back({cell, p.z});
        }
    }
    return kept;
}

/// Warns of lengths that only a fit can determine: correlation is measured over lags of up to half an axis.
void warn_of_lengths(recipe::StatisticsRecipe const& s, Grid const& grid, StageLog& stage_log) {
    if (!s.length) {
        return;
    }
    auto const warn = [&](char const* name, double length, char const* axis, std::int64_t cells) {
        if (length > 0.5 * static_cast<double>(cells)) {
            stage_log.find({.kind = "small_grid",
                            .amount = length,
                            .text = fmt::format("statistics.length: {} of {} cells is more than half of the {} {}: the "
                                                "grid is too small to show it, and a fit stands for it",
                                                name, length, cells, axis),
                            .key = "statistics.length",
                            .numbers = {{"grid", static_cast<double>(cells), "cells"}}});
        }
    };
    warn("Lx", (*s.length)[0], "columns", grid.width);
    warn("Ly", (*s.length)[1], "rows", grid.height);
}

// Throws, before any work, if the statistics cannot be reached on this grid; warns of lengths that only a fit can
// determine.
void require_targets(recipe::StatisticsRecipe const& wanted, Grid const& grid, StageLog& stage_log) {
    naming_keys([&] { fractal::check_targets(Raster<float>(grid), targets_of(wanted)); });
    warn_of_lengths(wanted, grid, stage_log);
}

// Matches a terrain to the statistics. One from which they cannot be reached, smoother or rougher between neighbours
// than the target, takes its fine forms from a Gaussian terrain: as few as possible. given: points whose heights stay.
MatchedTerrain matched_to_statistics(recipe::Recipe const& recipe, Raster<float> land, FeaturePoints const& given,
                                     Run const& run) {
    recipe::StatisticsRecipe const& s = *recipe.statistics;
    Grid const grid = land.grid();
    std::vector<fractal::FixedHeight> const kept = heights_to_keep(recipe, given, grid);
    fractal::MatchParams params;
    params.prior = covariance_of(s, 1.0);
    MatchedTerrain brought{
        naming_keys([&] { return fractal::match_statistics(land, targets_of(s), kept, params, run); })};
    if (!brought.projection.converged && s.skeleton != recipe::Prior::grf) {
        land = standardised(std::move(land), s, run);
        Raster<float> const gaussian = standardised(random_land(recipe, recipe::Prior::grf, grid, 0, run), s, run);
        for (double cells = 1.0; cells <= most_fine_cells; cells *= 2.0) {
            fractal::MatchedDem again = fractal::match_statistics(fractal::with_fine_forms(land, gaussian, cells, run),
                                                                  targets_of(s), kept, params, run);
            if (again.converged) {
                brought.fine_forms_cells = cells;
                brought.projection = std::move(again);
                break;
            }
        }
    }
    return brought;
}

// Checks whether the statistics match their targets.
std::vector<Check> residual_checks(fractal::MatchedDem const& projection) {
    std::vector<Check> checks;
    for (fractal::Residual const& r : projection.residuals) {
        bool const dimension = r.name == "dimension";
        double const error = dimension ? std::fabs(r.got - r.asked) : std::fabs(r.error);
        double const limit = dimension ? allowed_dimension_error : allowed_error;
        checks.push_back({"statistics_" + r.name, error, limit, error <= limit});
    }
    return checks;
}

DetailedTerrain displaced(fractal::MidpointParams params, std::uint64_t seed, Raster<float> const& coarse,
                          Grid const& grid, Run const& run) {
    params.width = grid.width;
    params.height = grid.height;
    params.seed = seed;
    fractal::Displaced const made = fractal::midpoint(coarse, params, run);
    Raster<float> land(grid); // the exact frame, not one computed back from the coarse cells
    std::copy(made.dem.values().begin(), made.dem.values().end(), land.values().begin());
    return {{made.hurst, made.sigma}, std::move(land)};
}

// Adds the planned detail to coarse terrain.
DetailedTerrain with_detail(recipe::Plan const& plan, Raster<float> const& coarse, Grid const& grid, Run const& run) {
    return displaced(plan.recipe.detail->midpoint, plan.recipe.seed, coarse, grid, run);
}

} // namespace

DetailedTerrain detail_alone(recipe::Plan const& plan, Grid const& grid, Run const& run) {
    fractal::MidpointParams wanted = plan.recipe.detail->midpoint;
    wanted.hurst = wanted.hurst.value_or(3.0 - default_dimension);
    Raster<float> const flat(recipe::coarse_grid(grid, recipe::levels_of(plan.recipe)), 0.0F);
    return displaced(wanted, plan.recipe.seed, flat, grid, run);
}

namespace {

/// Removes the heights of cells without data in a raster, and of those outside the mask of [surface].
Raster<float> left_out(Raster<float> land, recipe::Plan const& plan, Run const& run) {
    recipe::Recipe const& recipe = plan.recipe;
    for (std::int64_t i = 0; i < plan.raster.cells(); ++i) {
        land[i] = std::isnan(plan.raster[i]) ? plan.raster[i] : land[i];
    }
    if (!recipe.surface || recipe.surface->mask.empty()) {
        return land;
    }
    Mask const inside = recipe::read_mask_of_land(recipe::file_in(recipe, recipe.surface->mask), land.grid(), run);
    if (std::all_of(inside.values().begin(), inside.values().end(), [](std::uint8_t v) { return v == 0; })) {
        throw BadInput(fmt::format("surface.mask = \"{}\" leaves out every cell", recipe.surface->mask));
    }
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] = inside[i] != 0 ? land[i] : std::numeric_limits<float>::quiet_NaN();
    }
    return land;
}

/// The coarse surface that detail starts from.
struct Coarse {
    Raster<float> dem;
    std::optional<Tin> tin = {};
    std::optional<SolverStatistics> diffusion = {};
    std::vector<Check> checks = {};
};

/// The cells of a raster that coarse cells lie over; at its eastern and southern edge the last ones.
Raster<float> every_cell(Raster<float> const& raster, Grid const& coarse, int levels) {
    Raster<float> dem(coarse);
    auto const at = [&](std::int64_t i, std::int64_t side) { return std::min(i << levels, side - 1); };
    for (std::int64_t i = 0; i < coarse.cells(); ++i) {
        Cell const c = coarse.at(i);
        dem[i] = raster[Cell{at(c.col, raster.width()), at(c.row, raster.height())}];
    }
    return dem;
}

/// It is that of a raster, goes through points or is random.
Coarse with_coarse_terrain(recipe::Plan const& plan, Grid const& grid, StageLog& stage_log, Run const& run) {
    recipe::Recipe const& recipe = plan.recipe;
    int const levels = recipe::levels_of(recipe);
    Grid const coarse = recipe::coarse_grid(grid, levels);
    if (recipe::on_raster(recipe)) {
        Coarse result{stage_log.stage("land", [&] { return every_cell(plan.raster, coarse, levels); })};
        stage_log.say(fmt::format("{}x{} cells of the DEM", coarse.width, coarse.height));
        return result;
    }
    if (recipe.statistics && recipe.statistics->skeleton != recipe::Prior::points) {
        Coarse result{stage_log.stage(
            "land", [&] { return random_land(recipe, recipe.statistics->skeleton, coarse, levels, run); })};
        stage_log.say(fmt::format("random, {}x{} cells of {} m", coarse.width, coarse.height, coarse.cell_m));
        return result;
    }
    skeleton::Scattered const points = points_of(recipe, grid, plan.points, run);
    std::vector<Check> checks;
    if (recipe::scatters_points(recipe)) {
        checks.push_back(points_missing(points, *recipe.skeleton, stage_log));
    }
    LandOfPoints made =
        stage_log.stage("land", [&] { return land_of_points(recipe, grid.cell_m, points.points, coarse, run); });
    stage_log.find(made.findings);
    stage_log.say(fmt::format("{} points", points.points.points.size()));
    return {std::move(made.land), std::move(made.tin), made.diffusion, std::move(checks)};
}

} // namespace

Check points_missing(skeleton::Scattered const& points, recipe::SkeletonRecipe const& wanted, StageLog& stage_log) {
    if (points.density > skeleton::darts_density) {
        stage_log.find({.kind = "close_points",
                        .amount = points.density,
                        .text = fmt::format("{} points {} cells apart have a density of {:.3f}, about as dense as "
                                            "points at random can stand (0.7)",
                                            wanted.scatter, wanted.spacing_cells, points.density),
                        .key = "skeleton.spacing"});
    }
    if (points.missing > 0) {
        stage_log.find({.kind = "points_without_room",
                        .amount = static_cast<double>(points.missing),
                        .text = fmt::format("{} of {} points found no room", points.missing, wanted.scatter),
                        .remedy = "A smaller skeleton.spacing or skeleton.scatter leaves them some",
                        .key = "skeleton.scatter",
                        .numbers = {{"points", static_cast<double>(wanted.scatter)}}});
    }
    return {"points_missing", static_cast<double>(points.missing), 0.0, points.missing == 0};
}

SurfaceAlone draw_without_rivers(recipe::Plan const& plan, StageLog& stage_log, Run const& run) {
    Grid const& grid = *plan.grid;
    if (plan.recipe.statistics) { // before any work
        require_targets(*plan.recipe.statistics, grid, stage_log);
    }
    Coarse coarse = with_coarse_terrain(plan, grid, stage_log, run);
    Raster<float> dem = std::move(coarse.dem);
    std::optional<DetailStatistics> detail;
    if (int const levels = recipe::levels_of(plan.recipe); levels > 0) {
        DetailedTerrain made = stage_log.stage("detail", [&] { return with_detail(plan, dem, grid, run); });
        detail = made.statistics;
        dem = std::move(made.dem);
        stage_log.say(fmt::format("midpoint displacement, {} levels", levels));
    }
    if (!plan.recipe.statistics) {
        return {.dem = left_out(std::move(dem), plan, run),
                .tin = std::move(coarse.tin),
                .diffusion = coarse.diffusion,
                .detail = detail,
                .checks = std::move(coarse.checks)};
    }
    MatchedTerrain brought = stage_log.stage(
        "project", [&] { return matched_to_statistics(plan.recipe, std::move(dem), plan.points, run); });
    stage_log.say(fmt::format("{} statistics within {:.2g} %, {} steps{}", brought.projection.residuals.size(),
                              100.0 * brought.projection.largest_error, brought.projection.iterations,
                              brought.fine_forms_cells > 0.0 ? ", fine forms of a Gaussian surface" : ""));
    std::vector<Check> checks = std::move(coarse.checks);
    append(checks, residual_checks(brought.projection));
    Raster<float> matched = std::move(brought.projection.dem);
    brought.projection.dem = {};
    return {.dem = std::move(matched),
            .tin = std::move(coarse.tin),
            .diffusion = coarse.diffusion,
            .detail = detail,
            .projection = std::move(brought.projection),
            .fine_forms_cells = brought.fine_forms_cells,
            .checks = std::move(checks)};
}

} // namespace thalweg::make
