// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <thalweg/core/numbers/sums.hpp>
#include <thalweg/core/run/parameters.hpp>
#include <thalweg/core/run/refuse.hpp>
#include <thalweg/core/same_grid.hpp>
#include <thalweg/fractal/internal/limiter.hpp>
#include <thalweg/solver/linear/linear.hpp>
#include <thalweg/solver/spectral/fft.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

namespace thalweg::fractal {
namespace {

void check_range(char const* what, std::optional<double> const& value, double above, double below,
                 char const* unit = "") {
    if (value) {
        require_in("fractal.match_statistics", what, *value, Range::inside(above, below), unit);
    }
}

void check_extreme(Raster<float> const& dem, char const* what, std::optional<FixedHeight> const& extreme) {
    if (!extreme) {
        return;
    }
    Cell const cell = extreme->cell;
    refuse_if<BadParameter>(
        !dem.grid().contains(cell), "fractal.match_statistics",
        "the {} at column {}, row {} lies off the grid of {} x {} cells; columns and rows count from 0", what, cell.col,
        cell.row, dem.width(), dem.height());
    refuse_if<BadParameter>(std::isnan(dem[cell]), "fractal.match_statistics",
                            "the {} at column {}, row {} lies in a hole; give a cell with data", what, cell.col,
                            cell.row);
    check_range(what, extreme->z, -1e9, 1e9, "m");
}

using solver::Quantity;

// One statistic and its target.
struct Goal {
    char const* name;
    solver::Quantity quantity;
    double asked;
    double longest_step; // in the units of its derivative
};

using solver::FieldStatistics;

double figure(FieldStatistics const& is, Quantity quantity) {
    switch (quantity) {
    case Quantity::mean: return is.mean;
    case Quantity::std: return is.std;
    case Quantity::ln_lx: return is.lx.cells;
    case Quantity::ln_ly: return is.ly.cells;
    case Quantity::slope_rad: return is.slope_rad;
    case Quantity::dimension: break;
    }
    return is.dimension;
}

bool by_logarithm(Quantity quantity) {
    return quantity == Quantity::ln_lx || quantity == Quantity::ln_ly;
}

/// The error as reported to the caller.
double error_of(Goal const& goal, FieldStatistics const& is, double deviation) {
    double const off = std::fabs(figure(is, goal.quantity) - goal.asked);
    double const error = off / (goal.quantity == Quantity::mean ? deviation : goal.asked);
    return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

// The statistics that have a target. deviation: [m] of the heights, the unit of steps of mean and deviation.
/// The longest steps are those that meet table 4 of Zhang, Liu and Li, whose deviation is 131.6 m: 100 m, 30 m, 0.3,
/// 0.3, 0.05, 0.1 there.
std::vector<Goal> goals_of(Targets const& targets, double deviation) {
    std::vector<Goal> goals;
    auto const add = [&](char const* name, Quantity quantity, std::optional<double> const& asked, double longest_step) {
        if (asked) {
            goals.push_back({name, quantity, *asked, longest_step});
        }
    };
    add("mean", Quantity::mean, targets.mean, 0.76 * deviation);
    add("std", Quantity::std, targets.std, 0.23 * deviation);
    add("lx_cells", Quantity::ln_lx, targets.lx_cells, 0.3);
    add("ly_cells", Quantity::ln_ly, targets.ly_cells, 0.3);
    add("slope_rad", Quantity::slope_rad, targets.slope_rad, 0.05);
    add("dimension", Quantity::dimension, targets.dimension, 0.1);
    return goals;
}

// The remaining difference in the units of the statistic's derivative; not finite: the statistic is undefined.
double missing(Goal const& goal, FieldStatistics const& is) {
    double const got = figure(is, goal.quantity);
    return by_logarithm(goal.quantity) ? portable::log(goal.asked / got) : goal.asked - got;
}

// The largest error of all goals, from their residuals; infinite: a statistic is undefined.
double largest_error(std::vector<Goal> const& goals, FieldStatistics const& is, double deviation) {
    double largest = 0.0;
    for (Goal const& goal : goals) {
        largest = std::max(largest, error_of(goal, is, deviation));
    }
    return largest;
}

// The largest remaining difference in longest steps; infinite: a statistic is undefined.
double most_remaining_steps(std::vector<Goal> const& goals, FieldStatistics const& is) {
    double longest = 0.0;
    for (Goal const& goal : goals) {
        double const steps = std::fabs(missing(goal, is)) / goal.longest_step;
        longest = std::isfinite(steps) ? std::max(longest, steps) : std::numeric_limits<double>::infinity();
    }
    return longest;
}

// For every goal the target, the value reached and the error.
std::vector<Residual> residuals_of(std::vector<Goal> const& goals, FieldStatistics const& is, double deviation) {
    std::vector<Residual> residuals;
    for (Goal const& goal : goals) {
        residuals.push_back({goal.name, goal.asked, figure(is, goal.quantity), error_of(goal, is, deviation)});
    }
    return residuals;
}

// Smallest relative ridge of a matrix: below it two statistics, or two fixed heights, are indistinguishable.
constexpr double least_ridge = 1e-10;
constexpr double most_ridge = 1e-2;

// Factors a symmetric matrix with the least ridge that makes it positive definite.
solver::Cholesky factor_safely(std::vector<double> const& matrix, std::size_t size, Run const& run) {
    for (double ridge = least_ridge; ridge < most_ridge; ridge *= 100.0) {
        try {
            return solver::factor(matrix, size, ridge, run);
        } catch (NotConverged const&) {
        }
    }
    return solver::factor(matrix, size, most_ridge, run);
}

// The prior's covariance, and the covariance conditional on the fixed heights.
class Prior {
public:
    Prior(Grid const& grid, std::vector<FixedHeight> const& kept, solver::StableCovariance const& covariance,
          Run const& run)
        : grid_(grid), kept_(kept), torus_(solver::circulant(covariance, around(grid.width, covariance.lx_cells),
                                                             around(grid.height, covariance.ly_cells), run)),
          kept_covariance_(factor_kept(run)) {}

    solver::Circulant const& torus() const { return torus_; }
    std::vector<double> at_kept(Raster<double> const& field) const {
        std::vector<double> values;
        for (FixedHeight const& one : kept_) {
            values.push_back(field[one.cell]);
        }
        return values;
    }

    std::vector<double> solve_kept(std::vector<double> values) const {
        return solver::solve(kept_covariance_, std::move(values));
    }

    // The covariance of every cell with weighted fixed cells (kriging).
    Raster<double> spread(std::vector<double> const& weights, Run const& run) const {
        Raster<double> field(grid_);
        for (std::size_t p = 0; p < kept_.size(); ++p) {
            field[kept_[p].cell] = weights[p];
        }
        if (!kept_.empty()) {
            Raster<double> none(grid_);
            solver::multiply(torus_, field, none, run);
        }
        return field;
    }

private:
    /// Heights three correlation lengths apart are nearly uncorrelated, so that the torus need be only that much wider
    /// than the grid.
    static std::int64_t around(std::int64_t cells, double length_cells) {
        auto const margin =
            static_cast<std::int64_t>(std::ceil(std::min(3.0 * length_cells, static_cast<double>(cells))));
        return solver::good_size(cells + margin);
    }

    solver::Cholesky factor_kept(Run const& run) const {
        std::size_t const n = kept_.size();
        std::vector<double> matrix(n * n);
        if (n > 0) {
            solver::Quarter const table = solver::covariances(torus_, run);
            auto const apart = [](std::int64_t a, std::int64_t b, std::int64_t length) {
                return std::min(std::abs(a - b), length - std::abs(a - b));
            };
            for (std::size_t p = 0; p < n; ++p) {
                for (std::size_t q = 0; q <= p; ++q) {
                    Cell const a = kept_[p].cell;
                    Cell const b = kept_[q].cell;
                    matrix[p * n + q] = table[apart(a.row, b.row, torus_.height) * (torus_.width / 2 + 1) +
                                              apart(a.col, b.col, torus_.width)];
                }
            }
        }
        return factor_safely(matrix, n, run);
    }

    Grid grid_;
    std::vector<FixedHeight> const& kept_;
    solver::Circulant torus_;
    solver::Cholesky kept_covariance_;
};

constexpr std::int64_t grain_cells = 32768;
// A step after which the remaining difference exceeds this factor times the least so far is undone, and the next is
// half as long.
constexpr double worse = 1.5;
constexpr double least_reach = 1.0 / 64.0; ///< the search ends below: no step in this direction helps
constexpr double least_fine_share = 0.3;
constexpr double longest_fine_cells = 12.0;

/// Constraints on heights: stay between the extremes, and unchanged in fixed cells.
struct Bounds {
    Limiter const& limiter;
    std::vector<FixedHeight> const& kept;
};

/// A DEM as unconstrained heights and as the limited heights derived from them.
struct Land {
    Raster<double> free;
    Raster<float> dem;
};

/// The covariance of the steps: the prior's with a large share of fine forms. With a smooth prior alone, slope and
/// dimension respond mainly to changes of the whole terrain, which disturb the correlation lengths.
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

/// Limits the free heights and inserts the fixed ones.
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

/// Derivatives of the goals' statistics by the free heights; fixed heights do not change.
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

/// Responses of statistics to the fields that change them: by goal the field C' g, where C' is the prior's covariance
/// conditioned on the fixed heights and g the statistic's derivative, stored as C g minus the part due to the fixed
/// heights; and g' C' g.
struct Answers {
    std::vector<Raster<double>> fields;       ///< C g
    std::vector<std::vector<double>> weights; ///< of the fixed heights, by goal
    std::vector<double> products;             ///< g' C' g, lower triangle
};

/// Multiplies the fields by the covariance, two at a time.
/// \return g' C g
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
        // Only the products are needed from here on.
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

/// Solves for the coefficients c of the fields: g' C' g c = missing, at most reach times the longest steps. Because
/// units differ (metres, cells, radians), every statistic is scaled by its own deviation. A statistic that responds to
/// no height, or whose response is undefined, as on a plain, is left out: 0.
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

/// Takes the step of least energy that removes the remaining differences to first order: free heights change by C' g c.
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
        throw BadInput("fractal.match_statistics", "a height is infinite; mark cells without data as NaN");
    }
    if (std::all_of(values.begin(), values.end(), [](float z) { return std::isnan(z); })) {
        throw BadInput("fractal.match_statistics", fmt::format("none of the {} cells has a height", dem.cells()));
    }
}

/// The extreme itself, or a cell beyond it.
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
    // A second cell of equal height is an error too, however small.
    return {name, asked.z, sign * furthest, std::max(beyond / deviation, std::numeric_limits<double>::min())};
}

