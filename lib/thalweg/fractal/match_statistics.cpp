// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/fractal/match_statistics.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/fractal/check_targets.hpp>
#include <thalweg/fractal/internal/goals.hpp>
#include <thalweg/fractal/internal/limiter.hpp>
#include <thalweg/fractal/internal/prior.hpp>
#include <thalweg/solver/linear/cholesky.hpp>
#include <thalweg/solver/spectral/circulant.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

namespace thalweg::fractal {

namespace {

using solver::FieldStatistics;

constexpr std::int64_t grain_cells = 32768;
// A step that leaves more missing than that many times the least so far is taken back, and the next is half as long.
constexpr double worse = 1.5;
constexpr double least_reach = 1.0 / 64.0; ///< below it the search ends: no step in this direction helps
constexpr double least_fine_share = 0.3;
constexpr double longest_fine_cells = 12.0;

/// What heights may not do: pass the extremes, and move in fixed cells.
struct Bounds {
    Limiter const& limiter;
    std::vector<FixedHeight> const& kept;
};

/// A land, as the heights that are changed freely and as those they are bent to.
struct Land {
    Raster<double> free;
    Raster<float> dem;
};

/// The covariance that steps are taken in: the prior's with a good part of fine forms. In a smooth prior alone slope
/// and dimension answer to little but changes of the whole land, which throw the lengths over.
solver::StableCovariance of_steps(solver::StableCovariance covariance) {
    if (covariance.fine_share == 0.0) {
        covariance.fine_cells =
            std::min(longest_fine_cells, std::sqrt(covariance.lx_cells * covariance.ly_cells) / 4.0);
    }
    covariance.fine_share = std::max(covariance.fine_share, least_fine_share);
    return covariance;
}

void add_to(Raster<double>& field, double times, Raster<double> const& other, Run const& run) {
    parallel_ranges(run, field.cells(), grain_cells, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            field[i] += times * other[i];
        }
    });
}

double product(Raster<double> const& a, Raster<double> const& b, Run const& run) {
    return sum_rows(run, a.height(), [&](std::int64_t r) {
        auto const row = a.row(r);
        auto const other = b.row(r);
        double sum = 0.0;
        for (std::size_t c = 0; c < row.size(); ++c) {
            sum += row[c] * other[c];
        }
        return sum;
    });
}

/// Bends the free heights and puts in the fixed ones.
void shape(Land& land, Bounds const& bounds, Run const& run) {
    parallel_ranges(run, land.dem.cells(), grain_cells, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (!std::isnan(land.dem[i])) {
                land.dem[i] = static_cast<float>(bounds.limiter.height(land.free[i]));
            }
        }
    });
    for (FixedHeight const& one : bounds.kept) {
        land.dem[one.cell] = static_cast<float>(one.z);
    }
}

/// How the goals' statistics answer to the free heights; the fixed ones do not move.
std::vector<Raster<double>> derivatives(Land const& land, FieldStatistics const& is, std::vector<Goal> const& goals,
                                        Bounds const& bounds, Run const& run) {
    std::vector<Raster<double>> fields;
    for (Goal const& goal : goals) {
        fields.push_back(solver::derivative(land.dem, is, goal.quantity, run));
        Raster<double>& field = fields.back();
        parallel_ranges(run, field.cells(), grain_cells, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
                if (bounds.limiter.bends(land.free[i])) {
                    field[i] *= bounds.limiter.slope(land.free[i]);
                }
            }
        });
        for (FixedHeight const& one : bounds.kept) {
            field[one.cell] = 0.0;
        }
    }
    return fields;
}

/// How statistics answer to the fields that move them: by goal the field C' g, C' the prior's covariance conditioned on
/// the fixed heights and g the statistic's derivatives, as C g less what the fixed heights draw back; and g' C' g.
struct Answers {
    std::vector<Raster<double>> fields;       ///< C g
    std::vector<std::vector<double>> weights; ///< of the fixed heights, by goal
    std::vector<double> products;             ///< g' C' g, lower triangle
};

/// Multiplies the fields by the covariance, two at a time, and gives g' C g.
std::vector<double> multiply_fields(std::vector<Raster<double>>& fields, Prior const& prior, Run const& run) {
    std::size_t const n = fields.size();
    std::vector<double> products(n * n);
    for (std::size_t i = 0; i < n; i += 2) {
        bool const two = i + 1 < n;
        Raster<double> first = fields[i];
        Raster<double> second = two ? fields[i + 1] : Raster<double>(first.grid());
        solver::multiply(prior.torus(), first, second, run);
        for (std::size_t j = i; j < n; ++j) {
            products[j * n + i] = product(fields[j], first, run);
            if (two && j > i) {
                products[j * n + i + 1] = product(fields[j], second, run);
            }
        }
        // From here on only the products are needed.
        fields[i] = std::move(first);
        if (two) {
            fields[i + 1] = std::move(second);
        }
    }
    return products;
}

