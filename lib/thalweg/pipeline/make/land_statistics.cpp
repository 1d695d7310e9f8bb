// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/pipeline/make/internal/land_parts.hpp>

#include <thalweg/core/run/error.hpp>
#include <thalweg/fractal/match_statistics.hpp>
#include <thalweg/measure/relief/statistics.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace thalweg::pipeline {

namespace {

constexpr double most_fine_cells = 8.0;
constexpr double allowed_error = 0.01;
constexpr double allowed_dimension_error = 0.02;

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

} // namespace

void require_targets(StatisticsRecipe const& wanted, Grid const& grid, Run const& run) {
    naming_keys([&] { fractal::check_targets(Raster<float>(grid), targets_of(wanted)); });
    warn_of_lengths(wanted, grid, run);
}

Brought brought_to_statistics(Recipe const& recipe, Raster<float> land, FeaturePoints const& given, Run const& run) {
    StatisticsRecipe const& s = *recipe.statistics;
    Grid const grid = land.grid();
    std::vector<fractal::FixedHeight> const kept = heights_to_keep(recipe, given, grid);
    fractal::MatchParams params;
    params.prior = covariance_of(s, 1.0);
    Brought brought{naming_keys([&] { return fractal::match_statistics(land, targets_of(s), kept, params, run); })};
    if (!brought.projection.converged && s.skeleton != Prior::grf) {
        land = standardised(std::move(land), s, run);
        Raster<float> const gaussian = standardised(random_land(recipe, Prior::grf, grid, 0, run), s, run);
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

} // namespace thalweg::pipeline
