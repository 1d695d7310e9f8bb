// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/land.hpp>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/fractal/check_targets.hpp>
#include <thalweg/fractal/estimate_fractal.hpp>
#include <thalweg/fractal/fine_forms.hpp>
#include <thalweg/geometry/natural_neighbours.hpp>
#include <thalweg/geometry/triangulate.hpp>
#include <thalweg/io/frame/projection.hpp>
#include <thalweg/io/mesh/read_points.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/pipeline/plan/frame.hpp>
#include <thalweg/pipeline/plan/internal/read_cells.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_asks.hpp>
#include <thalweg/pipeline/recipe/internal/recipe_files.hpp>
#include <thalweg/skeleton/draw_skeleton.hpp>
#include <thalweg/skeleton/grf.hpp>
#include <thalweg/skeleton/markov3.hpp>
#include <thalweg/skeleton/separable_ar.hpp>
#include <thalweg/skeleton/shift_mean.hpp>
#include <thalweg/solver/statistics/expected_slope.hpp>
#include <thalweg/surface/diffusion/diffuse.hpp>
#include <thalweg/surface/tin/rasterise_tin.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace thalweg::pipeline {

namespace {

constexpr double default_length_cells = 20.0;
constexpr double default_dimension = 2.4;
constexpr double default_std_m = 100.0;
constexpr double most_fine_cells = 8.0;
constexpr double allowed_error = 0.01;
constexpr double allowed_dimension_error = 0.02;

StatisticsRecipe const nothing_asked;

StatisticsRecipe const& asked(Recipe const& recipe) {
    return recipe.statistics ? *recipe.statistics : nothing_asked;
}

double mean_of(StatisticsRecipe const& s) {
    if (s.mean) {
        return *s.mean;
    }
    return s.max && s.min ? 0.5 * ((*s.max)[0] + (*s.min)[0]) : 0.0;
}

/// How heights go together in a land of these statistics, on cells so many times larger.
solver::StableCovariance covariance_of(StatisticsRecipe const& s, double step) {
    solver::StableCovariance covariance;
    covariance.lx_cells = (s.length ? (*s.length)[0] : default_length_cells) / step;
    covariance.ly_cells = (s.length ? (*s.length)[1] : default_length_cells) / step;
    covariance.dimension = s.dimension.value_or(default_dimension);
    // Slopes are counted between neighbours: they say nothing of coarser cells.
    return s.slope && step == 1.0 ? solver::with_slope(covariance, s.std.value_or(default_std_m), *s.slope)
                                  : covariance;
}

Raster<float> drawn_to_extremes(Raster<float> land, StatisticsRecipe const& s, int levels) {
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

Raster<float> random_land(Recipe const& recipe, Grid const& coarse, int levels, Run const& run) {
    StatisticsRecipe const& s = asked(recipe);
    double const step = static_cast<double>(std::int64_t{1} << levels);
    double const lx = (s.length ? (*s.length)[0] : default_length_cells) / step;
    double const ly = (s.length ? (*s.length)[1] : default_length_cells) / step;
    double const std = s.std.value_or(default_std_m);
    skeleton::FieldParams const field{mean_of(s), std, lx, ly, recipe.seed};
    switch (s.skeleton) {
    case Prior::separable: return drawn_to_extremes(skeleton::separable_ar(coarse, field, run), s, levels);
    case Prior::markov3: return drawn_to_extremes(skeleton::markov3(coarse, field, run), s, levels);
    default: break;
    }
    skeleton::GrfParams params;
    params.mean = mean_of(s);
    params.std = std;
    params.covariance = covariance_of(s, step);
    params.seed = recipe.seed;
    return skeleton::grf(coarse, params, run).dem;
}

/// The points that the land goes through: those of the file, or drawn at random with the extremes among them.
skeleton::Scattered points_of(Recipe const& recipe, Grid const& grid, FeaturePoints const& given, Run const& run) {
    if (!recipe.skeleton || recipe.skeleton->scatter == 0) {
        return {.points = given};
    }
    StatisticsRecipe const& s = asked(recipe);
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

/// What points without [surface] are drawn by.
SurfaceRecipe over_triangles() {
    SurfaceRecipe surface;
    surface.method = Method::tin;
    return surface;
}

/// Land through points, and what it was made with.
struct LandOfPoints {
    Raster<float> land;
    std::optional<Tin> tin = {};
    std::optional<SolverStory> diffusion = {};
};

/// Takes: grid: that of the land, whose cells may be coarser than the recipe's, of cell_m.
LandOfPoints land_of_points(Recipe const& recipe, double cell_m, FeaturePoints const& points, Grid const& grid,
                            Run const& run) {
    SurfaceRecipe const wanted = recipe.surface.value_or(over_triangles());
    StatisticsRecipe const& s = asked(recipe);
    if (wanted.method == Method::regress) {
        skeleton::RegressParams params = wanted.regress;
        double const step = grid.cell_m / cell_m;
        params.length_x = (s.length ? (*s.length)[0] : default_length_cells) / step;
        params.length_y = (s.length ? (*s.length)[1] : default_length_cells) / step;
        params.slope_rad = s.slope.value_or(0.0);
        skeleton::Regression regression = skeleton::regress(points, grid, params, run);
        if (regression.rank < regression.terms) {
            run.say(fmt::format("warning: the points determine {} of {} terms of the regression", regression.rank,
                                regression.terms));
        }
        return {std::move(regression.surface)};
    }
    if (wanted.method == Method::diffuse) {
        Valley const no_rivers{Raster<float>(grid, std::numeric_limits<float>::quiet_NaN())};
        surface::DiffuseParams params = wanted.diffuse;
        params.seed = recipe.seed;
        params.tolerance = wanted.tolerance.value_or(params.tolerance);
        surface::Diffused land =
            surface::diffuse(skeleton::draw_skeleton(no_rivers, {}, points, {}, run).skeleton, params, run);
        return {std::move(land.dem), {}, SolverStory{land.iterations, land.residual}};
    }
    Tin tin = geometry::triangulate(points.points, {}, run).tin;
    bool const natural = wanted.interpolation == Interpolation::natural;
    Raster<float> land = natural
                             ? geometry::natural_neighbours(points.points, grid,
                                                            {geometry::NaturalNeighboursParams::Outside::nearest}, run)
                             : surface::rasterise_tin(tin, grid, {surface::RasteriseTinParams::Outside::nearest}, run);
    return {std::move(land), std::move(tin)};
}

/// Adds the detail that the recipe wants.
Detailed with_detail(Recipe recipe, Raster<float> const& coarse, Grid const& grid, Run const& run) {
    fractal::MidpointParams& wanted = recipe.detail->midpoint;
    fractal::MidpointParams params = wanted;
    params.width = grid.width;
    params.height = grid.height;
    params.seed = recipe.seed;
    fractal::Displaced displaced = fractal::midpoint(coarse, params, run);
    wanted.hurst = displaced.hurst;
    wanted.sigma = displaced.sigma;
    Raster<float> land(grid); // the very frame, not one reckoned back from the coarse cells
    std::copy(displaced.dem.values().begin(), displaced.dem.values().end(), land.values().begin());
    return {std::move(recipe), std::move(land)};
}

fractal::Targets targets_of(StatisticsRecipe const& s) {
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

/// Calls the keys of [statistics] by their names in what a faulty target throws.
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

/// The land moved and stretched to the mean and deviation asked for, so that the projection begins near by.
Raster<float> standardised(Raster<float> land, StatisticsRecipe const& s, Run const& run) {
    measure::Statistics const now = measure::statistics(land, run);
    double const stretch = s.std && now.std > 0.0 ? *s.std / now.std : 1.0;
    double const mean = s.mean.value_or(now.mean);
    for (float& z : land.values()) {
        z = static_cast<float>(mean + (static_cast<double>(z) - now.mean) * stretch);
    }
    return land;
}

/// Heights of given points that the projection must keep: the first of each cell, none where an extreme lies.
std::vector<fractal::FixedHeight> heights_to_keep(Recipe const& recipe, FeaturePoints const& given, Grid const& grid) {
    std::vector<fractal::FixedHeight> kept;
    if (recipe.statistics->skeleton != Prior::points) {
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

/// Projects a land on the statistics. One from which they cannot be reached, smoother or more jagged between neighbours
/// than they ask for, takes its fine forms from a Gaussian land: as few of them as will do.
struct Brought {
    fractal::MatchedDem projection;
    double fine_forms_cells = 0.0; ///< [cells] as DrawnTerrain
};

Brought brought_to_statistics(Recipe const& recipe, Raster<float> land, std::vector<fractal::FixedHeight> const& kept,
                              Run const& run) {
    StatisticsRecipe const& s = *recipe.statistics;
    Grid const grid = land.grid();
    fractal::MatchParams params;
    params.prior = covariance_of(s, 1.0);
    Brought brought{naming_keys([&] { return fractal::match_statistics(land, targets_of(s), kept, params, run); })};
    if (!brought.projection.converged && s.skeleton != Prior::grf) {
        land = standardised(std::move(land), s, run);
        Recipe other = recipe;
        other.statistics->skeleton = Prior::grf;
        Raster<float> const gaussian = standardised(random_land(other, grid, 0, run), s, run);
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

/// Cells that the mask of [surface] leaves out get no height.
Raster<float> left_out(Raster<float> land, Recipe const& recipe) {
    if (!recipe.surface || recipe.surface->mask.empty()) {
        return land;
    }
    Mask const inside = read_mask_of_land(file_in(recipe, recipe.surface->mask), land.grid());
    if (std::all_of(inside.values().begin(), inside.values().end(), [](std::uint8_t v) { return v == 0; })) {
        throw BadInput(fmt::format("surface.mask = \"{}\" leaves out every cell", recipe.surface->mask));
    }
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] = inside[i] != 0 ? land[i] : std::numeric_limits<float>::quiet_NaN();
    }
    return land;
}

/// Says which lengths only a fit can tell: correlation is measured over lags of up to half an axis.
void warn_of_lengths(StatisticsRecipe const& s, Grid const& grid, Run const& run) {
    if (!s.length) {
        return;
    }
    auto const warn = [&](char const* name, double length, char const* axis, std::int64_t cells) {
        if (length > 0.5 * static_cast<double>(cells)) {
            run.say(
                fmt::format("warning: statistics.length: {} of {} cells is more than half of the {} {}: the grid is "
                            "too small to show it, and a fit stands for it",
                            name, length, cells, axis));
        }
    };
    warn("Lx", (*s.length)[0], "columns", grid.width);
    warn("Ly", (*s.length)[1], "rows", grid.height);
}

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

} // namespace

FeaturePoints given_points(Recipe const& recipe, Run const& run) {
    FeaturePoints points;
    std::string const crs = recipe.grid.crs.empty() ? "" : io::projected_crs(recipe.grid.crs);
    if (recipe.skeleton && !recipe.skeleton->points.empty()) {
        std::string const& name = recipe.skeleton->points;
        std::string const path = file_in(recipe, name);
        points = io::read_points({.path = path, .crs = crs}, run);
    }
    if (points.crs.empty()) {
        points.crs = io::projected_crs(crs.empty() ? "EPSG:32631" : crs);
    }
    return points;
}

Check points_missing(std::int64_t missing, std::int64_t wanted, Run const& run) {
    if (missing > 0) {
        run.say(fmt::format("warning: {} of {} points found no room; a smaller skeleton.spacing or skeleton.scatter "
                            "leaves them some",
                            missing, wanted));
    }
    return {"points_missing", static_cast<double>(missing), 0.0, missing == 0};
}

void require_on_grid(FeaturePoints const& points, Grid const& grid, std::string const& name) {
    for (std::size_t i = 0; i < points.points.size(); ++i) {
        Vec3 const& p = points.points[i];
        if (p.x < grid.west || p.x > grid.east() || p.y < grid.south() || p.y > grid.north) {
            throw BadInput(
                fmt::format("skeleton.points = \"{}\": point {} at ({:.3f}, {:.3f}) lies off the grid, which "
                            "reaches from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}); widen the grid or remove it",
                            name, i + 1, p.x, p.y, grid.west, grid.south(), grid.east(), grid.north));
        }
    }
}

Grid frame_land(FeaturePoints const& points, GridRecipe const& wanted) {
    double const cell = wanted.cell_m;
    Grid grid{wanted.width, wanted.height, cell, default_west, default_north, wanted.crs};
    if (!points.points.empty()) {
        double west = std::numeric_limits<double>::infinity();
        double south = west;
        double east = -west;
        double north = -west;
        for (Vec3 const& p : points.points) {
            west = std::min(west, p.x);
            east = std::max(east, p.x);
            south = std::min(south, p.y);
            north = std::max(north, p.y);
        }
        double const margin = wanted.width > 0 ? 0.0 : 0.05 * std::max(east - west, north - south);
        grid.west = std::floor((west - margin) / cell) * cell;
        grid.north = std::ceil((north + margin) / cell) * cell;
        if (wanted.width == 0) {
            double const columns = std::ceil((east + margin - grid.west) / cell);
            double const rows = std::ceil((grid.north - south + margin) / cell);
            if (!(columns < 1e6) || !(rows < 1e6)) {
                throw BadInput(fmt::format("grid: the points span {:.0f} x {:.0f} m, {:.3g} x {:.3g} cells of {} m: "
                                           "give a larger grid.cell or a grid",
                                           east - west, north - south, columns, rows, cell));
            }
            grid.width = std::max<std::int64_t>(1, static_cast<std::int64_t>(columns));
            grid.height = std::max<std::int64_t>(1, static_cast<std::int64_t>(rows));
        }
    }
    if (wanted.origin) {
        grid.west = (*wanted.origin)[0];
        grid.north = (*wanted.origin)[1];
    }
    check_memory(grid.width, grid.height);
    return grid;
}

DrawnTerrain make_land(Recipe const& recipe, Grid const& grid, FeaturePoints const& given, Diary& diary,
                       Run const& run) {
    DrawnTerrain drawn;
    drawn.recipe = recipe;
    drawn.grid = grid;
    int const levels = levels_of(recipe);
    Grid const coarse = coarse_grid(grid, levels);
    if (recipe.statistics) { // before any work
        naming_keys([&] { fractal::check_targets(Raster<float>(grid), targets_of(*recipe.statistics)); });
        warn_of_lengths(*recipe.statistics, grid, run);
    }
    bool const from_points = !recipe.statistics || recipe.statistics->skeleton == Prior::points;
    skeleton::Scattered const points = from_points ? points_of(recipe, grid, given, run) : skeleton::Scattered{};
    if (from_points && recipe.skeleton && recipe.skeleton->scatter > 0) {
        drawn.checks.push_back(points_missing(points.missing, recipe.skeleton->scatter, run));
    }
    LandOfPoints made = diary.stage("land", [&] {
        return from_points ? land_of_points(recipe, grid.cell_m, points.points, coarse, run)
                           : LandOfPoints{random_land(recipe, coarse, levels, run)};
    });
    drawn.tin = std::move(made.tin);
    drawn.diffusion = made.diffusion;
    Raster<float> land = std::move(made.land);
    diary.say(from_points ? fmt::format("{} points", points.points.points.size())
                          : fmt::format("random, {}x{} cells of {} m", coarse.width, coarse.height, coarse.cell_m));
    if (levels > 0) {
        Detailed detailed = diary.stage("detail", [&] { return with_detail(recipe, land, grid, run); });
        drawn.recipe = std::move(detailed.recipe);
        land = std::move(detailed.land);
        diary.say(fmt::format("midpoint displacement, {} levels", levels));
    }
    if (recipe.statistics) {
        Brought brought = diary.stage("project", [&] {
            return brought_to_statistics(drawn.recipe, std::move(land), heights_to_keep(recipe, given, grid), run);
        });
        diary.say(fmt::format("{} statistics within {:.2g} %, {} steps{}", brought.projection.residuals.size(),
                              100.0 * brought.projection.largest_error, brought.projection.iterations,
                              brought.fine_forms_cells > 0.0 ? ", fine forms of a Gaussian surface" : ""));
        std::vector<Check> const checks = residual_checks(brought.projection);
        drawn.checks.insert(drawn.checks.end(), checks.begin(), checks.end());
        land = std::move(brought.projection.dem);
        brought.projection.dem = Raster<float>();
        drawn.projection = std::move(brought.projection);
        drawn.fine_forms_cells = brought.fine_forms_cells;
    } else {
        land = left_out(std::move(land), recipe);
    }
    drawn.surface.emplace();
    drawn.surface->dem = std::move(land);
    return drawn;
}

Detailed detail_alone(Recipe recipe, Grid const& grid, Run const& run) {
    recipe.detail->midpoint.hurst = recipe.detail->midpoint.hurst.value_or(3.0 - default_dimension);
    Raster<float> const flat(coarse_grid(grid, levels_of(recipe)), 0.0F);
    return with_detail(std::move(recipe), flat, grid, run);
}

} // namespace thalweg::pipeline