Answers answers_of(std::vector<Raster<double>> derivatives, Prior const& prior, Run const& run) {
    Answers answers;
    answers.products = multiply_fields(derivatives, prior, run);
    answers.fields = std::move(derivatives);
    std::size_t const n = answers.fields.size();
    std::vector<std::vector<double>> at_kept(n);
    for (std::size_t i = 0; i < n; ++i) {
        at_kept[i] = prior.at_kept(answers.fields[i]);
        answers.weights.push_back(prior.solve_kept(at_kept[i]));
        for (std::size_t j = 0; j <= i; ++j) {
            for (std::size_t p = 0; p < at_kept[j].size(); ++p) {
                answers.products[i * n + j] -= answers.weights[i][p] * at_kept[j][p];
            }
        }
    }
    return answers;
}

/// How far to go along each field: c such that g' C' g c = missing, at most reach times the longest steps.
/// Metres, cells and radians: every statistic is scaled by its own deviation. One that answers to no height, or whose
/// answer is not known, as on a plain, is left out: 0.
std::vector<double> amounts(std::vector<double> const& products, std::vector<Goal> const& goals,
                            FieldStatistics const& is, double reach, Run const& run) {
    std::size_t const n = goals.size();
    std::vector<double> scale(n, 0.0);
    std::vector<double> wanted(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        if (products[i * n + i] > 0.0) {
            scale[i] = 1.0 / std::sqrt(products[i * n + i]);
            wanted[i] = scale[i] * std::clamp(missing(goals[i], is), -reach * goals[i].longest_step,
                                              reach * goals[i].longest_step);
        }
    }
    std::vector<double> system(n * n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            bool const both = scale[i] > 0.0 && scale[j] > 0.0;
            system[i * n + j] = both ? products[i * n + j] * scale[i] * scale[j] : i == j ? 1.0 : 0.0;
        }
    }
    std::vector<double> c = solver::solve(factor_safely(system, n, run), std::move(wanted));
    for (std::size_t i = 0; i < n; ++i) {
        c[i] *= scale[i];
    }
    return c;
}

/// The step of least energy that makes up for what is missing, to first order: free heights move by C' g c.
void step(Land& land, FieldStatistics const& is, std::vector<Goal> const& goals, double reach, Bounds const& bounds,
          Prior const& prior, Run const& run) {
    Answers answers = answers_of(derivatives(land, is, goals, bounds, run), prior, run);
    std::vector<double> const c = amounts(answers.products, goals, is, reach, run);
    std::vector<double> pull(bounds.kept.size(), 0.0);
    for (std::size_t i = 0; i < c.size(); ++i) {
        if (c[i] == 0.0) {
            continue;
        }
        add_to(land.free, c[i], answers.fields[i], run);
        for (std::size_t p = 0; p < pull.size(); ++p) {
            pull[p] -= c[i] * answers.weights[i][p];
        }
    }
    answers.fields.clear();
    add_to(land.free, 1.0, prior.spread(pull, run), run);
}

void check(Raster<float> const& dem, MatchParams const& params) {
    solver::check(params.prior, "fractal.match_statistics");
    require_in("fractal.match_statistics", "iterations", params.iterations, Range::between(0, 1000));
    require_in("fractal.match_statistics", "tolerance", params.tolerance, Range::between(0.0, 1.0));
    require_in("fractal.match_statistics", "gap", params.gap_m, Range::above(0.0).or_infinite(), "m");
    auto const values = dem.values();
    if (std::any_of(values.begin(), values.end(), [](float z) { return std::isinf(z); })) {
        throw BadInput("fractal.match_statistics: a height is infinite; mark cells without data as NaN");
    }
    if (std::all_of(values.begin(), values.end(), [](float z) { return std::isnan(z); })) {
        throw BadInput(fmt::format("fractal.match_statistics: none of the {} cells has a height", dem.cells()));
    }
}

/// The extreme itself, or what lies beyond it.
Residual residual_of_extreme(char const* name, FixedHeight const& asked, Raster<float> const& dem, double sign,
                             double deviation) {
    auto const wanted = static_cast<double>(static_cast<float>(asked.z));
    double furthest = -std::numeric_limits<double>::infinity();
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        if (i != dem.grid().index(asked.cell) && !std::isnan(dem[i])) {
            furthest = std::max(furthest, sign * dem[i]);
        }
    }
    double const beyond = furthest - sign * wanted;
    if (beyond < 0.0) {
        return {name, asked.z, asked.z, 0.0};
    }
    // A second cell as high is an error too, however small.
    return {name, asked.z, sign * furthest, std::max(beyond / deviation, std::numeric_limits<double>::min())};
}

