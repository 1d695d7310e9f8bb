// SPDX-FileCopyrightText: the thalweg authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <thalweg/detail/project.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <thalweg/core/numbers/elementary.hpp>
#include <thalweg/core/numbers/sum_rows.hpp>
#include <thalweg/core/run/error.hpp>
#include <thalweg/core/run/parallel.hpp>
#include <thalweg/core/run/range.hpp>
#include <thalweg/detail/check_targets.hpp>
#include <thalweg/detail/internal/limiter.hpp>
#include <thalweg/solver/linear/cholesky.hpp>
#include <thalweg/solver/spectral/circulant.hpp>
#include <thalweg/solver/spectral/fft.hpp>
#include <thalweg/solver/statistics/field_statistics.hpp>

namespace thalweg::detail {

namespace {

using solver::FieldStatistics;
using solver::Quantity;

constexpr std::int64_t grain_cells = 32768;
// So close to singular a matrix may be: below it two statistics, or two fixed heights, cannot be told apart.
constexpr double least_ridge = 1e-10;
constexpr double most_ridge = 1e-2;
// A step that leaves more missing than that many times the least so far is taken back, and the next is half as long.
constexpr double worse = 1.5;
constexpr double least_reach = 1.0 / 64.0;
constexpr double least_fine_share = 0.3;
constexpr double longest_fine_cells = 12.0;

/// One statistic on its way to its target.
struct Goal {
    char const* name;
    Quantity quantity;
    double asked;
    double longest_step; ///< in the units in which it is derived
};

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

/// Steps as long as those by which table 4 of paper 001 is met, whose deviation is 131.6 m: there 100 m, 30 m, 0.3,
/// 0.3, 0.05, 0.1.
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

/// What is still missing, in the units in which the statistic is derived.
double missing(Goal const& goal, FieldStatistics const& is) {
    double const got = figure(is, goal.quantity);
    return by_logarithm(goal.quantity) ? exact::log(goal.asked / got) : goal.asked - got;
}

/// The error of a projection: what its caller reads.
double error_of(Goal const& goal, FieldStatistics const& is, double deviation) {
    double const off = std::fabs(figure(is, goal.quantity) - goal.asked);
    double const error = off / (goal.quantity == Quantity::mean ? deviation : goal.asked);
    return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
}

/// A land, as the heights that are changed freely and as those they are bent to.
struct Land {
    Raster<double> free;
    Raster<float> dem;
};

/// Factor with the least ridge that makes the matrix positive definite.
solver::Cholesky factor_safely(std::vector<double> const& matrix, std::size_t size, Run const& run) {
    for (double ridge = least_ridge; ridge < most_ridge; ridge *= 100.0) {
        try {
            return solver::factor(matrix, size, ridge, run);
        } catch (NotConverged const&) {
        }
    }
    return solver::factor(matrix, size, most_ridge, run);
}

/// The prior's covariance, and that part of it which the fixed heights leave.
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

    /// The covariance of every cell with weighted fixed cells (kriging).
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
    /// Where heights three correlation lengths apart hardly know of one another, a torus may be that much wider than
    /// the grid.
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
                    matrix[p * n + q] =
                        table[static_cast<std::size_t>(apart(a.row, b.row, torus_.height) * (torus_.width / 2 + 1) +
                                                       apart(a.col, b.col, torus_.width))];
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
void shape(Land& land, Limiter const& limiter, std::vector<FixedHeight> const& kept, Run const& run) {
    parallel_ranges(run, land.dem.cells(), grain_cells, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            if (!std::isnan(land.dem[i])) {
                land.dem[i] = static_cast<float>(limiter.height(land.free[i]));
            }
        }
    });
    for (FixedHeight const& one : kept) {
        land.dem[one.cell] = static_cast<float>(one.z);
    }
}

/// How the goals' statistics answer to the free heights; the fixed ones do not move.
std::vector<Raster<double>> derivatives(Land const& land, FieldStatistics const& is, std::vector<Goal> const& goals,
                                        Limiter const& limiter, std::vector<FixedHeight> const& kept, Run const& run) {
    std::vector<Raster<double>> fields;
    for (Goal const& goal : goals) {
        fields.push_back(solver::derivative(land.dem, is, goal.quantity, run));
        Raster<double>& field = fields.back();
        parallel_ranges(run, field.cells(), grain_cells, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
                if (limiter.bends(land.free[i])) {
                    field[i] *= limiter.slope(land.free[i]);
                }
            }
        });
        for (FixedHeight const& one : kept) {
            field[one.cell] = 0.0;
        }
    }
    return fields;
}