/// Conditions a DEM on the fixed heights with the least change, by the prior.
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

/// The DEM closest to the goals so far.
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

/// Takes steps until the error is within the tolerance, no step helps, or the number of iterations is reached.
Nearest approach(Land land, FieldStatistics is, std::vector<Goal> const& goals, double deviation, Bounds const& bounds,
                 Prior const& prior, MatchParams const& params, Run const& run) {
    Nearest nearest;
    double reach = 1.0;
    for (int iteration = 0;; ++iteration) {
        double const way = most_remaining_steps(goals, is);
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
        // Undefined statistics have no derivative; the others may make them defined again.
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

/// Adds the residuals of the extremes, and returns whether all are met.
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

constexpr std::int64_t rows_a_range = 16;

/// Weights of the window from -reach to reach, with sum 1.
std::vector<double> window(double cells) {
    auto const reach = static_cast<std::int64_t>(std::ceil(3.0 * cells));
    std::vector<double> weights;
    double sum = 0.0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
        double const x = static_cast<double>(k) / cells;
        weights.push_back(portable::exp(-0.5 * x * x));
        sum += weights.back();
    }
    for (double& weight : weights) {
        weight /= sum;
    }
    return weights;
}

std::int64_t mirrored(std::int64_t i, std::int64_t side) {
    std::int64_t const around = 2 * side;
    i = ((i % around) + around) % around;
    return i < side ? i : around - 1 - i;
}

/// The first DEM's means minus the second's: means are linear, so that one pass suffices.
Raster<double> difference_of_means(Raster<float> const& land, Raster<float> const& fine, double cells, Run const& run) {
    std::vector<double> const weights = window(cells);
    auto const reach = static_cast<std::int64_t>(weights.size() / 2);
    Raster<double> along(land.grid());
    Raster<double> out(land.grid());
    parallel_ranges(run, land.height(), rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        run.check();
        std::vector<double> off(land.width());
        for (std::int64_t r = begin; r < end; ++r) {
            for (std::int64_t c = 0; c < land.width(); ++c) {
                off[c] = static_cast<double>(land[Cell{c, r}]) - static_cast<double>(fine[Cell{c, r}]);
            }
            for (std::int64_t c = 0; c < land.width(); ++c) {
                double mean = 0.0;
                for (std::int64_t k = -reach; k <= reach; ++k) {
                    mean += weights[k + reach] * off[mirrored(c + k, land.width())];
                }
                along[Cell{c, r}] = mean;
            }
        }
    });
    parallel_ranges(run, land.height(), rows_a_range, [&](std::int64_t begin, std::int64_t end) {
        run.check();
        for (std::int64_t r = begin; r < end; ++r) {
            auto const row = out.row(r);
            for (std::int64_t k = -reach; k <= reach; ++k) {
                double const weight = weights[k + reach];
                auto const other = along.row(mirrored(r + k, land.height()));
                for (std::size_t c = 0; c < row.size(); ++c) {
                    row[c] += weight * other[c];
                }
            }
        }
    });
    return out;
}

} // namespace

