// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/append.hpp>
#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/stage_log.hpp>
#include <thalweg/fractal/midpoint.hpp>
#include <thalweg/make/internal/ground.hpp>
#include <thalweg/make/internal/numbers.hpp>
#include <thalweg/make/valley_cells.hpp>
#include <thalweg/measure/relief/statistics.hpp>
#include <thalweg/recipe/check_recipe.hpp>
#include <thalweg/recipe/read_inputs.hpp>
#include <thalweg/recipe/recipe_files.hpp>
#include <thalweg/recipe/stages.hpp>
#include <thalweg/surface/dilation/dilation.hpp>

namespace thalweg::make {
namespace {

constexpr double most_fine_cells = 8.0;
constexpr double allowed_error = 0.01;
constexpr double allowed_dimension_error = 0.02;

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
        throw BadParameter(fault.where(), fmt::format("{}: {}", names.empty() ? "[statistics]" : names, words));
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
std::vector<Finding> lengths_warned(recipe::StatisticsRecipe const& s, Grid const& grid) {
    std::vector<Finding> findings;
    if (!s.length) {
        return findings;
    }
    auto const warn = [&](char const* name, double length, char const* axis, std::int64_t cells) {
        if (length > 0.5 * static_cast<double>(cells)) {
            findings.push_back(
                {.kind = "small_grid",
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
    return findings;
}

/// Matches a terrain to the statistics. One from which they cannot be reached, smoother or rougher between neighbours
/// than the target, takes its fine forms from a Gaussian terrain: as few as possible. given: points whose heights stay.
MatchedStatistics matched_to_statistics(recipe::Recipe const& recipe, Raster<float> land, FeaturePoints const& given,
                                        Run const& run) {
    recipe::StatisticsRecipe const& s = *recipe.statistics;
    Grid const grid = land.grid();
    std::vector<fractal::FixedHeight> const kept = heights_to_keep(recipe, given, grid);
    fractal::MatchParams params;
    params.prior = covariance_of(s, 1.0);
    MatchedStatistics brought{
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

/// Checks whether the statistics match their targets.
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

/// A DEM with fractal detail, and how that was made.
struct DetailedDem {
    DetailStatistics statistics;
    Raster<float> dem;
};

DetailedDem displaced(fractal::MidpointParams params, std::uint64_t seed, Raster<float> const& coarse, Grid const& grid,
                      Run const& run) {
    params.width = grid.width;
    params.height = grid.height;
    params.seed = seed;
    fractal::DisplacedDem const made = fractal::midpoint(coarse, params, run);
    Raster<float> land(grid); // the exact frame, not one computed back from the coarse cells
    std::copy(made.dem.values().begin(), made.dem.values().end(), land.values().begin());
    return {{made.hurst, made.sigma}, std::move(land)};
}

/// The detail of a recipe on a plain.
DetailedDem detail_alone(recipe::Recipe const& recipe, Grid const& grid, Run const& run) {
    fractal::MidpointParams wanted = recipe.detail->midpoint;
    wanted.hurst = wanted.hurst.value_or(3.0 - default_dimension);
    Raster<float> const flat(recipe::coarse_grid(grid, recipe::levels_of(recipe)), 0.0F);
    return displaced(wanted, recipe.seed, flat, grid, run);
}

/// Adds fractal detail: none in the valleys, all of it some cells away.
DetailedDem beside_rivers(recipe::Recipe const& recipe, Raster<float> dem, ValleyCells const& valley, Run const& run) {
    constexpr double near_cells = 8.0; // within which detail grows from nothing to two thirds
    DetailedDem const detail = detail_alone(recipe, dem.grid(), run);
    Raster<float> result = std::move(dem);
    surface::Expansion const expansion = surface::expand({valley.raster()}, run);
    for (std::int64_t i = 0; i < result.cells(); ++i) {
        double const share = 1.0 - portable::exp(-static_cast<double>(expansion.level[i]) / near_cells);
        result[i] = static_cast<float>(static_cast<double>(result[i]) + share * static_cast<double>(detail.dem[i]));
    }
    return {detail.statistics, std::move(result)};
}

/// Removes the heights of cells without data in a raster, and of those outside the mask of [surface].
Raster<float> left_out(Raster<float> land, recipe::Recipe const& recipe, Raster<float> const& raster, Run const& run) {
    for (std::int64_t i = 0; i < raster.cells(); ++i) {
        land[i] = std::isnan(raster[i]) ? raster[i] : land[i];
    }
    if (!recipe.surface || recipe.surface->mask.empty()) {
        return land;
    }
    Mask const inside = recipe::read_mask_of_land(recipe::file_in(recipe, recipe.surface->mask), land.grid(), run);
    if (std::all_of(inside.values().begin(), inside.values().end(), [](std::uint8_t v) { return v == 0; })) {
        throw BadInput("make.make_terrain",
                       fmt::format("surface.mask = \"{}\" leaves out every cell", recipe.surface->mask));
    }
    for (std::int64_t i = 0; i < land.cells(); ++i) {
        land[i] = inside[i] != 0 ? land[i] : std::numeric_limits<float>::quiet_NaN();
    }
    return land;
}

/// Matches a surface to the statistics that the recipe asks for.
Surface matched(Surface surface, GroundInput const& in, StageLog& stage_log, Run const& run) {
    MatchedStatistics brought = stage_log.stage(recipe::stage::project.name, [&] {
        return matched_to_statistics(in.recipe, std::move(surface.ground.dem), in.points, run);
    });
    stage_log.say(fmt::format("{} statistics within {:.2g} %, {} steps{}", brought.projection.residuals.size(),
                              100.0 * brought.projection.largest_error, brought.projection.iterations,
                              brought.fine_forms_cells > 0.0 ? ", fine forms of a Gaussian surface" : ""));
    append(surface.notes.checks, residual_checks(brought.projection));
    surface.ground.dem = std::exchange(brought.projection.dem, {});
    surface.ground.matched = std::move(brought);
    return surface;
}

} // namespace

std::vector<Finding> require_targets(recipe::Recipe const& recipe, Grid const& grid) {
    if (!recipe.statistics) {
        return {};
    }
    naming_keys([&] { fractal::check_targets(Raster<float>(grid), targets_of(*recipe.statistics)); });
    return lengths_warned(*recipe.statistics, grid);
}

Surface refined(Surface surface, GroundInput const& in, Run const& run) {
    StageLog stage_log(run);
    int const levels = recipe::levels_of(in.recipe);
    Raster<float>& dem = surface.ground.dem;
    if (levels > 0 && in.recipe.network) {
        DetailedDem made = beside_rivers(in.recipe, std::move(dem), surface.bed.valley, run);
        dem = std::move(made.dem);
        surface.ground.detail = made.statistics;
    } else if (levels > 0) {
        DetailedDem made = stage_log.stage(recipe::stage::detail.name, [&] {
            return displaced(in.recipe.detail->midpoint, in.recipe.seed, dem, in.fine, run);
        });
        dem = std::move(made.dem);
        surface.ground.detail = made.statistics;
        stage_log.say(fmt::format("midpoint displacement, {} levels", levels));
    }
    if (!in.recipe.network) {
        if (in.recipe.statistics) {
            surface = matched(std::move(surface), in, stage_log, run);
        } else {
            dem = left_out(std::move(dem), in.recipe, in.raster, run);
        }
    }
    append(surface.notes.timings_s, stage_log.take());
    return surface;
}

} // namespace thalweg::make