/// The step of least energy that makes up for what is missing, to first order: free heights move by C' g c, C' the
/// prior's covariance conditioned on the fixed heights, g the derivatives, and c such that g' C' g c = missing, as far
/// as reach times the longest steps.
void step(Land& land, FieldStatistics const& is, std::vector<Goal> const& goals, double reach, Limiter const& limiter,
          std::vector<FixedHeight> const& kept, Prior const& prior, Run const& run) {
    std::size_t const n = goals.size();
    std::vector<Raster<double>> fields = derivatives(land, is, goals, limiter, kept, run);
    std::vector<double> system(n * n);
    for (std::size_t i = 0; i < n; i += 2) {
        Raster<double> first = fields[i];
        Raster<double> second = i + 1 < n ? fields[i + 1] : Raster<double>(first.grid());
        solver::multiply(prior.torus(), first, second, run);
        for (std::size_t j = i; j < n; ++j) {
            system[j * n + i] = product(fields[j], first, run);
            if (i + 1 < n && j > i) {
                system[j * n + i + 1] = product(fields[j], second, run);
            }
        }
        // From here on only the products are needed.
        fields[i] = std::move(first);
        if (i + 1 < n) {
            fields[i + 1] = std::move(second);
        }
    }
    std::vector<std::vector<double>> at_kept(n);
    std::vector<std::vector<double>> weights(n);
    for (std::size_t i = 0; i < n; ++i) {
        at_kept[i] = prior.at_kept(fields[i]);
        weights[i] = prior.solve_kept(at_kept[i]);
        for (std::size_t j = 0; j <= i; ++j) {
            for (std::size_t p = 0; p < kept.size(); ++p) {
                system[i * n + j] -= weights[i][p] * at_kept[j][p];
            }
        }
    }
    // Metres, cells and radians: every statistic by its own deviation. One that answers to no height, or whose answer
    // is not known, as on a plain, is left out.
    std::vector<double> scale(n, 0.0);
    std::vector<double> wanted(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        if (system[i * n + i] > 0.0) {
            scale[i] = 1.0 / std::sqrt(system[i * n + i]);
            wanted[i] = scale[i] * std::clamp(missing(goals[i], is), -reach * goals[i].longest_step,
                                              reach * goals[i].longest_step);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            bool const both = scale[i] > 0.0 && scale[j] > 0.0;
            system[i * n + j] = both ? system[i * n + j] * scale[i] * scale[j] : i == j ? 1.0 : 0.0;
        }
    }
    std::vector<double> const c = solver::solve(factor_safely(system, n, run), std::move(wanted));
    std::vector<double> pull(kept.size(), 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        if (scale[i] == 0.0) {
            continue;
        }
        add_to(land.free, c[i] * scale[i], fields[i], run);
        for (std::size_t p = 0; p < kept.size(); ++p) {
            pull[p] -= c[i] * scale[i] * weights[i][p];
        }
    }
    fields.clear();
    add_to(land.free, 1.0, prior.spread(pull, run), run);
}