void check_targets(Raster<float> const& dem, Targets const& targets) {
    check_extreme(dem, "highest point", targets.max);
    check_extreme(dem, "lowest point", targets.min);
    check_range("mean", targets.mean, -1e9, 1e9, "m");
    check_range("deviation", targets.std, 0.0, 1e9, "m");
    check_range("correlation length lx", targets.lx_cells, 0.0, 1e9, "cells");
    check_range("correlation length ly", targets.ly_cells, 0.0, 1e9, "cells");
    check_range("slope", targets.slope_rad, 0.0, portable::pi / 2.0, "rad");
    check_range("fractal dimension", targets.dimension, 2.0, 3.0);
    double const infinity = std::numeric_limits<double>::infinity();
    double const max = targets.max ? targets.max->z : infinity;
    double const min = targets.min ? targets.min->z : -infinity;
    if (targets.max && targets.min && targets.max->cell == targets.min->cell) {
        throw BadParameter("fractal.match_statistics",
                           fmt::format("the highest and the lowest point are both at column {}, row {}",
                                       targets.max->cell.col, targets.max->cell.row));
    }
    refuse_if<BadParameter>(!(min < max), "fractal.match_statistics",
                            "the lowest point of {} m is not below the highest of {} m", min, max);
    if (targets.mean && !(min < *targets.mean && *targets.mean < max)) {
        throw BadParameter("fractal.match_statistics",
                           fmt::format("a mean of {} m is not between the lowest point of {} m and the highest of {} m",
                                       *targets.mean, min, max));
    }
    if (!targets.max || !targets.min) {
        return;
    }
    double const mean = targets.mean.value_or((max + min) / 2.0); // the bound is widest there
    double const most = std::sqrt((max - mean) * (mean - min));
    if (targets.std && *targets.std > most) {
        throw BadParameter("fractal.match_statistics",
                           fmt::format("heights between {} m and {} m{} cannot have a deviation of {} m; the most is "
                                       "{:.3f} m (Bhatia and Davis)",
                                       min, max, targets.mean ? fmt::format(" with a mean of {} m", mean) : "",
                                       *targets.std, most));
    }
}