/// The land that runs through the fixed heights and is nearest to the one handed in, by the prior.
Land through_fixed(Raster<float> const& dem, Bounds const& bounds, solver::StableCovariance const& covariance,
                   Run const& run) {
    Land land{Raster<double>(dem.grid()), dem};
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        land.free[i] = std::isnan(dem[i]) ? 0.0 : dem[i];
    }
    if (!bounds.kept.empty()) {
        Prior const prior(dem.grid(), bounds.kept, covariance, run);
        std::vector<double> off;
        for (FixedHeight const& one : bounds.kept) {
            off.push_back(one.z - land.free[one.cell]);
        }
        add_to(land.free, 1.0, prior.spread(prior.solve_kept(std::move(off)), run), run);
    }
    shape(land, bounds, run);
    return land;
}

/// The land nearest to the goals so far.
struct Nearest {
    MatchedDem found;
    FieldStatistics is;
    Raster<double> free;
    double way = std::numeric_limits<double>::infinity();
};

void keep(Nearest& nearest, Land const& land, FieldStatistics const& is, double way, double error,
          Limiter const& limiter) {
    nearest.way = way;
    nearest.is = is;
    nearest.free = land.free;
    nearest.found.dem = land.dem;
    nearest.found.largest_error = error;
    nearest.found.limited_cells =
        std::count_if(land.free.values().begin(), land.free.values().end(), [&](double w) { return limiter.bends(w); });
}

/// Steps until the error is within the tolerance, no step helps or there have been enough.
Nearest approach(Land land, FieldStatistics is, std::vector<Goal> const& goals, double deviation, Bounds const& bounds,
                 Prior const& prior, MatchParams const& params, Run const& run) {
    Nearest nearest;
    double reach = 1.0;
    for (int iteration = 0;; ++iteration) {
        double const way = longest_way(goals, is);
        double const error = largest_error(goals, is, deviation);
        if (iteration == 0 || error <= params.tolerance || way < nearest.way) {
            keep(nearest, land, is, way, error, bounds.limiter);
        }
        nearest.found.iterations = iteration;
        if (nearest.found.largest_error <= params.tolerance || iteration == params.iterations) {
            return nearest;
        }
        run.at(static_cast<double>(iteration) / params.iterations, "project");
        if (way > worse * nearest.way) {
            land.free = nearest.free;
            shape(land, bounds, run);
            is = nearest.is;
            reach *= 0.5;
        } else if (way == nearest.way) {
            reach = std::min(1.0, 2.0 * reach);
        }
        // What the heights do not tell cannot be derived; the others may bring it back.
        std::vector<Goal> known;
        std::copy_if(goals.begin(), goals.end(), std::back_inserter(known),
                     [&](Goal const& goal) { return std::isfinite(missing(goal, is)); });
        if (reach < least_reach || known.empty()) {
            return nearest;
        }
        step(land, is, known, reach, bounds, prior, run);
        shape(land, bounds, run);
        is = solver::field_statistics(land.dem, run);
    }
}

bool is_extreme(Residual const& one) {
    return one.name == "max" || one.name == "min";
}

/// Adds the residuals of the extremes, and says whether all are met.
void add_extremes(MatchedDem& projection, Targets const& targets, double deviation, double tolerance) {
    for (auto const& [name, extreme, sign] :
         {std::tuple{"max", targets.max, 1.0}, std::tuple{"min", targets.min, -1.0}}) {
        if (extreme) {
            projection.residuals.push_back(residual_of_extreme(name, *extreme, projection.dem, sign, deviation));
        }
    }
    projection.converged = projection.largest_error <= tolerance;
    for (Residual const& one : projection.residuals) {
        projection.converged = projection.converged && (!is_extreme(one) || one.error == 0.0);
        projection.largest_error = std::max(projection.largest_error, one.error);
    }
}

} // namespace

MatchedDem match_statistics(Raster<float> const& dem, Targets const& targets, std::vector<FixedHeight> const& fixed,
                            MatchParams const& params, Run const& run) {
    check(dem, params);
    check_targets(dem, targets);
    std::vector<FixedHeight> const kept = kept_heights(dem, targets, fixed);
    Limiter const limiter(targets, params.gap_m);
    Bounds const bounds{limiter, kept};

    Land land = through_fixed(dem, bounds, params.prior, run);
    FieldStatistics const is = solver::field_statistics(land.dem, run);
    double const deviation = targets.std.value_or(is.std > 0.0 ? is.std : 1.0);
    std::vector<Goal> const goals = goals_of(targets, deviation);
    Prior const prior(dem.grid(), kept, of_steps(params.prior), run);
    Nearest nearest = approach(std::move(land), is, goals, deviation, bounds, prior, params, run);
    nearest.found.residuals = residuals_of(goals, nearest.is, deviation);
    add_extremes(nearest.found, targets, deviation, params.tolerance);
    return std::move(nearest.found);
}

} // namespace thalweg::fractal