void check(Raster<float> const& dem, ProjectParams const& params) {
    solver::check(params.prior, "detail.project");
    require_in("detail.project", "iterations", params.iterations, Range::between(0, 1000));
    require_in("detail.project", "tolerance", params.tolerance, Range::between(0.0, 1.0));
    require_in("detail.project", "gap", params.gap_m, Range::above(0.0).or_infinite(), "m");
    auto const values = dem.values();
    if (std::any_of(values.begin(), values.end(), [](float z) { return std::isinf(z); })) {
        throw BadInput("detail.project: a height is infinite; mark cells without data as NaN");
    }
    if (std::all_of(values.begin(), values.end(), [](float z) { return std::isnan(z); })) {
        throw BadInput(fmt::format("detail.project: none of the {} cells has a height", dem.cells()));
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

} // namespace

Projection project(Raster<float> const& dem, Targets const& targets, std::vector<FixedHeight> const& fixed,
                   ProjectParams const& params, Run const& run) {
    check(dem, params);
    check_targets(dem, targets);
    std::vector<FixedHeight> const kept = kept_heights(dem, targets, fixed);
    Limiter const limiter(targets, params.gap_m);

    Land land{Raster<double>(dem.grid()), dem};
    for (std::int64_t i = 0; i < dem.cells(); ++i) {
        land.free[i] = std::isnan(dem[i]) ? 0.0 : dem[i];
    }
    if (!kept.empty()) {
        Prior const prior(dem.grid(), kept, params.prior, run);
        std::vector<double> off;
        for (FixedHeight const& one : kept) {
            off.push_back(one.z - land.free[one.cell]);
        }
        add_to(land.free, 1.0, prior.spread(prior.solve_kept(std::move(off)), run), run);
    }
    shape(land, limiter, kept, run);

    Prior const prior(dem.grid(), kept, of_steps(params.prior), run);
    FieldStatistics is = solver::field_statistics(land.dem, run);
    double const deviation = targets.std.value_or(is.std > 0.0 ? is.std : 1.0);
    std::vector<Goal> const goals = goals_of(targets, deviation);
    auto const largest_error = [&] {
        double largest = 0.0;
        for (Goal const& goal : goals) {
            largest = std::max(largest, error_of(goal, is, deviation));
        }
        return largest;
    };
    auto const longest_way = [&] {
        double longest = 0.0;
        for (Goal const& goal : goals) {
            double const steps = std::fabs(missing(goal, is)) / goal.longest_step;
            longest = std::isfinite(steps) ? std::max(longest, steps) : std::numeric_limits<double>::infinity();
        }
        return longest;
    };
    Projection best;
    FieldStatistics best_is;
    Raster<double> best_free;
    double best_way = std::numeric_limits<double>::infinity();
    double reach = 1.0;
    best.largest_error = std::numeric_limits<double>::infinity();
    for (int iteration = 0;; ++iteration) {
        double const way = longest_way();
        double const error = largest_error();
        if (iteration == 0 || error <= params.tolerance || way < best_way) {
            best_way = way;
            best_free = land.free;
            best.dem = land.dem;
            best.largest_error = error;
            best.limited_cells = std::count_if(land.free.values().begin(), land.free.values().end(),
                                               [&](double w) { return limiter.bends(w); });
            best_is = is;
        }
        best.iterations = iteration;
        if (best.largest_error <= params.tolerance || iteration == params.iterations) {
            break;
        }
        run.at(static_cast<double>(iteration) / params.iterations, "project");
        if (way > worse * best_way) {
            land.free = best_free;
            shape(land, limiter, kept, run);
            is = best_is;
            reach *= 0.5;
        } else if (way == best_way) {
            reach = std::min(1.0, 2.0 * reach);
        }
        if (reach < least_reach) {
            break;
        }
        // What the heights do not tell cannot be derived; the others may bring it back.
        std::vector<Goal> known;
        std::copy_if(goals.begin(), goals.end(), std::back_inserter(known),
                     [&](Goal const& goal) { return std::isfinite(missing(goal, is)); });
        if (known.empty()) {
            break;
        }
        step(land, is, known, reach, limiter, kept, prior, run);
        shape(land, limiter, kept, run);
        is = solver::field_statistics(land.dem, run);
    }
    for (Goal const& goal : goals) {
        best.residuals.push_back(
            {goal.name, goal.asked, figure(best_is, goal.quantity), error_of(goal, best_is, deviation)});
    }
    for (auto const& [name, extreme, sign] :
         {std::tuple{"max", targets.max, 1.0}, std::tuple{"min", targets.min, -1.0}}) {
        if (extreme) {
            best.residuals.push_back(residual_of_extreme(name, *extreme, best.dem, sign, deviation));
        }
    }
    best.converged = best.largest_error <= params.tolerance;
    for (Residual const& one : best.residuals) {
        bool const is_extreme = std::string_view(one.name).size() == 3 && one.name != "std";
        best.converged = best.converged && (!is_extreme || one.error == 0.0);
        best.largest_error = std::max(best.largest_error, one.error);
    }
    return best;
}

} // namespace thalweg::detail