std::vector<FixedHeight> kept_heights(Raster<float> const& dem, Targets const& targets,
                                      std::vector<FixedHeight> const& fixed) {
    std::vector<FixedHeight> kept;
    std::map<std::int64_t, double> seen;
    auto const keep = [&](FixedHeight const& one) {
        Cell const cell = one.cell;
        refuse_if<BadInput>(!dem.grid().contains(cell) || std::isnan(dem[cell]) || !std::isfinite(one.z),
                            "fractal.match_statistics",
                            "the fixed height of {} m at column {}, row {} is not finite, or lies off the grid or in a "
                            "hole; leave it out",
                            one.z, cell.col, cell.row);
        auto const [at, fresh] = seen.emplace(dem.grid().index(cell), one.z);
        if (fresh) {
            kept.push_back(one);
        } else if (at->second != one.z) {
            throw BadInput("fractal.match_statistics",
                           fmt::format("the cell at column {}, row {} has two target heights, {} m and {} m; give one",
                                       cell.col, cell.row, at->second, one.z));
        }
    };
    for (auto const& extreme : {targets.max, targets.min}) {
        if (extreme) {
            keep(*extreme);
        }
    }
    std::for_each(fixed.begin(), fixed.end(), keep);
    refuse_if<BadInput>(kept.size() > most_fixed, "fractal.match_statistics",
                        "{} heights are fixed; at most {} can be kept, so thin them out", kept.size(), most_fixed);
    return kept;
}

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

Raster<float> with_fine_forms(Raster<float> const& land, Raster<float> const& fine, double cells, Run const& run) {
    require_in("fractal.with_fine_forms", "window", cells, {0.0, 1000.0, false, true}, "cells");
    auto const finite = [](float z) { return std::isfinite(z); };
    require_same_grid(land.grid(), fine.grid(), "fractal.with_fine_forms", "the DEM and its fine forms",
                      "give two complete DEMs on one grid");
    refuse_if<BadInput>(!std::all_of(land.values().begin(), land.values().end(), finite) ||
                            !std::all_of(fine.values().begin(), fine.values().end(), finite),
                        "fractal.with_fine_forms", "heights that are not finite; give two complete DEMs");
    Raster<double> const means = difference_of_means(land, fine, cells, run);
    Raster<float> out(land.grid());
    for (std::int64_t i = 0; i < out.cells(); ++i) {
        out[i] = static_cast<float>(means[i] + static_cast<double>(fine[i]));
    }
    return out;
}

} // namespace thalweg::fractal
